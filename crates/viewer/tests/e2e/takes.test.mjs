// Takes: scrubbing, stepping, playing and repeating, by pointer and by keys.

import assert from 'node:assert/strict';
import { mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { before, test } from 'node:test';
import { assertQuiet, atRest, browser, open, picture } from './lib/page.mjs';
import { until, view } from './lib/program.mjs';
import { walkerTake } from './lib/take.mjs';

const folder = mkdtempSync(path.join(tmpdir(), 'posewire-'));
let take;

before(async (context) => {
  take = await walkerTake({ after: () => undefined, ...context }, folder, 'walk.mvnx', 10, [
    [120, 150],
    [400, 401],
  ]);
});

/** The frame that the stage shows, with where it has the segments. */
function shown(tab) {
  return tab.evaluate(() => {
    const { player, room, stage } = window.posewire;
    return {
      frame: player.shownFrame(),
      sample: room.records.get(0)?.sample,
      positions: [...stage.stats().positions(0)],
    };
  });
}

/** Waits until a frame is shown, and holds it against the file. */
async function assertFrame(tab, frame) {
  await until(async () => (await shown(tab)).frame === frame, `frame ${frame}`);
  const { sample, positions } = await shown(tab);
  const expected = take.frames[frame];
  assert.equal(sample, expected.sample);
  assert.deepEqual(positions, expected.position.map(Math.fround));
}

test('a file is scrubbed and stepped to exact frames', async (context) => {
  const server = await view(context, [take.file]);
  const tab = await open(await browser(context), server.url);
  await assertFrame(tab, 0);
  await tab.getByLabel('Frame', { exact: true }).fill('481');
  await tab.keyboard.press('Enter');
  await assertFrame(tab, 481);
  await tab.keyboard.press('Escape');

  for (const [key, frame] of [
    ['ArrowRight', 482],
    ['Shift+ArrowLeft', 472],
    ['ArrowLeft', 471],
    ['Home', 0],
    ['Shift+ArrowRight', 10],
    ['PageDown', 70],
    ['End', take.frames.length - 1],
  ]) {
    await tab.keyboard.press(key);
    await assertFrame(tab, frame);
  }

  // A third of ten seconds: behind the gap, which takes its time.
  const line = await tab.getByRole('slider', { name: 'Timeline' }).boundingBox();
  await tab.mouse.click(line.x + line.width / 3, line.y + 8);
  const wanted = take.frames.filter(({ sample }) => sample <= Math.floor(599 / 3 + 0.0005)).length - 1;
  await until(async () => Math.abs((await shown(tab)).frame - wanted) <= 1, `frame ${wanted} or a neighbour`);
  await tab.getByRole('button', { name: '30 samples missing' }).click();
  await assertFrame(tab, 119);
  await atRest(tab);
  await picture(tab, 'take');
  assertQuiet(tab);
});

test('a take plays at its speed, and repeats a range', async (context) => {
  const server = await view(context, [take.file]);
  const tab = await open(await browser(context), `${server.url}#frame=300`);
  await assertFrame(tab, 300);
  await tab.keyboard.press('i');
  await tab.getByLabel('Frame', { exact: true }).fill('330');
  await tab.keyboard.press('Enter');
  await tab.keyboard.press('Escape');
  await tab.keyboard.press('o');
  await tab.getByRole('button', { name: 'Play' }).click();
  const frames = new Set();
  await until(async () => {
    frames.add((await shown(tab)).frame);
    return frames.size >= 8;
  }, 'eight frames of the range');
  assert.ok(
    [...frames].every((frame) => frame >= 300 && frame <= 330),
    [...frames].join(),
  );
  await tab.getByRole('button', { name: 'Pause' }).click();

  await tab.keyboard.press('u');
  await tab.keyboard.press('Home');
  await tab.getByLabel('Speed').selectOption('2');
  await tab.getByRole('button', { name: 'Play' }).click();
  const speed = await tab.evaluate(speedOf);
  assert.ok(Math.abs(speed - 2) < 0.01, `played at ${speed} times its speed`);
  assertQuiet(tab);
});

/** How fast the playhead goes, by the time of the screen's own frames. */
function speedOf() {
  return new Promise((resolve) => {
    let first = null;
    const look = (now) => {
      const at = window.posewire.player.playhead.position;
      first ??= { now, at };
      const passed = (now - first.now) / 1000;
      if (passed > 1) resolve((at - first.at) / passed);
      else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
}

test('two takes share a timeline', async (context) => {
  const other = await walkerTake(context, folder, 'short.mvnx', 2);
  const server = await view(context, [take.file, other.file]);
  const tab = await open(await browser(context), `${server.url}#frame=60`);
  await until(async () => (await shown(tab)).frame === 60, 'frame 60');
  const second = () => tab.evaluate(() => window.posewire.room.records.get(1)?.sample);
  await until(async () => (await second()) === 60, 'sample 60 of the second');
  await picture(tab, 'takes');
  assertQuiet(tab);
});
