// Everybody's page: keyboard, narrow screens, contrast, names of controls.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { AXE, assertQuiet, browser, open, picture, waitForStates } from './lib/page.mjs';
import { start, until, view } from './lib/program.mjs';
import { walkerTake } from './lib/take.mjs';

/** axe finds nothing to object to. */
async function assertAccessible(tab, where) {
  // Not as a script of the page, which its security policy would refuse.
  await tab.evaluate(readFileSync(AXE, 'utf8'));
  const found = await tab.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
  const said = found.violations.map(
    ({ id, nodes }) => `${id}: ${nodes.map(({ html, failureSummary }) => `${html}\n${failureSummary}`).join('\n')}`,
  );
  assert.deepEqual(said, [], where);
}

for (const colorScheme of ['dark', 'light']) {
  test(`axe has no objection to the page in ${colorScheme}`, async (context) => {
    const server = await view(context, ['mxtp://127.0.0.1:0']);
    const opened = await browser(context);
    const tab = await open(opened, server.url, { colorScheme });
    await assertAccessible(tab, 'waiting');
    const streams = start(context, 'stream', 'synthetic:walk?people=2&rate=60', '--to', server.endpoint);
    await waitForStates(tab, ['LIVE', 'LIVE']);
    await tab.evaluate(() => {
      window.posewire.plot('0:position/Pelvis/z');
      window.posewire.plot('0:joint_angles/jRightKnee/z');
    });
    await until(() => tab.evaluate(() => window.posewire.traces.all.length === 2), 'both channels');
    await tab.keyboard.press('g');
    await assertAccessible(tab, 'live with plots');
    await picture(tab, `live-${colorScheme}`);
    await tab.keyboard.press('?');
    await assertAccessible(tab, 'help');
    await tab.keyboard.press('Escape');
    await tab.getByRole('button', { name: 'Channel', exact: true }).click();
    await assertAccessible(tab, 'picker');
    await tab.keyboard.press('Escape');
    streams.child.kill('SIGINT');
    await waitForStates(tab, ['LOST', 'LOST']);
    await assertAccessible(tab, 'lost');
    assertQuiet(tab);
  });
}

test('axe has no objection to takes, nor on a phone', async (context) => {
  const folder = mkdtempSync(path.join(tmpdir(), 'posewire-'));
  const take = await walkerTake(context, folder, 'walk.mvnx', 3);
  const server = await view(context, [take.file]);
  const opened = await browser(context);
  const tab = await open(opened, server.url);
  await assertAccessible(tab, 'take');
  const phone = await open(opened, `${server.url}#plot=0:position/Pelvis/z`, {
    viewport: { width: 390, height: 844 },
    hasTouch: true,
    isMobile: true,
  });
  await assertAccessible(phone, 'phone');
  await picture(phone, 'phone-take');
  assertQuiet(phone);
});

test('a page without the token says where it is', async (context) => {
  const server = await view(context, ['synthetic:walk?rate=60'], '--token');
  const opened = await browser(context);
  const stranger = await opened.newPage();
  await stranger.goto(new URL('/', server.url).href);
  await until(
    async () => /does not let this page in.*The token/.test(await stranger.locator('#empty').textContent()),
    'why',
  );
  await picture(stranger, 'refused');
  const tab = await open(opened, server.url);
  await waitForStates(tab, ['LIVE']);
  assert.equal(new URL(tab.url()).search, '');
  assertQuiet(tab);
});

test('everything is reached by keys, with the focus in sight', async (context) => {
  const server = await view(context, ['synthetic:walk?people=2&rate=60']);
  const tab = await open(await browser(context), server.url);
  await waitForStates(tab, ['LIVE', 'LIVE']);
  const reached = new Set();
  for (let press = 0; press < 40; press++) {
    await tab.keyboard.press('Tab');
    const { name, visible } = await tab.evaluate(() => {
      const element = document.activeElement;
      const { outlineStyle, outlineWidth } = getComputedStyle(element);
      const name = element.getAttribute('aria-label') ?? element.textContent;
      return {
        name: name.trim(),
        visible: element === document.body || (outlineStyle !== 'none' && parseFloat(outlineWidth) >= 2),
      };
    });
    assert.ok(visible, `the focus on “${name}” is not seen`);
    reached.add(name);
  }
  const wanted = [
    'Save a picture',
    'Copy the address of this view',
    'Light or dark',
    'Keys and help',
    'Free',
    'Top',
    'Names',
    'Axes',
    'Plots',
    'Follow Ada',
    'Hide Ada',
  ];
  assert.deepEqual(
    wanted.filter((name) => !reached.has(name)),
    [],
  );
  await tab.keyboard.press('f');
  assert.equal(await tab.getByRole('button', { name: 'Follow Ada' }).getAttribute('aria-pressed'), 'true');
  await tab.keyboard.press('l');
  assert.equal(await tab.evaluate(() => document.documentElement.dataset.theme), 'light');
  assertQuiet(tab);
});

test('a phone has the performers in a sheet, and nothing is wider than its screen', async (context) => {
  const server = await view(context, ['synthetic:walk?people=3&rate=60']);
  const phone = await open(await browser(context), server.url, {
    viewport: { width: 390, height: 844 },
    hasTouch: true,
    isMobile: true,
  });
  const sheet = phone.locator('#sheet');
  assert.equal(await sheet.isVisible(), false);
  await phone.getByRole('button', { name: '3 performers' }).tap();
  assert.equal(await sheet.isVisible(), true);
  await waitForStates(phone, ['LIVE', 'LIVE', 'LIVE']);
  await phone.getByRole('button', { name: 'Follow Cleo' }).tap();
  assert.equal(await phone.evaluate(() => window.posewire.room.followed), 2);
  assert.equal(await phone.evaluate(() => document.documentElement.scrollWidth), 390);
  await picture(phone, 'phone');
  await phone.getByRole('button', { name: '3 performers' }).tap();
  assert.equal(await sheet.isVisible(), false);
  assertQuiet(phone);
});
