#!/usr/bin/env node
// Measures how many pictures a second the browser page draws in software: 16 people with fingers at 240 Hz, one page.
//
//     bench/page.mjs [PEOPLE] [SECONDS]
//
// Needs Chromium, and the packages of the page (`npm ci` in crates/viewer/web). Everything runs on this machine: stream,
// server and browser. Prints a row of a Markdown table.

import { execFileSync } from 'node:child_process';
import { loadavg, tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';

const root = path.resolve(import.meta.dirname, '..');
const [people, seconds] = [process.argv[2] ?? '16', Number(process.argv[3] ?? 20)];
process.env.POSEWIRE ??= path.join(root, 'target/release/posewire');
process.env.CHROMIUM ??= '/usr/bin/chromium';
process.env.WEB ??= path.join(root, 'crates/viewer/web');
process.env.PICTURES ??= tmpdir();
const { browser, open } = await import('../crates/viewer/tests/e2e/lib/page.mjs');
const { start, view } = await import('../crates/viewer/tests/e2e/lib/program.mjs');

execFileSync('cargo', ['build', '--release', '--quiet', '--package', 'posewire-cli'], { cwd: root, stdio: 'inherit' });

test('the page draws', { timeout: 60_000 + 2000 * seconds }, async (context) => {
  const server = await view(context, ['mxtp://127.0.0.1:0']);
  start(context, 'stream', `synthetic:walk?people=${people}&rate=240&fingers=true`, '--to', server.endpoint);
  const tab = await open(await browser(context), server.url);
  // Until the page has found the quality that it can hold.
  await tab.waitForTimeout(10_000);
  const looks = [];
  for (let second = 0; second < seconds; second++) {
    await tab.waitForTimeout(1000);
    looks.push(await tab.evaluate(() => window.posewire.stage.stats()));
  }
  const sorted = looks.map(({ fps }) => fps).toSorted((a, b) => a - b);
  const [least, median, most] = [0, sorted.length >> 1, sorted.length - 1].map((place) => sorted[place]);
  const { quality, software, calls, triangles } = looks.at(-1);
  console.log('| people | a second: least, median, most | quality, 0 is best | in software | draw calls | triangles | load |');
  console.log('|---|---|---|---|---|---|---|');
  console.log(
    `| ${people} | ${least}, ${median}, ${most} | ${quality} | ${software} | ${calls} | ${triangles} | ${loadavg()[0].toFixed(1)} |`,
  );
});
