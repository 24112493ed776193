// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes the pictures of the documentation: node tests/system/browser/screenshot.mjs FOLDER
// The page looks at a whole way: robot, a link that changes, edge.
import { spawn } from 'node:child_process';
import path from 'node:path';
import { freePort, openBrowser, openPage, Pipeline, sleep, until } from './support.mjs';

const folder = process.argv[2] ?? '.';
const seconds = Number(process.env.WAIT_S ?? 30);
const [port, rtp, link] = [await freePort(), await freePort(), await freePort()];
const relay = spawn(
  process.env.LIDAR_LINK ?? 'build/src/tools/lidar-link',
  ['--listen', `127.0.0.1:${link}`, '--forward', `127.0.0.1:${rtp}`, '--rtt', '40']
    .concat(['--steps', '4,2.2,3,1.8,4.4,2.6', '--step-time', '6'])
    .concat(['--aqm', 'ramp', '--aqm-low', '2', '--aqm-high', '10']),
  { stdio: 'ignore' },
);
const way =
  `lidartestsrc is-live=true model=os1-64 speed=8 ! queue ! lidarenc max-error=0.05 ! rtplidarpay ` +
  `! screamsink host=127.0.0.1 port=${link} start-bitrate=3000000 ` +
  `screamsrc port=${rtp} ! rtplidardepay ! tee name=coded ! queue ! foxglovesink name=web port=${port} ` +
  `coded. ! queue ! lidardec ! lidarodometry name=poses ! fakesink poses.odometry ! queue ! web.`;
const pipeline = await Pipeline.start(way, port);
const browser = await openBrowser();
const shots = [
  ['page', { viewport: { width: 1280, height: 800 }, colorScheme: 'dark' }],
  ['page-light', { viewport: { width: 1280, height: 800 }, colorScheme: 'light' }],
  ['page-phone', { viewport: { width: 390, height: 780 }, colorScheme: 'dark' }],
];
for (const [name, options] of shots.slice(0, Number(process.env.SHOTS ?? 1))) {
  const { page, context, complaints } = await openPage(browser, `http://127.0.0.1:${port}/`, options);
  await until('clouds', () => page.evaluate(() => window.lidarPage.scene.frames > 5));
  await sleep(seconds * 1000);
  await page.screenshot({ path: path.join(folder, `${name}.png`), timeout: 120_000 });
  if (complaints.length) console.error(complaints.join('\n'));
  await context.close();
}
await browser.close();
await pipeline.stop();
relay.kill();
