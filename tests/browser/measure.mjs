// SPDX-License-Identifier: LGPL-2.1-or-later
// What the page and foxglovesink cost at 131,072 points and 10 scans/s: node tests/browser/measure.mjs
// Run by hand; prints a line for raw clouds and one for Draco (docs/results/ecosystem.md).
import { readdirSync, readFileSync } from 'node:fs';
import { freePort, openBrowser, openPage, Pipeline, sleep, until } from './support.mjs';

const SECONDS = Number(process.env.WAIT_S ?? 20);
const TICKS = 100; // a second, of /proc

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

const browser = await openBrowser();
const coders = { raw: '', draco: '! dracoenc geometry=xyz max-error=0.02' };
for (const [name, coder] of Object.entries(coders)) {
  const port = await freePort();
  const way =
    `lidartestsrc is-live=true model=os1-128 mode=1024x10 slices-per-scan=1 speed=5 ${coder} ` +
    `! queue leaky=downstream ! foxglovesink port=${port}`;
  const pipeline = await Pipeline.start(way.replace(/ {2,}/g, ' '), port);
  const { page, context } = await openPage(browser, `http://127.0.0.1:${port}/`);
  const read = () =>
    page.evaluate(() => {
      const cloudsOf = (r) => ({ ...(r['foxglove.PointCloud'] ?? r['foxglove.CompressedPointCloud']) });
      const { scene, statistics, received } = window.lidarPage;
      const sink = Object.values(statistics.elements).find((e) => e.factory === 'foxglovesink');
      return { frames: scene.frames, points: scene.fresh.count, at: performance.now(), sink, received: cloudsOf(received) };
    });
  await until('a picture', () =>
    page.evaluate(() => window.lidarPage.statistics && window.lidarPage.scene.fresh.count > 0),
  );
  const cpu = (thread) => cpuOf(pipeline.child.pid, thread);
  const before = { page: await read(), server: cpu('foxglovesink'), encode: cpu('queue0:src') };
  await sleep(SECONDS * 1000);
  const now = { page: await read(), server: cpu('foxglovesink'), encode: cpu('queue0:src') };
  const seconds = (now.page.at - before.page.at) / 1000;
  const [a, b] = [before.page.sink, now.page.sink];
  const got = now.page.received.messages - before.page.received.messages;
  const bytes = now.page.received.bytes - before.page.received.bytes;
  const clouds = b.clouds - a.clouds;
  console.log(
    `${name}: ${((now.page.frames - before.page.frames) / seconds).toFixed(1)} frames/s, ` +
      `${now.page.points} points, ${(clouds / seconds).toFixed(1)} scans/s, ` +
      `${(bytes / got / 1e6).toFixed(3)} MB a scan, ` +
      `${got} received, ${b.messages_dropped - a.messages_dropped} dropped; ` +
      `CPU per scan: server ${(((now.server - before.server) * 1000) / clouds).toFixed(2)} ms, ` +
      `encoding ${(((now.encode - before.encode) * 1000) / clouds).toFixed(2)} ms`,
  );
  await context.close();
  await pipeline.stop();
}
await browser.close();
