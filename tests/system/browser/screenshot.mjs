// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes the picture of the demo for the README and for the documentation of foxglovesink. With
// SHOTS=3, makes pictures of the light theme and of a phone, too.
// Usage: node tests/system/browser/screenshot.mjs FOLDER
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { openBrowser, openPage, sleep, until } from './support.mjs';

const folder = process.argv[2] ?? 'docs/images';
const seconds = Number(process.env.WAIT_S ?? 35);
const shots = [
  ['foxglovesink', { viewport: { width: 1280, height: 800 }, colorScheme: 'dark' }],
  ['foxglovesink-light', { viewport: { width: 1280, height: 800 }, colorScheme: 'light' }],
  ['foxglovesink-phone', { viewport: { width: 390, height: 780 }, colorScheme: 'dark' }],
].slice(0, Number(process.env.SHOTS ?? 1));

const root = new URL('../../..', import.meta.url).pathname;
const output = mkdtempSync(path.join(os.tmpdir(), 'lidar-demo-'));
const options = ['--view', '--slam', '--no-plots', '--duration', shots.length * (seconds + 30), '--output', output];
const demo = spawn(`${root}/pipelines/demo.sh`, ['--no-install', '--no-build', ...options], { stdio: ['ignore', 'inherit', 'inherit'] });
const ended = new Promise((done) => demo.on('exit', done));
const browser = await openBrowser();
try {
  for (const [name, options] of shots) {
    const page = await until('a page', () =>
      openPage(browser, 'http://127.0.0.1:8765/?also=127.0.0.1:8766', options).catch(() => null));
    await until('clouds', () => page.page.evaluate(() => window.lidarPage.scene.frames > 5));
    await sleep(seconds * 1000);
    await page.page.screenshot({ path: path.join(folder, `${name}.png`), timeout: 120_000 });
    if (page.complaints.length) console.error(page.complaints.join('\n'));
    await page.context.close();
  }
} finally {
  await browser.close();
  demo.kill('SIGINT');
  await ended;
  rmSync(output, { recursive: true });
}
