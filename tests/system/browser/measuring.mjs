// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions that measure.mjs and measure_page.mjs share: they make scans of an OS1-128 from files,
// and Markdown.
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { freePort, Pipeline } from './support.mjs';

export const SECONDS = Number(process.env.WAIT_S ?? 20);
export const CODERS = { raw: '', 'Draco at 2 cm': '! dracoenc geometry=xyz max-error=0.02' };
const WIDTHS = [1024, 2048];
const TICKS = 100; // clock ticks per second, the unit of CPU time in /proc
const SCANS = 10; // the number of scans, which are repeated
const FIELDS = 'x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16';

/** The CPU time so far [s] of a process's threads whose name begins with `name`. */
export function cpuOf(pid, name) {
  let ticks = 0;
  for (const task of readdirSync(`/proc/${pid}/task`)) {
    const stat = readFileSync(`/proc/${pid}/task/${task}/stat`, 'utf8');
    if (!stat.includes(`(${name}`)) continue;
    const fields = stat.slice(stat.lastIndexOf(')') + 2).split(' ');
    ticks += Number(fields[11]) + Number(fields[12]);
  }
  return ticks / TICKS;
}

/** Writes scans to files, so that no ray caster runs meanwhile; returns a source that plays them. */
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

/** Calls `measure(name, width, source, coder)` for each width of scans and each coder. */
export async function eachStream(folder, coders, measure) {
  for (const width of WIDTHS) {
    const source = record(folder, width);
    for (const [name, coder] of Object.entries(coders)) await measure(name, width, source, coder);
  }
}

export async function start(source, coder) {
  const port = await freePort();
  const way = `${source} ${coder} ! queue leaky=downstream ! foxglovesink sync=false port=${port}`;
  return { port, pipeline: await Pipeline.start(way, port) };
}

export const row = (cells) => console.log(`| ${cells.join(' | ')} |`);
export function head(cells) {
  row(cells);
  row(cells.map(() => '---'));
}
