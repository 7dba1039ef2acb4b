import { ActionIcon } from '@mantine/core';
import { memo, useId } from 'react';
import { useTranslation } from 'react-i18next';
import { ParameterType } from '../../gen/visionserver/v1/sequence_pb';
import classes from './form.module.css';
import { NumberField } from './NumberField';
import type { Field, ParameterEditor } from './parameterEditor';
import { TextField } from './TextField';
import { useMayEdit } from './useMayEdit';
import { useField } from './useParameters';
import { isNumber, plainOf } from './value';

interface Props {
  path: string;
  editor: ParameterEditor;
  running: boolean;
  explained: boolean;
}

/** One parameter: name, control, range, and what became of the last change. */
export const ParameterField = memo(function ParameterField(props: Props) {
  const { path, editor, running, explained } = props;
  const { t } = useTranslation('sequence');
  const id = useId();
  const field = useField(editor, path);
  const mayEdit = useMayEdit(running);
  if (!field) return null;
  const { info, error, appliedAtFrame, value, draft } = field;
  const may = mayEdit(info);
  const initial = plainOf(info.initial);
  const changed = initial !== undefined && initial !== value;
  const notes = [
    rangeOf(field),
    may === 'engineersOnly' || may === 'stopFirst' ? t(`form.${may}`) : '',
  ];
  return (
    <div className={classes.field} data-testid={`parameter-${path}`} data-pending={draft !== undefined}>
      <div className={classes.fieldHead}>
        <label htmlFor={id} title={info.doc}>
          {info.name.replaceAll('_', ' ')}
        </label>
        {appliedAtFrame !== undefined && error === '' && (
          <span className={classes.applied} data-testid="applied">
            {t('form.applied', { frame: appliedAtFrame.toString() })}
          </span>
        )}
        {may === 'yes' && changed && (
          <ActionIcon
            size="xs"
            variant="subtle"
            title={t('form.reset', { value: String(initial) })}
            aria-label={t('form.resetOf', { name: info.name })}
            onClick={() => void editor.reset([path])}
          >
            ↺
          </ActionIcon>
        )}
      </div>
      <Control field={field} id={id} disabled={may !== 'yes'} onEdit={(next) => editor.edit(path, next)} />
      <div className={classes.range} id={`${id}-note`}>
        {notes.filter(Boolean).join(' · ')}
      </div>
      {explained && <div className={classes.note}>{info.doc}</div>}
      {error && (
        <div className={classes.error} role="alert">
          {error}
        </div>
      )}
    </div>
  );
});

export interface ControlProps {
  field: Field;
  id: string;
  disabled: boolean;
  onEdit: (value: Field['value']) => void;
}

function Control(props: ControlProps) {
  const { field, id, disabled, onEdit } = props;
  const shown = field.draft ?? field.value;
  if (isNumber(field.info)) return <NumberField {...props} />;
  if (field.info.type === ParameterType.BOOL) {
    return (
      <input
        type="checkbox"
        role="switch"
        id={id}
        className={classes.checkbox}
        checked={Boolean(shown)}
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
        value={String(shown)}
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

/** "0 … 255 px", "at least 1", or nothing. */
function rangeOf({ info }: Field): string {
  const { min, max, unit } = info;
  if (!isNumber(info)) return '';
  const end = unit ? ` ${unit}` : '';
  if (min !== undefined && max !== undefined) return `${min} … ${max}${end}`;
  if (min !== undefined) return `≥ ${min}${end}`;
  if (max !== undefined) return `≤ ${max}${end}`;
  return unit;
}
