import { render, screen, waitFor } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { beforeEach, describe, expect, it, vi } from 'vitest';
import { Role } from '../gen/visionserver/v1/session_pb';
import { SequenceRunState, SequenceService } from '../gen/visionserver/v1/sequence_pb';
import { freshTab, logIn, serve } from '../test/fakeServer';
import { App } from './App';
import { StartStop } from './StartStop';

vi.mock('@connectrpc/connect-web', async () => (await import('../test/fakeServer')).connectWeb);

let calls: string[] = [];

beforeEach(() => {
  freshTab();
  calls = [];
  serve(({ service }) =>
    service(SequenceService, {
      startSequence: ({ id }) => {
        calls.push(`start ${id}`);
        return { sequence: id, state: SequenceRunState.STARTING };
      },
      stopSequence: ({ id }) => {
        calls.push(`stop ${id}`);
        return { sequence: id, state: SequenceRunState.STOPPED };
      },
    }),
  );
});

function show(state: SequenceRunState, role = Role.OPERATOR) {
  logIn('olga', role);
  const settled = vi.fn();
  render(
    <App env="test">
      <StartStop id="depth" state={state} size="xs" onSettled={settled} />
    </App>,
  );
  return { user: userEvent.setup(), settled };
}

describe('a sequence', () => {
  it('is started at once', async () => {
    const { user, settled } = show(SequenceRunState.STOPPED);
    await user.click(screen.getByRole('button', { name: 'Start depth' }));
    await waitFor(() => expect(settled).toHaveBeenCalled());
    expect(calls).toEqual(['start depth']);
    expect(settled.mock.calls[0]![0]).toMatchObject({ state: SequenceRunState.STARTING });
  });

  it('is stopped only after the user was told what that means', async () => {
    const { user, settled } = show(SequenceRunState.RUNNING);
    await user.click(screen.getByRole('button', { name: 'Stop depth' }));
    await screen.findByText(/robots too/);
    await user.click(screen.getByRole('button', { name: 'Cancel' }));
    expect(calls).toEqual([]);
    await user.click(screen.getByRole('button', { name: 'Stop depth' }));
    await user.click(await screen.findByRole('button', { name: 'Stop' }));
    await waitFor(() => expect(settled).toHaveBeenCalled());
    expect(calls).toEqual(['stop depth']);
  });

  it.each([
    [SequenceRunState.STARTING, 'Stop depth'],
    [SequenceRunState.DEGRADED, 'Stop depth'],
    [SequenceRunState.FAULT, 'Start depth'],
    [SequenceRunState.STOPPING, 'Start depth'],
  ])('in state %i has the button "%s"', (state, name) => {
    show(state);
    expect(screen.getByRole('button', { name })).toBeTruthy();
  });

  it('is nothing that a viewer could start or stop', () => {
    show(SequenceRunState.RUNNING, Role.VIEWER);
    expect(screen.queryByRole('button')).toBeNull();
  });
});
