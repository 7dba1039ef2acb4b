import '../../i18n';
import { create } from '@bufbuild/protobuf';
import { MantineProvider } from '@mantine/core';
import { act, fireEvent, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it } from 'vitest';
import { SequenceSpecSchema } from '../../gen/visionserver/v1/sequence_pb';
import GraphPanel from './GraphPanel';

const spec = create(SequenceSpecSchema, {
  blocks: [
    { id: 'left', type: 'Camera', x: 0, y: 0 },
    { id: 'check', type: 'Check', x: 400, y: 0 },
  ],
});

describe('A block of the graph', () => {
  let chosen: string[];
  beforeEach(() => {
    chosen = [];
    render(
      <MantineProvider env="test">
        <GraphPanel
          spec={spec}
          blockTypes={[]}
          outputs={[]}
          state={undefined}
          onChoose={(block) => chosen.push(block)}
        />
      </MantineProvider>,
    );
  });
  const block = (name: string) => screen.getByLabelText(name);

  it('is chosen by Enter and by the space bar', async () => {
    act(() => block('check, Check').focus());
    await userEvent.keyboard('{Enter}');
    act(() => block('left, Camera').focus());
    await userEvent.keyboard(' ');
    expect(chosen).toEqual(['check', 'left']);
  });

  it('is chosen by a click, once', () => {
    fireEvent.click(screen.getByText('check'));
    expect(chosen).toEqual(['check']);
  });

  it('is not chosen by other keys', async () => {
    act(() => block('check, Check').focus());
    await userEvent.keyboard('a{Escape}');
    expect(chosen).toEqual([]);
  });
});
