// Plots: the right values at the right time, live and of takes.

import assert from 'node:assert/strict';
import { mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { assertQuiet, browser, open, picture, waitForStates } from './lib/page.mjs';
import { monitor, start, until, view } from './lib/program.mjs';
import { walkerTake } from './lib/take.mjs';

const KNEE = '0:joint_angles/jRightKnee/z';

test('a joint angle of a live stream is plotted sample for sample, and stands still when paused', async (context) => {
  const truth = await monitor(context);
  const server = await view(context, ['mxtp://127.0.0.1:0']);
  start(
    context,
    'stream',
    'synthetic:walk?rate=60',
    '--types',
    '02,12,13,20',
    '--to',
    server.endpoint,
    '--to',
    truth.endpoint,
  );
  const tab = await open(await browser(context), server.url);
  await waitForStates(tab, ['LIVE']);

  await tab.keyboard.press('g');
  await tab.getByRole('searchbox').fill('right knee flexion');
  await tab.keyboard.press('Enter');
  await tab.keyboard.press('Escape');
  const values = () => tab.evaluate((key) => [...(window.posewire.plots.column(key)?.value ?? [])], KNEE);
  await until(async () => (await values()).length >= 100, '100 samples');
  const plotted = await values();
  await until(() => truth.frames().length > 260, 'the monitor to have seen as much');
  const streamed = truth
    .frames()
    .map((frame) => degrees(frame.joint_angles.find(({ name }) => name === 'jRightKnee').z));
  assertRunOf(streamed, plotted);

  await tab.getByRole('button', { name: 'Pause the plots' }).click();
  const shown = () => tab.evaluate((key) => window.posewire.plots.shownValues()[key], KNEE);
  const paused = await shown();
  assert.match(paused, /^-?\d+\.\d+°$/);
  const samples = (await values()).length;
  await until(async () => (await values()).length > samples + 24, 'more samples than are shown');
  assert.equal(await shown(), paused);
  await tab.locator('.u-over').hover({ position: { x: 300, y: 30 } });
  await until(async () => (await shown()) !== paused, 'the value under the pointer');
  await picture(tab, 'plots-live');
  assertQuiet(tab);
});

test('a take is plotted whole, its value is that of the frame, and a click goes there', async (context) => {
  const take = await walkerTake(context, mkdtempSync(path.join(tmpdir(), 'posewire-')), 'walk.mvnx', 4, [[90, 110]]);
  const server = await view(context, [take.file]);
  const tab = await open(await browser(context), `${server.url}#plot=${KNEE}&plot=0:position/Pelvis/z&frame=100`);
  const column = (key) => tab.evaluate((of) => [...(window.posewire.plots.column(of)?.value ?? [])], key);
  await until(async () => (await column(KNEE)).length > 0, 'the series');
  const knee = take.joints.indexOf('jRightKnee') * 3 + 2;
  const expected = take.frames.map(({ jointAngle }) => jointAngle[knee]);
  const plotted = await column(KNEE);
  assert.equal(plotted.length, expected.length);
  plotted.forEach((value, frame) =>
    assert.ok(Math.abs(value - expected[frame]) < 1e-4, `frame ${frame}: ${value}, ${expected[frame]}`),
  );

  const shown = () => tab.evaluate((key) => window.posewire.plots.shownValues()[key], KNEE);
  await until(
    async () => (await shown()) === `${expected[100].toFixed(2)}°`,
    `the value of frame 100, ${expected[100]}`,
  );
  const chart = await tab.locator('.u-over').first().boundingBox();
  await tab.mouse.click(chart.x + chart.width / 2, chart.y + chart.height / 2);
  const middle = await tab.evaluate(() => window.posewire.player.playhead.position);
  assert.ok(Math.abs(middle - 2) < 0.05, `the middle of 4 s is at ${middle}`);
  await picture(tab, 'plots-take');
  assertQuiet(tab);
});

/** Whether the values are neighbours in a longer list, none left out. */
function assertRunOf(all, values) {
  const close = (a, b) => Math.abs(a - b) < 1e-3;
  const starts = all.flatMap((value, place) => (close(value, values[0]) ? [place] : []));
  const length = (from) => values.findIndex((value, place) => !close(value, all[from + place] ?? NaN));
  const runs = starts.map((from) => [from, length(from)]);
  const whole = runs.some(([from, end]) => end === -1 || from + end === all.length);
  assert.ok(whole, `no run of ${values.length} values; the longest begin and end at ${JSON.stringify(runs)}`);
}

function degrees(radians) {
  return (radians * 180) / Math.PI;
}
