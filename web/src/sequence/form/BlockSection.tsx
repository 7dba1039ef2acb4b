import { Button } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { mayOperate, useRole } from '../../api/session';
import classes from './form.module.css';
import { ParameterField } from './ParameterField';
import type { ParameterEditor } from './parameterEditor';
import { useMayEdit } from './useMayEdit';

interface Props {
  id: string;
  type: string;
  doc: string;
  paths: string[];
  editor: ParameterEditor;
  running: boolean;
  explained: boolean;
}

/** The parameters of one block. */
export function BlockSection({ id, type, doc, paths, editor, running, explained }: Props) {
  const { t } = useTranslation('sequence');
  const role = useRole();
  const mayEdit = useMayEdit(running);
  const resettable = paths.filter((path) => {
    const field = editor.field(path);
    return field && mayEdit(field.info) === 'yes';
  });
  return (
    <details open className={classes.block}>
      <summary className={classes.blockHead} title={doc}>
        <span className={classes.blockName}>{id}</span>
        <span className={classes.blockType}>{type}</span>
      </summary>
      {explained && <p className={classes.note}>{doc}</p>}
      {paths.map((path) => (
        <ParameterField
          key={path}
          path={path}
          editor={editor}
          running={running}
          explained={explained}
        />
      ))}
      {mayOperate(role) && resettable.length > 1 && (
        <Button
          size="compact-xs"
          variant="subtle"
          onClick={() => void editor.reset(resettable)}
          aria-label={t('form.resetBlockOf', { block: id })}
        >
          {t('form.resetBlock')}
        </Button>
      )}
    </details>
  );
}
