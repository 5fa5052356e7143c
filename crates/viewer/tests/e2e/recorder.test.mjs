// The recorder, worked from the page.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { assertQuiet, browser, open, picture, waitForStates } from './lib/page.mjs';
import { run, start, until, view } from './lib/program.mjs';

test(
  'a take is recorded, listed and fetched, and loses nothing to a page that stopped',
  { timeout: 120_000 },
  async (context) => {
    const folder = mkdtempSync(path.join(tmpdir(), 'posewire-'));
    const server = await view(context, ['mxtp://127.0.0.1:0'], '--record-dir', folder);
    start(context, 'stream', 'synthetic:walk?people=2&rate=60', '--to', server.endpoint);
    const opened = await browser(context);
    const tab = await open(opened, server.url);
    const other = await open(opened, server.url);
    await waitForStates(tab, ['LIVE', 'LIVE']);
    const debug = await other.context().newCDPSession(other);
    await debug.send('Debugger.enable');
    await debug.send('Debugger.pause');

    await tab.bringToFront();
    await tab.getByRole('textbox', { name: 'Name' }).fill('walk');
    await tab.getByRole('button', { name: 'Record' }).click();
    const status = () => tab.locator('.record-status').textContent();
    await until(async () => /^Recording walk.*: 0:0[2-9]/.test(await status()), 'two seconds of recording');
    await picture(tab, 'recording');
    await tab.getByRole('button', { name: 'Stop' }).click();
    const name = tab.locator('.recordings .name');
    await until(async () => (await name.count()) === 1, 'the recording to be listed');
    assert.match(await name.textContent(), /^walk.*\.mcap$/);

    const [download] = await Promise.all([
      tab.waitForEvent('download'),
      tab.getByRole('link', { name: /^Download walk/ }).click(),
    ]);
    const file = path.join(folder, 'fetched.mcap');
    await download.saveAs(file);
    assert.deepEqual(readFileSync(file), readFileSync(path.join(folder, await name.textContent())));
    const [line] = (await run(context, 'inspect', file, '--json')).filter((each) => each.startsWith('{'));
    const found = JSON.parse(line);
    assert.equal(found.missing ?? 0, 0, line);
    const frames = (await run(context, 'monitor', file, '--json')).map(
      (each) => each.startsWith('{') && JSON.parse(each),
    );
    const ended = frames.filter((each) => each && each.kind === 'statistics' && each.ended);
    assert.ok(
      ended.some(({ received }) => received >= 100),
      JSON.stringify(ended),
    );
    assert.deepEqual(
      ended.filter(({ missing }) => missing > 0),
      [],
    );
    await debug.send('Debugger.resume').catch(() => undefined);
    assertQuiet(tab);
  },
);

test('a server without a folder for recordings has no recorder', async (context) => {
  const server = await view(context, ['mxtp://127.0.0.1:0']);
  const tab = await open(await browser(context), server.url);
  await until(async () => (await tab.locator('.performers').count()) === 1, 'the panel');
  assert.equal(await tab.getByRole('button', { name: 'Record' }).isVisible(), false);
  assertQuiet(tab);
});
