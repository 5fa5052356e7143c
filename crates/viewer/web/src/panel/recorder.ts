/** The recorder: start and stop it, name its takes, fetch them. Only where the server was given a folder for them. */

import { h, setAttribute, setText } from '../dom/h';
import { icon } from '../dom/icons';
import { bytes, clock, count } from '../model/format';
import type { Room } from '../model/room';
import { json, post, words } from '../protocol/api';
import type { Recorder, Recording } from '../protocol/statistics';
import type { Part } from './performers';

export function recorder(room: Room, say: (text: string | null) => void): Part {
  const name = h('input', {
    type: 'text',
    id: 'take-name',
    placeholder: 'take',
    maxlength: 80,
    autocomplete: 'off',
    spellcheck: 'false',
  });
  const button = h('button', { type: 'submit', class: 'record' }, icon('record'), h('span', {}, 'Record'));
  const status = h('p', { class: 'record-status', role: 'status' });
  const list = h('ul', { class: 'recordings' });
  const form = h('form', { class: 'record-form' }, h('label', { for: 'take-name' }, 'Name'), name, button);
  const element = h('section', { class: 'block', hidden: true }, h('h2', {}, 'Recorder'), form, status, list);

  let busy = false;
  form.onsubmit = (event) => {
    event.preventDefault();
    button.disabled = true;
    busy = true;
    const asked = isRecording(room) ? stop() : start();
    asked
      .catch((error: unknown) => say(words(error)))
      .finally(() => {
        busy = false;
        void reload();
      });
  };

  const start = async (): Promise<void> => {
    await post('/api/recorder/start', { name: name.value.trim() || 'take' });
    say(null);
  };

  const stop = async (): Promise<void> => {
    const file = `${room.recorder?.name}.mcap`;
    await post('/api/recorder/stop');
    const written = (await json<Recording[]>('/api/recordings')).find((each) => each.name === file);
    say(written ? `Saved ${file}, ${bytes(written.bytes)}` : `Saved ${file}`);
  };

  const reload = async (): Promise<void> => {
    try {
      room.recorder = await json<Recorder>('/api/recorder');
      const recordings = await json<Recording[]>('/api/recordings');
      list.replaceChildren(...recordings.filter((recording) => !isWritten(recording, room)).map(recordingRow));
    } catch (error) {
      say(words(error));
    }
  };

  let enabled = false;
  let was: string | null = null;
  const refresh = (): void => {
    element.hidden = !room.scene?.recorder;
    if (element.hidden) return;
    if (!enabled) void reload();
    enabled = true;
    const state = room.recorder?.state ?? 'idle';
    if (was === 'recording' && state !== 'recording') void reload();
    was = state;
    setAttribute(element, 'data-state', state);
    button.disabled = busy || room.connection !== 'open';
    setText(button.querySelector('span')!, isRecording(room) ? 'Stop' : 'Record');
    setAttribute(name, 'disabled', isRecording(room) ? '' : null);
    setText(status, statusText(room.recorder));
  };
  return { element, refresh };
}

function isRecording(room: Room): boolean {
  return room.recorder?.state === 'recording';
}

/** Whether it is still being written: what is fetched now would be torn. */
function isWritten(recording: Recording, room: Room): boolean {
  return isRecording(room) && recording.name === `${room.recorder?.name}.mcap`;
}

/** "Recording walk: 0:12, 3.4 MB, 12,345 datagrams". */
function statusText(recorder: Recorder | null): string {
  if (!recorder || recorder.state === 'idle') return '';
  if (recorder.state === 'failed') return `The recording failed: ${recorder.error ?? 'no reason was given'}`;
  const { name, seconds, bytes: size, datagrams, lost } = recorder;
  const loss = lost > 0 ? `, ${count(lost)} lost` : '';
  return `Recording ${name ?? ''}: ${clock(seconds, 0)}, ${bytes(size)}, ${count(datagrams)} datagrams${loss}`;
}

function recordingRow(recording: Recording): HTMLLIElement {
  const href = `/api/recordings/${encodeURIComponent(recording.name)}`;
  const label = `Download ${recording.name}`;
  const link = h(
    'a',
    { href, download: recording.name, class: 'icon', 'aria-label': label, title: label },
    icon('download'),
  );
  const when = new Date(typeof recording.modified === 'number' ? recording.modified * 1000 : recording.modified);
  const detail = `${bytes(recording.bytes)}, ${when.toLocaleString('en-GB', { dateStyle: 'medium', timeStyle: 'short' })}`;
  return h('li', {}, h('span', { class: 'name' }, recording.name), h('span', { class: 'detail' }, detail), link);
}
