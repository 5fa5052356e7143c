// The pictures of docs/viewer.md and the README.

import { mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { assertQuiet, atRest, browser, open, smallPicture, waitForStates } from './lib/page.mjs';
import { start, until, view } from './lib/program.mjs';
import { walkerTake } from './lib/take.mjs';

test('pictures are taken of performers, of a take and of a phone', { timeout: 180_000 }, async (context) => {
  const server = await view(context, ['mxtp://127.0.0.1:0']);
  start(context, 'stream', 'synthetic:walk?people=4&rate=60&fingers=true', '--to', server.endpoint);
  const opened = await browser(context);
  const plots = ['joint_angles/jRightKnee/z', 'joint_angles/jLeftKnee/z', 'position/Pelvis/z'].map(
    (name) => `plot=0:${name}`,
  );
  const live = await open(opened, `${server.url}#${plots.join('&')}`);
  await until(() => live.evaluate(() => window.posewire.traces.all.length === 3), 'the channels');
  await until(() => live.evaluate(plottedSeconds).then((seconds) => seconds > 9), 'a plot that is full');
  await still(live, () => smallPicture(live, 'viewer'));
  assertQuiet(live);
  await live.close();

  const phone = await open(opened, server.url, {
    viewport: { width: 390, height: 780 },
    colorScheme: 'light',
    hasTouch: true,
    isMobile: true,
  });
  await still(phone, async () => {
    await phone.getByRole('button', { name: '4 performers' }).tap();
    await smallPicture(phone, 'viewer-phone');
  });
  await phone.close();

  const take = await walkerTake(context, mkdtempSync(path.join(tmpdir(), 'posewire-')), 'walk.mvnx', 20, [
    [300, 372],
    [800, 806],
  ]);
  const player = await view(context, [take.file]);
  const tab = await open(opened, `${player.url}#frame=481&show=names,com,trails`);
  await until(() => tab.evaluate(() => window.posewire.player.shownFrame() === 481), 'frame 481');
  for (let step = 0; step < 30; step++) await tab.keyboard.press('ArrowRight');
  await tab.keyboard.press('0');
  await atRest(tab);
  await smallPicture(tab, 'viewer-take');
  assertQuiet(tab);
});

/** Lets the page take nothing more: what rests is drawn as well as can be, also by a busy machine. */
async function still(tab, take) {
  await waitForStates(tab, ['LIVE', 'LIVE', 'LIVE', 'LIVE']);
  await tab.evaluate(() => {
    const { room, stage, traces } = window.posewire;
    room.take = stage.update = traces.take = () => undefined;
  });
  await atRest(tab);
  await take();
}

/** For how long the first trace has been plotted. */
function plottedSeconds() {
  const { time } = window.posewire.traces.all[0].column();
  return time.length > 0 ? time.at(-1) - time[0] : 0;
}
