import { ActionIcon } from '@mantine/core';
import { memo, useId } from 'react';
import { useTranslation } from 'react-i18next';
import classes from './form.module.css';
import { ParameterControl } from './ParameterControl';
import type { Field, ParameterEditor } from './parameterEditor';
import { useMayEdit } from './useMayEdit';
import { useField } from './useParameters';
import { isNumber, plainOf } from './value';
import { useValueText } from './valueText';

interface Props {
  path: string;
  editor: ParameterEditor;
  running: boolean;
  explained: boolean;
}

/** One parameter: name, value (with a control for who may change it), range, and the last change. */
export const ParameterField = memo(function ParameterField(props: Props) {
  const { path, editor, running, explained } = props;
  const { t } = useTranslation('sequence');
  const id = useId();
  const field = useField(editor, path);
  const mayEdit = useMayEdit(running);
  const textOf = useValueText();
  if (!field) return null;
  const { info, error, appliedAtFrame, value, draft } = field;
  const name = info.name.replaceAll('_', ' ');
  const may = mayEdit(info);
  // Who may never change it sees what it is, and no control.
  const readOnly = may === 'viewer' || may === 'engineersOnly';
  const initial = plainOf(info.initial);
  const changed = initial !== undefined && initial !== value;
  const notes = [
    rangeOf(field),
    may === 'engineersOnly' || may === 'stopFirst' ? t(`form.${may}`) : '',
  ];
  return (
    <div className={classes.field} data-testid={`parameter-${path}`} data-pending={draft !== undefined}>
      <div className={classes.fieldHead}>
        {readOnly ? (
          <>
            <span className={classes.name} title={info.doc}>
              {name}
            </span>
            <span className={classes.value} data-testid="value">
              {textOf(info, value)}
            </span>
          </>
        ) : (
          <label className={classes.name} htmlFor={id} title={info.doc}>
            {name}
          </label>
        )}
        {draft !== undefined && (
          <span className={classes.pending} data-testid="pending">
            {t('form.pending', { value: textOf(info, draft) })}
          </span>
        )}
        {appliedAtFrame !== undefined && error === '' && (
          <span className={classes.applied} data-testid="applied">
            {t('form.applied', { frame: appliedAtFrame.toString() })}
          </span>
        )}
        {may === 'yes' && changed && (
          <ActionIcon
            size="xs"
            variant="subtle"
            title={t('form.reset', { value: textOf(info, initial) })}
            aria-label={t('form.resetOf', { name: info.name })}
            onClick={() => void editor.reset([path])}
          >
            ↺
          </ActionIcon>
        )}
      </div>
      {!readOnly && (
        <ParameterControl
          field={field}
          id={id}
          disabled={may !== 'yes'}
          onEdit={(next) => editor.edit(path, next)}
        />
      )}
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
