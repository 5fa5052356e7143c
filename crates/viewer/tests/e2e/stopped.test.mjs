// A page that stops reading, as one does in a debugger: nobody else notices, and it comes back to the newest pose.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { browser, open, waitForStates } from './lib/page.mjs';
import { memory, monitor, start, stop, until, view } from './lib/program.mjs';

/** How long the page is stopped, seconds. */
const STOPPED = Number(process.env.STOPPED_S ?? 6);

test(
  'a page in a debugger disturbs neither other pages nor the source',
  { timeout: 60_000 + STOPPED * 1000 },
  async (context) => {
    const truth = await monitor(context);
    const server = await view(context, ['mxtp://127.0.0.1:0']);
    const stream = start(
      context,
      'stream',
      'synthetic:walk?people=4&rate=60',
      '--to',
      server.endpoint,
      '--to',
      truth.endpoint,
    );
    const opened = await browser(context);
    const [stopped, other] = [await open(opened, server.url), await open(await browser(context), server.url)];
    for (const tab of [stopped, other]) await waitForStates(tab, ['LIVE', 'LIVE', 'LIVE', 'LIVE']);

    const watch = await listener(opened, server.url);

    const debug = await stopped.context().newCDPSession(stopped);
    await debug.send('Debugger.enable');
    const paused = new Promise((resolve) => debug.once('Debugger.paused', resolve));
    await debug.send('Debugger.pause');
    await paused;
    const before = memory(server);
    await watch.evaluate(countTicks);
    const drawn = await newest(other);
    await new Promise((resolve) => setTimeout(resolve, STOPPED * 1000));
    const counted = await watch.evaluate(() => window.counted);
    const after = memory(server);

    assert.ok(counted.ticks > 20 * STOPPED, `another listener had ${counted.ticks} ticks in ${STOPPED} s`);
    assert.ok(counted.longest < 1000, `another listener had nothing for ${counted.longest} ms`);
    assert.ok((await newest(other)) > drawn + 30 * STOPPED, 'the other page shows newer poses');
    if (before !== null && after !== null) {
      assert.ok(after - before < 32e6, `the server grew by ${((after - before) / 1e6).toFixed(1)} MB`);
    }

    await debug.send('Debugger.resume');
    await until(
      async () => Math.abs((await newest(stopped)) - (await newest(other))) < 30,
      'the stopped page to have caught up',
    );
    await stop(stream);
    const frames = truth.frames();
    const samples = new Set(frames.filter(({ name }) => name === 'Ada').map(({ sample }) => sample));
    const last = Math.max(...samples);
    assert.equal(samples.size, last + 1 - Math.min(...samples), 'the stream itself lost nothing');
  },
);

/** The sample that a page has of the first performer. */
const newest = (tab) => tab.evaluate(() => window.posewire.room.records.get(0).sample);

/** A page of the same server that draws nothing: what it receives does not depend on how fast this machine draws. */
async function listener(opened, url) {
  const tab = await (await opened.newContext()).newPage();
  await tab.goto(new URL('/healthz', url).href);
  return tab;
}

/** Counts the ticks that come from now on, and the longest time between two. */
async function countTicks() {
  const socket = new WebSocket(`ws://${location.host}/ws`);
  socket.binaryType = 'arraybuffer';
  await new Promise((resolve, reject) => Object.assign(socket, { onopen: resolve, onerror: reject }));
  let before = performance.now();
  window.counted = { ticks: 0, longest: 0 };
  socket.onmessage = ({ data }) => {
    if (typeof data === 'string' || new Uint8Array(data)[0] !== 1) return;
    const now = performance.now();
    const { ticks, longest } = window.counted;
    window.counted = { ticks: ticks + 1, longest: Math.max(longest, now - before) };
    before = now;
  };
}
