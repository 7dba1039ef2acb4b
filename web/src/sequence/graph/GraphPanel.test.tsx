import '../../i18n';
import { create } from '@bufbuild/protobuf';
import { MantineProvider } from '@mantine/core';
import { act, fireEvent, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';
import { SequenceSpecSchema, SequenceStateSchema } from '../../gen/visionserver/v1/sequence_pb';
import GraphPanel from './GraphPanel';

const spec = create(SequenceSpecSchema, {
  blocks: [
    { id: 'left', type: 'Camera', x: 0, y: 0 },
    { id: 'check', type: 'Check', x: 400, y: 0 },
  ],
});

function panel(lastError?: string) {
  const state =
    lastError === undefined
      ? undefined
      : create(SequenceStateSchema, {
          blocks: [
            { block: 'left', runs: 9000n },
            { block: 'check', runs: 9000n, failures: 1234n, lastFailure: 'too dark', lastError },
          ],
        });
  return (
    <MantineProvider env="test">
      <GraphPanel spec={spec} blockTypes={[]} outputs={[]} state={state} onChoose={() => {}} />
    </MantineProvider>
  );
}

describe('The failures of a block', () => {
  const badge = () => screen.getByTestId('failures-check');

  it('are counted, also while it works again, and of no block that never failed', () => {
    const { rerender } = render(panel('too dark'));
    expect(badge().textContent).toBe('✕ 1.2K');
    expect(badge().dataset.works).toBe('false');
    rerender(panel(''));
    expect(badge().dataset.works).toBe('true');
    expect(screen.queryByTestId('failures-left')).toBeNull();
    expect(screen.getByRole('button', { name: '1.2K failures since the start' })).toBeTruthy();
  });

  it('tell the reason of the last one by focus and by pointing', async () => {
    render(panel(''));
    const reason = 'Works again. Last failure: too dark';
    expect(screen.queryByText(reason)).toBeNull();
    act(() => badge().focus());
    expect((await screen.findByRole('tooltip')).textContent).toBe(reason);
    act(() => badge().blur());
    await vi.waitFor(() => expect(screen.queryByRole('tooltip')).toBeNull());
    await userEvent.hover(badge());
    expect((await screen.findByRole('tooltip')).textContent).toBe(reason);
  });
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
