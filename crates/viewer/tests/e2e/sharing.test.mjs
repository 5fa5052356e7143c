// Keeping and sharing a view.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { assertQuiet, beside, browser, open, waitForStates } from './lib/page.mjs';
import { until, view } from './lib/program.mjs';

test('a screenshot is a picture of the stage', async (context) => {
  const server = await view(context, ['synthetic:walk?people=2&rate=60']);
  const tab = await open(await browser(context), server.url);
  await waitForStates(tab, ['LIVE', 'LIVE']);
  const [download] = await Promise.all([tab.waitForEvent('download'), tab.keyboard.press('p')]);
  assert.match(download.suggestedFilename(), /^posewire_\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d\.png$/);
  const png = readFileSync(await download.path());
  assert.equal(png.subarray(1, 4).toString(), 'PNG');
  const size = { width: png.readUInt32BE(16), height: png.readUInt32BE(20) };
  const colors = await beside(tab, colorsOf, png.toString('base64'));
  assert.ok(size.width > 300 && size.height > 200, JSON.stringify(size));
  assert.ok(colors > 200, `a picture of ${colors} colours`);
  assertQuiet(tab);
});

/** How many colours a picture has: one that was never drawn has one. */
async function colorsOf(data) {
  const image = new Image();
  image.src = `data:image/png;base64,${data}`;
  await image.decode();
  const canvas = Object.assign(document.createElement('canvas'), { width: image.width, height: image.height });
  const context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  return new Set(new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer)).size;
}

test('an address shows another page the same view', async (context) => {
  const server = await view(context, ['synthetic:walk?people=3&rate=60']);
  const opened = await browser(context);
  const tab = await open(opened, server.url, { permissions: ['clipboard-read', 'clipboard-write'] });
  await waitForStates(tab, ['LIVE', 'LIVE', 'LIVE']);
  await tab.keyboard.press('2');
  await tab.keyboard.press('a');
  await tab.keyboard.press('n');
  await tab.getByRole('button', { name: 'Hide Cleo' }).click();
  await tab.getByRole('button', { name: 'Follow Bram' }).click();
  await tab.evaluate(() => window.posewire.plot('1:position/Pelvis/z'));
  await tab.keyboard.press('s');
  await until(async () => (await tab.locator('#toast').textContent()).includes('address'), 'the address to be told');
  const address = await tab.evaluate(() => navigator.clipboard.readText());

  const other = await open(opened, address);
  await waitForStates(other, ['LIVE', 'LIVE', 'LIVE']);
  const pressed = (name) => other.getByRole('button', { name, exact: true }).getAttribute('aria-pressed');
  assert.deepEqual(
    await Promise.all(['Follow Bram', 'Follow Ada', 'Hide Cleo', 'Axes', 'Names', 'Plots'].map(pressed)),
    ['true', 'false', 'true', 'true', 'false', 'true'],
  );
  assert.deepEqual(await other.evaluate(() => [...window.posewire.traces.keys()]), ['1:position/Pelvis/z']);
  assert.equal(await other.evaluate(() => window.posewire.stage.view().follow), 1);
  assertQuiet(other);
});
