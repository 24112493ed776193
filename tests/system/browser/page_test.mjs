// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the page in a real browser: what a user sees and does, also when the server ends, refuses a
// client, or waits for a stalled client.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import WebSocket from 'ws';
import { freePort, openBrowser, openPage, Pipeline, sleep, until } from './support.mjs';

const SENSOR = 'lidartestsrc is-live=true model=os0-32 mode=512x10 speed=5';
const limits = { timeout: 240_000 };
let browser;

before(async () => (browser = await openBrowser()), limits);
after(async () => {
  await browser?.close();
  await Pipeline.stopAll();
});

const address = (port, rest = '') => `http://127.0.0.1:${port}/${rest}`;
const state = (page) => page.evaluate(() => document.body.dataset.state);
const isLive = (page) => until('the page is live', async () => (await state(page)) === 'live');

/** Returns the share of the scene that is not background, and a checksum of it. */
function look(page) {
  return page.evaluate(async () => {
    const blob = await window.lidarPage.scene.picture();
    const image = await createImageBitmap(blob);
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let drawn = 0;
    let sum = 0;
    for (let i = 0; i < data.length; i += 4) {
      const off = Math.abs(data[i] - data[0]) + Math.abs(data[i + 1] - data[1]) + Math.abs(data[i + 2] - data[2]);
      if (off > 40) {
        ++drawn;
        sum = (sum * 31 + i) % 1_000_003;
      }
    }
    return { drawn, sum };
  });
}

// Draws with WebGL, which a computer with a graphics card uses, and with raster.js, which is used
// without one.
for (const by of ['webgl', 'raster'])
test(`points are drawn by ${by} and move, in every colour`, limits, async () => {
  const port = await freePort();
  const pipeline = await Pipeline.start(`${SENSOR} ! foxglovesink port=${port}`, port);
  const { page, context, complaints } = await openPage(browser, address(port, `?draw=${by}`));
  const hosts = new Set();
  page.on('request', (request) => hosts.add(new URL(request.url()).host));
  await page.reload();
  await isLive(page);
  const first = await until('points', async () => {
    const seen = await look(page);
    return seen.drawn > 1000 && seen;
  });
  await sleep(1000);
  assert.notEqual((await look(page)).sum, first.sum, 'the scene stands still');
  for (const mode of ['intensity', 'range', 'beam', 'age', 'height']) {
    await page.click(`[data-mode=${mode}]`);
    assert.equal(await page.getAttribute(`[data-mode=${mode}]`, 'aria-checked'), 'true');
    assert.ok((await look(page)).drawn > 1000, mode);
  }
  await page.focus('#scene');
  assert.deepEqual([...hosts], [`127.0.0.1:${port}`], 'the page asks elsewhere');
  assert.deepEqual(complaints, []);
  await context.close();
  await pipeline.stop();
});

test('mouse and keys orbit, pause holds, a snapshot is saved', limits, async () => {
  const port = await freePort();
  const pipeline = await Pipeline.start(`${SENSOR} ! foxglovesink port=${port}`, port);
  const { page, context, complaints } = await openPage(browser, address(port));
  await isLive(page);
  const camera = () => page.evaluate(() => window.lidarPage.scene.camera.position.toArray());
  const start = await camera();
  await page.mouse.move(400, 300);
  await page.mouse.down();
  await page.mouse.move(560, 340, { steps: 4 });
  await page.mouse.up();
  await until('the camera turns', async () => `${await camera()}` !== `${start}`);
  await page.focus('#scene');
  const turned = await camera();
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('+');
  await until('keys turn it', async () => `${await camera()}` !== `${turned}`);
  await page.keyboard.press(' ');
  assert.equal(await page.getAttribute('#pause', 'aria-pressed'), 'true');
  await until('the picture holds', async () => {
    const held = await look(page);
    await sleep(700);
    return (await look(page)).sum === held.sum;
  });
  const [download] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('s')]);
  assert.match(download.suggestedFilename(), /^gst-lidar-.*\.png$/);
  assert.deepEqual(complaints, []);
  await context.close();
  await pipeline.stop();
});

