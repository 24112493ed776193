// SPDX-License-Identifier: LGPL-2.1-or-later
// What foxglovesink costs at OS1-128 and 10 scans/s, and what its page draws, as Markdown tables:
// tests/benchmarks/ecosystem.sh runs it, and docs/results/ecosystem.md has the figures.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import ws from '@foxglove/ws-protocol';
import WebSocket from 'ws';
import { freePort, openBrowser, openPage, Pipeline, sleep, until } from './support.mjs';

const SECONDS = Number(process.env.WAIT_S ?? 20);
const TICKS = 100; // a second, of /proc
const CODERS = { raw: '', 'Draco at 2 cm': '! dracoenc geometry=xyz max-error=0.02' };
const PAGE_CODERS = { ...CODERS, 'slices at 2 cm': '! lidarenc max-error=0.02' };
const CLOUDS = ['lidar.Slice', 'foxglove.PointCloud', 'foxglove.CompressedPointCloud'];
const SCANS = 10; // that are played again and again
const FIELDS = 'x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16';

/** CPU time of the threads of that name so far [s]. */
function cpuOf(pid, name) {
  let ticks = 0;
  for (const task of readdirSync(`/proc/${pid}/task`)) {
    const stat = readFileSync(`/proc/${pid}/task/${task}/stat`, 'utf8');
    if (!stat.includes(`(${name}`)) continue;
    const fields = stat.slice(stat.lastIndexOf(')') + 2).split(' ');
    ticks += Number(fields[11]) + Number(fields[12]);
  }
  return ticks / TICKS;
}

/** Puts scans into files, so that no ray caster runs beside what is measured; gives what plays them. */
function record(folder, width) {
  const files = path.join(folder, `${width}-%d.bin`);
  const line =
    `lidartestsrc model=os1-128 mode=${width}x10 slices-per-scan=1 speed=5 num-buffers=${SCANS} ` +
    `! multifilesink location=${files}`;
  const output = execFileSync('gst-launch-1.0', ['-v', ...line.split(' ')], { encoding: 'utf8' });
  const model = /sensor-model=\(buffer\)([0-9a-f]+)/.exec(output)[1];
  return (
    `multifilesrc location=${files} loop=true stop-index=${SCANS - 1} caps=application/x-pointcloud2,` +
    `width=${width},height=128,point-step=20,fields=(string)"${FIELDS}",framerate=10/1,sensor-model=(buffer)${model} ` +
    '! pointcloudparse ! identity sync=true'
  );
}

async function start(source, coder) {
  const port = await freePort();
  const way = `${source} ${coder} ! queue leaky=downstream ! foxglovesink sync=false port=${port}`;
  return { port, pipeline: await Pipeline.start(way, port) };
}

const sinkOf = (statistics) => Object.values(statistics.elements).find((e) => e.factory === 'foxglovesink');
const row = (cells) => console.log(`| ${cells.join(' | ')} |`);

/** A program that takes clouds as they come. They have no capture time, so their time is when the sink got them. */
async function measureClient(name, width, source, coder) {
  const { port, pipeline } = await start(source, coder);
  const socket = new WebSocket(`ws://127.0.0.1:${port}`, ['foxglove.sdk.v1'], { maxPayload: 2 ** 28 });
  const client = new ws.FoxgloveClient({ ws: socket });
  const topics = new Map();
  const seen = { clouds: 0, bytes: 0, sum: 0, most: 0, statistics: null };
  client.on('advertise', (list) => {
    for (const channel of list) topics.set(client.subscribe(channel.id), channel.topic);
  });
  client.on('message', ({ subscriptionId, timestamp, data }) => {
    if (topics.get(subscriptionId) === '/statistics') {
      seen.statistics = sinkOf(JSON.parse(new TextDecoder().decode(data)));
      return;
    }
    const ms = performance.timeOrigin + performance.now() - Number(timestamp) / 1e6;
    seen.clouds += 1;
    seen.bytes += data.byteLength;
    seen.sum += ms;
    seen.most = Math.max(seen.most, ms);
  });
  await until('clouds', () => seen.clouds > 5 && seen.statistics);
  const cpu = (thread) => cpuOf(pipeline.child.pid, thread);
  const read = () => ({ ...seen.statistics, encode: cpu('queue0:src'), server: cpu('foxglovesink') });
  const before = read();
  Object.assign(seen, { clouds: 0, bytes: 0, sum: 0, most: 0 });
  await sleep(SECONDS * 1000);
  const now = read();
  const perScan = (what) => `${(((now[what] - before[what]) * 1000) / (now.clouds - before.clouds)).toFixed(2)} ms`;
  row([
    `${width}x10`, name, `${(seen.bytes / seen.clouds / 1e6).toFixed(3)} MB`, `${seen.clouds} of ${SECONDS * 10}`,
    now.messages_dropped - before.messages_dropped, perScan('encode'), perScan('server'),
    `${(seen.sum / seen.clouds).toFixed(1)} ms`, `${seen.most.toFixed(1)} ms`,
  ]);
  client.close();
  await pipeline.stop();
}

