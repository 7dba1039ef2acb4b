import { Switch, TextInput } from '@mantine/core';
import { useState } from 'react';
import { useTranslation } from 'react-i18next';
import type { BlockType, SequenceSpec } from '../../gen/visionserver/v1/sequence_pb';
import { BlockSection } from './BlockSection';
import classes from './form.module.css';
import { useParameterEditor, usePaths } from './useParameters';

interface Props {
  sequence: string;
  spec: SequenceSpec;
  blockTypes: BlockType[];
  running: boolean;
  filter: string;
  setFilter: (filter: string) => void;
}

/** All parameters of a sequence, as the block types describe them. */
export default function ParameterForm(props: Props) {
  const { sequence, spec, blockTypes, running, filter, setFilter } = props;
  const { t } = useTranslation('sequence');
  const editor = useParameterEditor(sequence);
  const paths = usePaths(editor);
  const [explained, setExplained] = useState(false);

  const wanted = filter.trim().toLowerCase();
  const blocks = spec.blocks.map(({ id, type }) => {
    const all = paths.filter((path) => path.startsWith(`${id}.`));
    // The name of a block or type finds all of its parameters.
    const whole = `${id} ${type}`.toLowerCase().includes(wanted);
    const found = all.filter((path) => {
      const doc = editor.field(path)?.info.doc ?? '';
      return whole || `${path} ${doc}`.toLowerCase().includes(wanted);
    });
    const doc = blockTypes.find((one) => one.type === type)?.doc ?? '';
    return { id, type, doc, paths: found };
  });
  const shown = blocks.filter((block) => block.paths.length > 0);

  return (
    <section className={classes.form} aria-label={t('form.title')} data-testid="parameters">
      <div className={classes.formHead}>
        <TextInput
          size="xs"
          flex={1}
          type="search"
          placeholder={t('form.filter')}
          aria-label={t('form.filter')}
          value={filter}
          onChange={(event) => setFilter(event.currentTarget.value)}
        />
        <Switch
          size="xs"
          label={t('form.explain')}
          checked={explained}
          onChange={(event) => setExplained(event.currentTarget.checked)}
        />
      </div>
      <div className={classes.blocks} tabIndex={-1}>
        {shown.map((block) => (
          <BlockSection
            key={block.id}
            {...block}
            editor={editor}
            running={running}
            explained={explained}
          />
        ))}
        {shown.length === 0 && paths.length > 0 && (
          <p className={classes.note}>{t('form.nothing', { filter: filter.trim() })}</p>
        )}
      </div>
    </section>
  );
}
