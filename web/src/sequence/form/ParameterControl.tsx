import { ParameterType } from '../../gen/visionserver/v1/sequence_pb';
import classes from './form.module.css';
import { NumberField } from './NumberField';
import type { Field } from './parameterEditor';
import { TextField } from './TextField';
import { isNumber } from './value';

export interface ControlProps {
  field: Field;
  id: string;
  disabled: boolean;
  onEdit: (value: Field['value']) => void;
}

/** What fits the kind of a parameter. All say the confirmed value; only a slider's knob runs ahead. */
export function ParameterControl(props: ControlProps) {
  const { field, id, disabled, onEdit } = props;
  if (isNumber(field.info)) return <NumberField {...props} />;
  if (field.info.type === ParameterType.BOOL) {
    return (
      <input
        type="checkbox"
        role="switch"
        id={id}
        className={classes.checkbox}
        checked={Boolean(field.value)}
        disabled={disabled}
        onChange={(event) => onEdit(event.currentTarget.checked)}
      />
    );
  }
  if (field.info.type === ParameterType.CHOICE) {
    return (
      <select
        id={id}
        className={classes.input}
        value={String(field.value)}
        disabled={disabled}
        onChange={(event) => onEdit(event.currentTarget.value)}
      >
        {field.info.choices.map((choice) => (
          <option key={choice}>{choice}</option>
        ))}
      </select>
    );
  }
  return <TextField {...props} />;
}