/** CPU time so far of the threads of that name in all of the browser [s]. */
function browserCpu(thread) {
  const isOurs = (pid) => {
    try {
      return /^\d+$/.test(pid) && readFileSync(`/proc/${pid}/cmdline`, 'utf8').includes('--type=renderer');
    } catch {
      return false; // it has ended
    }
  };
  return readdirSync('/proc').filter(isOurs).reduce((sum, pid) => sum + cpuOf(pid, thread), 0);
}

/** Notes, in the page, the age of each cloud that was drawn, and tasks that held up its main thread. */
function observe() {
  const seen = { ages: [], longest: 0, last: null };
  window.measured = seen;
  new PerformanceObserver((list) => {
    for (const { duration } of list.getEntries()) seen.longest = Math.max(seen.longest, duration);
  }).observe({ type: 'longtask' });
  setInterval(() => {
    const { age } = window.lidarPage;
    if (age !== null && age !== seen.last) seen.ages.push((seen.last = age));
  }, 10);
}

/** The page in a headless browser, where software draws. */
async function measurePage(browser, name, width, source, coder) {
  const { port, pipeline } = await start(source, coder);
  const { page, context } = await openPage(browser, `http://127.0.0.1:${port}/`);
  const read = () =>
    page.evaluate((schemas) => {
      const { scene, received } = window.lidarPage;
      const clouds = schemas.map((schema) => received[schema]).find(Boolean);
      return { ...window.measured, ...clouds, frames: scene.frames, points: scene.fresh.count, at: performance.now() };
    }, CLOUDS);
  await until('a picture', () => page.evaluate(() => window.lidarPage.scene.fresh.count > 0));
  await sleep(3000); // compilers, and what else a page does once
  await page.evaluate(observe);
  const before = await read();
  const cpu = browserCpu('DedicatedWorker');
  await sleep(SECONDS * 1000);
  const now = await read();
  const worker = browserCpu('DedicatedWorker') - cpu;
  const rate = (what, digits = 1) => (((now[what] - before[what]) * 1000) / (now.at - before.at)).toFixed(digits);
  const ages = now.ages.sort((a, b) => a - b);
  row([
    `${width}x10`, name, now.points, `${rate('messages')} scans/s`, `${rate('frames')} frames/s`,
    `${((rate('bytes', 0) * 8) / 1e6).toFixed(1)} Mbit/s`, `${((100 * worker) / SECONDS).toFixed(0)} %`,
    `${now.longest.toFixed(0)} ms`, `${(1000 * (ages[Math.floor(0.95 * ages.length)] ?? NaN)).toFixed(0)} ms`,
  ]);
  await context.close();
  await pipeline.stop();
}

const folder = mkdtempSync(path.join(os.tmpdir(), 'lidar-measure-'));
try {
  const sources = new Map([1024, 2048].map((width) => [width, record(folder, width)]));
  const each = async (measure, coders) => {
    for (const [width, source] of sources)
      for (const [name, coder] of Object.entries(coders)) await measure(name, width, source, coder);
  };
  console.log(`\n\`foxglovesink\` to a program of npm's \`@foxglove/ws-protocol\`, ${SECONDS} s each.\n`);
  row([
    'OS1-128', 'stream', 'size of a scan', 'scans that came', 'dropped', 'encoding, CPU per scan',
    'server thread, CPU per scan', 'latency, mean', 'latency, max',
  ]);
  row(Array(9).fill('---'));
  await each(measureClient, CODERS);
  const browser = await openBrowser();
  console.log(`\nThe page in Chromium ${browser.version()}, headless, drawn by software.\n`);
  row([
    'OS1-128', 'stream', 'points of a picture', 'taken', 'drawn', 'downlink', 'worker, of a core',
    'longest task of the main thread', 'sink to picture, p95',
  ]);
  row(Array(9).fill('---'));
  await each((...of) => measurePage(browser, ...of), PAGE_CODERS);
  await browser.close();
} finally {
  await Pipeline.stopAll();
  rmSync(folder, { recursive: true });
}
