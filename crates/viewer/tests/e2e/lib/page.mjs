// The page in a real browser, which is let speak to nobody but the server of the test.

import assert from 'node:assert/strict';
import { mkdirSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { until } from './program.mjs';

const require = createRequire(path.join(process.env.WEB, 'package.json'));
const { chromium } = require('playwright-core');
export const AXE = require.resolve('axe-core/axe.min.js');
const PICTURES = process.env.PICTURES;

/** Opens a browser that draws in software, as machines without a graphics card do. */
export async function browser(context) {
  const args = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
  const quiet = ['--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run'];
  const opened = await chromium.launch({ executablePath: process.env.CHROMIUM, args: [...args, ...quiet] });
  context.after(() => opened.close());
  return opened;
}

/** Opens the page and waits until it has drawn. `problems` has each error of the console and each request elsewhere. */
export async function open(opened, url, options = {}) {
  const viewport = { width: 1280, height: 800 };
  const tab = await opened.newPage({ viewport, colorScheme: 'dark', ...options });
  tab.problems = [];
  const { origin } = new URL(url);
  tab.on(
    'console',
    (message) =>
      ['error', 'warning'].includes(message.type()) &&
      tab.problems.push(`${message.text()} (${message.location().url})`),
  );
  tab.on('pageerror', (error) => tab.problems.push(error.stack));
  tab.on(
    'request',
    (request) => elsewhere(request.url(), origin) && tab.problems.push(`a request to ${request.url()}`),
  );
  tab.on(
    'websocket',
    (socket) =>
      elsewhere(socket.url().replace(/^ws/, 'http'), origin) && tab.problems.push(`a socket to ${socket.url()}`),
  );
  await tab.goto(url);
  await tab.waitForFunction(() => window.posewire?.room.connection === 'open' && window.posewire.room.scene);
  return tab;
}

/** Nothing went wrong on the page, and nothing left it. What software drawing says of itself is not of the page. */
export function assertQuiet(tab) {
  const problems = tab.problems.filter((problem) => !/GPU stall|software fallback|GroupMarkerNotSet/.test(problem));
  assert.deepEqual(problems, []);
}

/** Keeps a picture of the page. */
export async function picture(tab, name) {
  mkdirSync(PICTURES, { recursive: true });
  await tab.screenshot({ path: path.join(PICTURES, `${name}.png`) });
}

/** Keeps a picture as WebP, which is a fraction of the PNG's size: the browser is the encoder. */
export async function smallPicture(tab, name) {
  const png = (await tab.screenshot()).toString('base64');
  const webp = await beside(tab, async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = Object.assign(document.createElement('canvas'), { width: image.width, height: image.height });
    canvas.getContext('2d').drawImage(image, 0, 0);
    return canvas.toDataURL('image/webp', 0.86).split(',')[1];
  }, png);
  mkdirSync(PICTURES, { recursive: true });
  writeFileSync(path.join(PICTURES, `${name}.webp`), Buffer.from(webp, 'base64'));
}

/** Runs a function with a picture's data on an empty page: the page itself may load nothing that is made of text. */
export async function beside(tab, work, data) {
  const empty = await tab.context().browser().newPage();
  const result = await empty.evaluate(work, data);
  await empty.close();
  return result;
}

/** Waits until the camera has come to rest: it has the performers in the picture. */
export async function atRest(tab) {
  await tab.evaluate(async (pictures) => {
    const round = (_, value) => (typeof value === 'number' ? value.toFixed(3) : value);
    const seen = () => JSON.stringify(window.posewire.stage.view(), round);
    for (let [before, still] = [seen(), 0]; still < pictures; ) {
      await new Promise(requestAnimationFrame);
      const now = seen();
      still = now === before ? still + 1 : 0;
      before = now;
    }
  }, 20);
}

/** Waits until the performers' states are these, in their order. */
export async function waitForStates(tab, expected) {
  const shown = () => tab.locator('.performer .state').allTextContents();
  await until(async () => (await shown()).join() === expected.join(), `the states ${expected.join()}`);
}

function elsewhere(url, origin) {
  return !['blob:', 'data:'].some((scheme) => url.startsWith(scheme)) && new URL(url).origin !== origin;
}