test('charts advance with the statistics of the pipeline', limits, async () => {
  const ALL = [
    'Age of the cloud', 'Bitrate', 'Delay', 'Window', 'Precision', 'Losses', 'Deviation of the pose', 'Poses', 'To this page',
  ];
  const [port, rtp] = [await freePort(), await freePort()];
  const way =
    `${SENSOR} ! queue ! lidarenc ! rtplidarpay ! screamsink host=127.0.0.1 port=${rtp} ` +
    `screamsrc port=${rtp} ! rtplidardepay ! lidardec ! lidarodometry ! foxglovesink port=${port}`;
  const pipeline = await Pipeline.start(way, port);
  const { page, context, complaints } = await openPage(browser, address(port));
  await isLive(page);
  const titles = await until('all charts', async () => {
    const shown = await page.$$eval('.chart:not([hidden]) h2', (all) =>
      all.map((h) => h.firstChild.textContent),
    );
    return shown.length === ALL.length && shown;
  });
  assert.deepEqual(titles, ALL);
  const samples = () => page.evaluate(() => window.lidarPage.charts.samples);
  const before = await samples();
  await until('more samples', async () => (await samples()) >= before + 8);
  assert.ok((await page.$$('.chart:not([hidden]) canvas')).length === ALL.length);
  await until('a map', () => page.evaluate(() => window.lidarPage.scene.map.count > 1000));
  await until('an ellipse', () => page.evaluate(() => window.lidarPage.scene.ellipse.object.visible));
  assert.equal(await page.isDisabled('#follow'), false);
  assert.deepEqual(complaints, []);
  await context.close();
  await pipeline.stop();
});

test('two links are shown by both ends', limits, async () => {
  const [port, also, rtp] = [await freePort(), await freePort(), await freePort()];
  const links = [1, 2].map((i) => `127.0.0.1:${rtp}@127.0.0.${i}`).join();
  const edge = await Pipeline.start(`screamsrc port=${rtp} ! rtplidardepay ! foxglovesink port=${port}`, port);
  const robot = await Pipeline.start(
    `${SENSOR} ! queue ! lidarenc ! rtplidarpay ! screamsink bonding-addresses=${links} foxglovesink port=${also}`, also);
  const named = (page, name) => until(name, () =>
    page.$$eval('.chart:not([hidden])', (all, what) => all.filter((c) => c.innerText.includes(what)).length, name));
  for (const [rest, name, charts] of [['', '127.0.0.2:', 1], [`?also=127.0.0.1:${also}`, '127.0.0.2', 3]]) {
    const { page, context, complaints } = await openPage(browser, address(port, rest));
    await until(`${charts} charts`, async () => (await named(page, name)) === charts);
    assert.deepEqual(complaints, []);
    await context.close();
  }
  await robot.stop();
  await edge.stop();
});

test('Draco clouds are decoded in the page', limits, async () => {
  const port = await freePort();
  const way = `${SENSOR} ! dracoenc geometry=xyz max-error=0.02 ! foxglovesink port=${port}`;
  const pipeline = await Pipeline.start(way, port);
  const { page, context, complaints } = await openPage(browser, address(port));
  await until('points', async () => (await look(page)).drawn > 1000);
  assert.deepEqual(complaints, []);
  await context.close();
  await pipeline.stop();
});

test('slices go to the page as the robot coded them', limits, async () => {
  const port = await freePort();
  const pipeline = await Pipeline.start(`${SENSOR} ! lidarenc ! foxglovesink port=${port}`, port);
  const { page, context, complaints } = await openPage(browser, address(port));
  await isLive(page);
  await until('points', async () => (await look(page)).drawn > 1000);
  const read = () => page.evaluate(() => ({ ...window.lidarPage.received, age: window.lidarPage.age }));
  const before = (await read())['lidar.Slice'].messages;
  // The server sends these scans only if the page acknowledges the previous ones.
  await until('ten more scans', async () => (await read())['lidar.Slice'].messages > before + 80);
  const now = await read();
  assert.equal(now['foxglove.PointCloud'], undefined, 'decoded clouds come, too');
  assert.ok(now.age > 0 && now.age < 30, `${now.age} s old`);
  assert.equal(await page.evaluate(() => window.lidarPage.slices.damaged), 0);
  assert.deepEqual(complaints, []);
  await context.close();
  await pipeline.stop();
});

