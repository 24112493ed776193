// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures the cost of foxglovesink for an OS1-128 at 10 scans/s, and prints a Markdown table of
// docs/results/ecosystem.md. tests/benchmarks/ecosystem.sh runs this script.
import { mkdtempSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import ws from '@foxglove/ws-protocol';
import WebSocket from 'ws';
import { CODERS, cpuOf, eachStream, head, row, SECONDS, start } from './measuring.mjs';
import { Pipeline, sleep, until } from './support.mjs';

const sinkOf = (statistics) => Object.values(statistics.elements).find((e) => e.factory === 'foxglovesink');

/** Measures with a client that takes all clouds. They lack a capture time; the sink's time of arrival counts. */
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

const folder = mkdtempSync(path.join(os.tmpdir(), 'lidar-measure-'));
try {
  console.log(`\n\`foxglovesink\` to a program of npm's \`@foxglove/ws-protocol\`, ${SECONDS} s each.\n`);
  head([
    'OS1-128', 'stream', 'size of a scan', 'scans that came', 'dropped', 'encoding, CPU per scan',
    'server thread, CPU per scan', 'latency, mean', 'latency, max',
  ]);
  await eachStream(folder, CODERS, measureClient);
} finally {
  await Pipeline.stopAll();
  rmSync(folder, { recursive: true });
}
