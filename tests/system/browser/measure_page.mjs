// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures the page in a headless Chromium without a graphics card, and prints Markdown tables of
// docs/results/ecosystem.md.
// Usage: measure_page.mjs [way]. With `way`, measures only the delay of a slice.
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { audit } from './axe.mjs';
import { CODERS, cpuOf, eachStream, head, row, SECONDS, start } from './measuring.mjs';
import { freePort, openBrowser, openPage, Pipeline, sleep, until } from './support.mjs';

const SETTLED_MS = 3000; // the time after which work of the start, such as compiling, has ended
const CLOUDS = ['lidar.Slice', 'foxglove.PointCloud', 'foxglove.CompressedPointCloud'];
const LONG_MS = 50; // browsers report only tasks of at least this duration

const quantile = (share, values) => values.sort((a, b) => a - b)[Math.floor(share * values.length)] ?? NaN;
const ms = (seconds) => (1000 * seconds).toFixed(0);
/** The parts of a slice's way to the screen; each key is the time at which the part ends. */
const PARTS = {
  sent: 'first column to `foxglovesink`: the sensor, coder, SCReAM and receiver',
  received: 'to the page: socket, and the main thread that is busy',
  decoded: 'to points: the worker, and messages to it and back',
  begun: 'to the begin of a frame',
  drawn: 'the frame, up to the begin of the next',
};

/** The CPU time so far [s] of all of the browser's threads named `thread`. */
function browserCpu(thread) {
  const isOurs = (pid) => {
    try {
      return /^\d+$/.test(pid) && readFileSync(`/proc/${pid}/cmdline`, 'utf8').includes('--type=renderer');
    } catch {
      return false; // the process has ended
    }
  };
  return readdirSync('/proc').filter(isOurs).reduce((sum, pid) => sum + cpuOf(pid, thread), 0);
}

/**
 * Runs in the page: turns the camera, so that each frame is drawn, and notes long tasks of the main
 * thread, and when each of a slice's PARTS ended.
 */
function observe(turns) {
  const seen = { slices: [], longest: 0, blocked: 0 };
  window.measured = seen;
  const { scene, slices } = window.lidarPage;
  scene.controls.autoRotate = turns;
  new PerformanceObserver((list) => {
    for (const { duration } of list.getEntries()) {
      seen.longest = Math.max(seen.longest, duration);
      ++seen.blocked;
    }
  }).observe({ type: 'longtask' });
  const now = () => (performance.timeOrigin + performance.now()) / 1000;
  const received = new Map(); // the time of receipt of each slice, by the time of sending
  const add = slices.add.bind(slices);
  slices.add = (channel, bytes, captured) => {
    const sent = new DataView(bytes.buffer, bytes.byteOffset).getBigUint64(16, true);
    received.set(Number(sent) * 1e-9, now());
    add(channel, bytes, captured);
  };
  const { points } = slices.on;
  let waiting = [];
  slices.on.points = (about, header, ...rest) => {
    const { captured, sent } = header;
    if (received.has(sent)) waiting.push({ captured, sent, received: received.get(sent), decoded: now() });
    received.delete(sent);
    return points(about, header, ...rest);
  };
  // A picture is visible when the next frame begins, so slices get their time `drawn` in the next
  // call.
  let drawn = [];
  const draw = scene.draw.bind(scene);
  scene.draw = () => {
    seen.slices.push(...drawn.map((slice) => ({ ...slice, drawn: now() })));
    drawn = waiting.map((slice) => ({ ...slice, begun: now() }));
    waiting = [];
    return draw();
  };
}

const read = (page) =>
  page.evaluate((schemas) => {
    const { scene, received } = window.lidarPage;
    const clouds = schemas.map((schema) => received[schema]).find(Boolean);
    return { ...window.measured, ...clouds, frames: scene.frames, points: scene.fresh.count, at: performance.now() };
  }, CLOUDS);