test('the page comes back when the server does', limits, async () => {
  const port = await freePort();
  const way = `${SENSOR} ! foxglovesink port=${port}`;
  let pipeline = await Pipeline.start(way, port);
  const { page, context } = await openPage(browser, address(port));
  await isLive(page);
  await pipeline.stop();
  await until('the loss shows', async () => (await state(page)) === 'lost');
  assert.match(await page.textContent('#notice'), /Trying again/);
  pipeline = await Pipeline.start(way, port);
  await isLive(page);
  await until('points', async () => (await look(page)).drawn > 1000);
  await context.close();
  await pipeline.stop();
});

test('a silent sensor shows as one', limits, async () => {
  const port = await freePort();
  const pipeline = await Pipeline.start(`${SENSOR} num-buffers=60 ! foxglovesink port=${port} ` +
    `lidartestsrc is-live=true ! fakesink`, port);
  const { page, context } = await openPage(browser, address(port));
  await until('no clouds', async () => (await state(page)) === 'stalled');
  await context.close();
  await pipeline.stop();
});

test('a wrong token is refused, the right one lets in', limits, async () => {
  const port = await freePort();
  const pipeline = await Pipeline.start(`${SENSOR} ! foxglovesink port=${port} token=right`, port);
  const { page, context } = await openPage(browser, address(port, '?token=wrong'));
  await until('a refusal', async () => (await state(page)) === 'refused');
  assert.ok(!page.url().includes('token'), 'the token stays in the address');
  await page.fill('#token', 'right');
  await page.keyboard.press('Enter');
  await isLive(page);
  await context.close();
  await pipeline.stop();
});

test('two viewers see it; a stalled one holds up neither them nor the pipeline', limits, async () => {
  const port = await freePort();
  const way = `lidartestsrc is-live=true model=os1-64 ! foxglovesink name=web port=${port}`;
  const pipeline = await Pipeline.start(way, port);
  const first = await openPage(browser, address(port));
  const second = await openPage(browser, address(port));
  await Promise.all([first, second].map(({ page }) => isLive(page)));
  const watcher = new WebSocket(`ws://127.0.0.1:${port}`, ['foxglove.sdk.v1']);
  let sink = {};
  watcher.on('message', (data, isBinary) => {
    if (isBinary) {
      const { elements } = JSON.parse(data.subarray(13).toString());
      sink = Object.values(elements).find((e) => e.factory === 'foxglovesink');
    } else if (JSON.parse(data).op === 'advertise') {
      watcher.send('{"op":"subscribe","subscriptions":[{"id":0,"channelId":0}]}');
    }
  });
  await until('statistics', () => sink.clouds > 0);
  const stalled = new WebSocket(`ws://127.0.0.1:${port}`, ['foxglove.sdk.v1']);
  await new Promise((done) => stalled.on('open', done));
  const got = new Promise((done) => stalled.on('message', (_, isBinary) => isBinary && done()));
  stalled.send(
    JSON.stringify({ op: 'subscribe', subscriptions: [1, 2, 3].map((id) => ({ id, channelId: id })) }),
  );
  await got;
  stalled._socket.pause();
  const { clouds, messages_dropped: dropped } = sink;
  // 400 clouds of 40 kB do not fit into the kernel's buffers for the stalled client.
  await until('its socket is full', () => sink.clouds > clouds + 400);
  assert.ok(sink.messages_dropped > dropped, 'nothing was dropped for it');
  // Waits for a number of clouds instead of checking a rate, because the rate depends on the load
  // of the machine.
  const counts = async () => {
    const pages = [first, second].map(({ page }) =>
      page.evaluate(() => window.lidarPage.received['foxglove.PointCloud'].messages));
    return [sink.clouds, ...(await Promise.all(pages))];
  };
  const before = await counts();
  await until('more clouds for all others', async () => (await counts()).every((n, i) => n > before[i] + 80));
  for (const { page, context, complaints } of [first, second]) {
    assert.equal(await state(page), 'live');
    assert.deepEqual(complaints, []);
    await context.close();
  }
  stalled.terminate();
  watcher.terminate();
  await pipeline.stop();
});

