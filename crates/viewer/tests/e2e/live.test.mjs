// Live performers: they move as streamed, and the page says when they no longer do.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { assertQuiet, browser, open, picture, waitForStates } from './lib/page.mjs';
import { monitor, said, start, stop, until, view } from './lib/program.mjs';

test('performers are where the stream says, and move', async (context) => {
  const truth = await monitor(context);
  const server = await view(context, ['mxtp://127.0.0.1:0']);
  start(context, 'stream', 'synthetic:walk?people=3&rate=60', '--to', server.endpoint, '--to', truth.endpoint);
  const tab = await open(await browser(context), server.url);
  await waitForStates(tab, ['LIVE', 'LIVE', 'LIVE']);

  const seen = [];
  for (let look = 0; look < 8; look++) {
    const samples = seen.slice(-3).map(({ sample }) => sample);
    const looked = () => tab.evaluate(drawn);
    const isNew = (now) => now.every(({ sample }) => !samples.includes(sample)) && now;
    seen.push(...(await until(async () => isNew(await looked()), 'a pose that was not drawn before')));
  }
  const key = (name, sample) => `${name} ${sample}`;
  const last = Math.max(...seen.map(({ sample }) => sample));
  await until(() => truth.frames().some(({ sample }) => sample > last), 'the monitor to have seen as much');
  const streamed = new Map(truth.frames().map((frame) => [key(frame.name, frame.sample), frame]));
  const compared = seen.filter(({ name, sample }) => streamed.has(key(name, sample)));
  assert.ok(compared.length >= 12, `${compared.length} of ${seen.length} samples were seen by both`);
  for (const { name, sample, positions } of compared) {
    const expected = streamed.get(key(name, sample)).segments.flatMap(({ position }) => position.map(Math.fround));
    assert.deepEqual(positions, expected, `${name}, sample ${sample}`);
  }
  for (const name of ['Ada', 'Bram', 'Cleo']) {
    const places = new Set(seen.filter((each) => each.name === name).map(({ positions }) => positions[0]));
    assert.ok(places.size >= 3, `${name} was seen at ${places.size} places`);
  }
  await picture(tab, 'live');
  assertQuiet(tab);
});

/** What the scene shows of each performer, and of which sample. */
function drawn() {
  const { room, stage } = window.posewire;
  return room.subjects.map(({ id, name }) => {
    return { name, sample: room.records.get(id).sample, positions: [...stage.stats().positions(id)] };
  });
}

test('performers grow stale and lost when the stream stops, and live again with it', async (context) => {
  const server = await view(context, ['mxtp://127.0.0.1:0']);
  const tab = await open(await browser(context), server.url);
  assert.match(await tab.locator('#empty').textContent(), /Waiting for the first performer.*mxtp:\/\/127\.0\.0\.1/);
  await picture(tab, 'waiting');

  const walk = ['stream', 'synthetic:walk?people=2&rate=60', '--to', server.endpoint];
  const first = start(context, ...walk);
  await waitForStates(tab, ['LIVE', 'LIVE']);
  assert.equal(await tab.locator('#empty').isVisible(), false);
  await stop(first);
  await waitForStates(tab, ['STALE', 'STALE']);
  await picture(tab, 'stale');
  await waitForStates(tab, ['LOST', 'LOST']);
  await picture(tab, 'lost');
  start(context, ...walk);
  await waitForStates(tab, ['LIVE', 'LIVE']);
  assertQuiet(tab);
});

test('losses are counted, shown, and said where they happened', async (context) => {
  const server = await view(context, ['mxtp://127.0.0.1:0']);
  const faults = ['--types', '02,12,20', '--faults', 'loss=20%,seed=7'];
  start(context, 'stream', 'synthetic:walk?rate=60', ...faults, '--to', server.endpoint);
  const tab = await open(await browser(context), server.url);
  await waitForStates(tab, ['LIVE']);
  const row = tab.locator('tr', { hasText: '02 Quaternion' });
  await until(
    async () => Number(await row.locator('.bad').textContent({ timeout: 20_000 })) >= 5,
    'five missing samples',
  );
  await until(
    async () => /lost (behind|somewhere)/.test(await tab.locator('.streams').textContent()),
    'where they were lost',
  );
  await until(async () => /\d Hz/.test(await tab.locator('.performer .rate').textContent()), 'a rate');
  await picture(tab, 'losses');
  assertQuiet(tab);
});

test('each type of pose is drawn as far as it allows, and says what it lacks', async (context) => {
  const types = ['01', '02', '05', '21', '22'];
  const server = await view(context, Array(types.length).fill('mxtp://127.0.0.1:0'));
  const shown = server.lines.filter((line) => line.startsWith('showing '));
  types.forEach((type, place) => {
    const endpoint = shown[place].slice('showing '.length);
    start(context, 'stream', 'synthetic:walk?rate=60', '--types', type, '--to', endpoint);
  });
  const tab = await open(await browser(context), server.url);
  await waitForStates(tab, Array(types.length).fill('LIVE'));
  const drawn = await tab.evaluate(() => {
    const { room, stage } = window.posewire;
    return room.subjects.map(({ id, source }) => [source, [...stage.stats().positions(id)]]);
  });
  const noted = await tab.locator('.performer .detail').allTextContents();
  const notes = ['', '', '', ', positions only', ', orientations only, in place'];
  const order = drawn.map(([source]) => source);
  assert.deepEqual(order.toSorted(), [0, 1, 2, 3, 4]);
  for (const [place, [source, positions]] of drawn.entries()) {
    assert.ok(positions.length >= 69 && positions.slice(0, 69).every(Number.isFinite), `type ${types[source]}`);
    assert.equal(noted[place].replace(/^\d+ segments/, ''), notes[source], `type ${types[source]}`);
  }
  await picture(tab, 'types');
  assertQuiet(tab);
});

test("a NatNet server's skeletons are shown with its latencies", async (context) => {
  const motive = start(context, 'stream', 'synthetic:walk?people=2&rate=60', '--to', 'natnet://127.0.0.1:0?data-port=0');
  const address = /natnet:\/\/127\.0\.0\.1:\d+/.exec(await said(motive, '  to '))[0];
  const server = await view(context, [address]);
  const tab = await open(await browser(context), server.url);
  await waitForStates(tab, ['LIVE', 'LIVE']);
  const latency = tab.locator('.facts div', { hasText: 'Sending to here' }).locator('dd');
  await until(async () => /^\d.* ms, p99 \d.* ms$/.test(await latency.textContent()), 'a latency');
  await picture(tab, 'natnet');
  assertQuiet(tab);
});

test('a page whose server goes says so, and comes back with it', async (context) => {
  const first = await view(context, ['synthetic:walk?people=1&rate=60']);
  const tab = await open(await browser(context), first.url);
  await waitForStates(tab, ['LIVE']);
  await stop(first);
  await until(
    async () => (await tab.locator('#connection').textContent()).startsWith('Connection lost'),
    'the loss to be said',
  );
  await waitForStates(tab, ['UNKNOWN']);
  await picture(tab, 'disconnected');
  const { host } = new URL(first.url);
  start(context, 'view', 'synthetic:walk?people=2&rate=60', '--listen', host);
  await waitForStates(tab, ['LIVE', 'LIVE']);
  assert.equal(await tab.locator('#connection').textContent(), 'Connected');
});