/** Reads the page `before` and after (`now`) SECONDS, and its workers' CPU time [s]. */
async function watch(page, turns) {
  await until('a picture', () => page.evaluate(() => window.lidarPage.scene.fresh.count > 0));
  await sleep(SETTLED_MS);
  await page.evaluate(observe, turns);
  const before = await read(page);
  const cpu = browserCpu('DedicatedWorker');
  await sleep(SECONDS * 1000);
  const now = await read(page);
  const worker = browserCpu('DedicatedWorker') - cpu;
  return { now, worker, rate: (what) => ((now[what] - before[what]) * 1000) / (now.at - before.at) };
}

async function measureStream(browser, name, width, source, coder) {
  const { port, pipeline } = await start(source, coder);
  const { page, context } = await openPage(browser, `http://127.0.0.1:${port}/`);
  const { now, worker, rate } = await watch(page, true);
  row([
    `${width}x10`, name, now.points, `${rate('messages').toFixed(1)} scans/s`, `${(rate('bytes') * 8e-6).toFixed(1)} Mbit/s`,
    `${rate('frames').toFixed(1)} frames/s`, `${((100 * worker) / SECONDS).toFixed(0)} %`,
    now.blocked > 0 ? `${now.blocked}, ${now.longest.toFixed(0)} ms at most` : 'none',
  ]);
  await context.close();
  await pipeline.stop();
}

/** Measures the way of slices from the sensor over SCReAM to the screen. */
async function measureWay(browser, model) {
  const [port, rtp] = [await freePort(), await freePort()];
  const pipeline = await Pipeline.start(
    `lidartestsrc is-live=true model=${model} speed=5 ! queue ! lidarenc ! rtplidarpay ! screamsink host=127.0.0.1 port=${rtp} ` +
      `screamsrc port=${rtp} ! rtplidardepay ! foxglovesink port=${port}`, port);
  const { page, context } = await openPage(browser, `http://127.0.0.1:${port}/`);
  const { now, rate } = await watch(page, false);
  console.log(`${model.toUpperCase()}, ${rate('frames').toFixed(1)} frames/s:\n`);
  head(['part', 'median [ms]', 'p95 [ms]', 'p95 from capture to its end [ms]']);
  let from = 'captured';
  for (const [to, name] of Object.entries(PARTS)) {
    const [part, all] = [from, 'captured'].map((begin) => now.slices.map((slice) => slice[to] - slice[begin]));
    row([name, ms(quantile(0.5, part)), ms(quantile(0.95, part)), ms(quantile(0.95, all))]);
    from = to;
  }
  await context.close();
  await pipeline.stop();
}

async function measureAxe(browser, name, options) {
  const port = await freePort();
  const way = `lidartestsrc is-live=true model=os0-32 mode=512x10 ! lidarenc ! foxglovesink port=${port}`;
  const pipeline = await Pipeline.start(way, port);
  const { page, context } = await openPage(browser, `http://127.0.0.1:${port}/`, options);
  await until('a timeline', () => page.evaluate(() => !document.getElementById('timeline').hidden));
  await page.click('#more');
  const { violations, passes } = await audit(page);
  row([name, passes.length, violations.length > 0 ? violations.join('; ') : 0]);
  await context.close();
  await pipeline.stop();
}

async function measurePage(browser, folder) {
  console.log(`Chromium ${browser.version()}, headless, drawn by software; the camera turns.\n`);
  head([
    'OS1-128', 'stream', 'points of a picture', 'taken', 'downlink', 'drawn', 'workers, of a core',
    `tasks of the main thread above ${LONG_MS} ms`,
  ]);
  const coders = { ...CODERS, 'slices at 2 cm': '! lidarenc max-error=0.02' };
  await eachStream(folder, coders, (...of) => measureStream(browser, ...of));
  console.log('\nThe accessibility checker axe finds:\n');
  head(['page', 'rules that hold', 'violations']);
  await measureAxe(browser, 'desk, dark', { colorScheme: 'dark' });
  await measureAxe(browser, 'phone, light', { viewport: { width: 390, height: 780 }, colorScheme: 'light' });
}

const folder = mkdtempSync(path.join(os.tmpdir(), 'lidar-measure-'));
const browser = await openBrowser();
try {
  await (process.argv[2] === 'way' ? measureWay(browser, 'os1-64') : measurePage(browser, folder));
} finally {
  await browser.close();
  await Pipeline.stopAll();
  rmSync(folder, { recursive: true });
}