test('it goes back to before it came, in what an mcapsink writes', limits, async () => {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'lidar-recording-'));
  const files = path.join(folder, 'r-%05d.mcap');
  const port = await freePort();
  const pipeline = await Pipeline.start(
    `${SENSOR} ! lidarenc ! tee name=t t. ! queue ! mcapsink location=${files} max-file-duration=3000000000 ` +
      `t. ! queue ! foxglovesink port=${port} sink_0::recording=${files}`,
    port,
  );
  await sleep(5000);
  const { page, context, complaints } = await openPage(browser, address(port));
  await until('a recording', () => page.evaluate(() => window.lidarPage.replay.span !== null));
  const came = Date.now() / 1000;
  const [from] = await page.evaluate(() => window.lidarPage.timeline.span);
  assert.ok(from < came - 4, `it begins ${came - from} s ago`);
  const at = () => page.evaluate(() => window.lidarPage.scene.fresh.time);
  await page.evaluate(() => window.lidarPage.timeline.seek(0));
  await until('its begin', async () => Math.abs((await at()) - from) < 0.5);
  await until('the next file', async () => (await at()) > from + 3.5);
  assert.ok((await look(page)).drawn > 1000);
  assert.equal(await page.textContent('#state span'), 'Recorded');
  await page.click('#live');
  await until('what is new', async () => (await at()) > came);
  assert.equal(await page.evaluate(() => window.lidarPage.slices.damaged), 0);
  assert.deepEqual(complaints, []);
  await context.close();
  await pipeline.stop();
  rmSync(folder, { recursive: true });
});

test('it fits a phone, follows the theme, and the keyboard reaches all of it', limits, async () => {
  const port = await freePort();
  const pipeline = await Pipeline.start(`${SENSOR} ! lidarenc ! foxglovesink port=${port}`, port);
  const phone = { viewport: { width: 390, height: 780 }, colorScheme: 'light' };
  const { page, context, complaints } = await openPage(browser, address(port), phone);
  await isLive(page);
  await until('a timeline', () => page.evaluate(() => !document.getElementById('timeline').hidden));
  assert.equal(await page.getAttribute('html', 'data-theme'), 'light');
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  const covered = () =>
    page.evaluate(() => {
      const area = ({ width, height }) => width * height;
      const over = [...document.querySelectorAll('nav > div, #legend')].map((e) => area(e.getBoundingClientRect()));
      return over.reduce((a, b) => a + b) / area(document.getElementById('scene').getBoundingClientRect());
    });
  await page.click('#panel');
  assert.ok((await covered()) < 0.2, `${await covered()} of the scene is covered`);
  await page.click('#panel');
  await page.click('#pause'); // this shows the timeline
  assert.ok((await covered()) < 0.25, `${await covered()} of the scene is covered`);
  const heights = await page.$$eval('.always button, #timeline button', (all) => all.map((b) => b.getBoundingClientRect().height));
  await page.click('#pause');
  assert.ok(heights.every((height) => height >= 48));
  await page.click('#more');
  const reached = new Set();
  for (let i = 0; i < 20; ++i) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.dataset.mode));
  }
  for (const id of ['scene', 'height', 'trail', 'pause', 'snapshot', 'panel', 'theme'])
    assert.ok(reached.has(id), `${id} is out of reach: ${[...reached]}`);
  await page.click('#theme');
  assert.equal(await page.getAttribute('html', 'data-theme'), 'dark');
  await page.click('#panel');
  assert.ok(await page.isVisible('#charts'));
  assert.deepEqual(complaints, []);
  await context.close();
  await pipeline.stop();
});
