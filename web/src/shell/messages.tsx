import { Notification, Stack } from '@mantine/core';
import { useTranslation } from 'react-i18next';
import { create } from 'zustand';

const kMost = 4;
const kDoneMs = 5000;

interface Message {
  id: number;
  /** "done" goes by itself; "error" stays until it is closed. */
  kind: 'done' | 'error';
  title?: string;
  text: string;
}

const useMessages = create<{ shown: Message[] }>()(() => ({ shown: [] }));
let nextId = 0;

function close(id: number): void {
  useMessages.setState(({ shown }) => ({ shown: shown.filter((message) => message.id !== id) }));
}

/** Shows a message over the page, beside the newest of those that are there. */
export function showMessage(message: Omit<Message, 'id'>): void {
  const id = ++nextId;
  useMessages.setState(({ shown }) => ({ shown: [...shown, { ...message, id }].slice(-kMost) }));
  if (message.kind === 'done') setTimeout(() => close(id), kDoneMs);
}

/** Where the messages stand: once, around all pages. */
export function Messages() {
  const { t } = useTranslation('shell');
  const shown = useMessages((state) => state.shown);
  return (
    <Stack pos="fixed" bottom={16} right={16} w={400} gap="xs" style={{ zIndex: 450 }}>
      {shown.map(({ id, kind, title, text }) => (
        <Notification
          key={id}
          role={kind === 'error' ? 'alert' : 'status'}
          color={kind === 'error' ? 'red' : 'cyan'}
          title={title}
          withBorder
          closeButtonProps={{ 'aria-label': t('close') }}
          onClose={() => close(id)}
        >
          <span style={{ whiteSpace: 'pre-line' }}>{text}</span>
        </Notification>
      ))}
    </Stack>
  );
}
