import type { ControlProps } from './ParameterControl';
import { TypedText } from './TypedText';

export function TextField({ field, id, disabled, onEdit }: ControlProps) {
  return (
    <TypedText
      id={id}
      disabled={disabled}
      value={String(field.value)}
      accept={(text) => {
        onEdit(text);
        return true;
      }}
    />
  );
}
