// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests how the page decodes slices, and how it acknowledges them to the server.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { audit } from './axe.mjs';
import { FakeServer, jsonChannel, recordSlices, sliceChannel } from './fake_server.mjs';
import { freePort, openBrowser, openPage, sleep, until } from './support.mjs';

const limits = { timeout: 240_000 };
let browser;
let recorded;

before(async () => {
  recorded = recordSlices();
  browser = await openBrowser();
}, limits);
// Functions that close the servers of tests that failed. An open server would keep Node.js running.
const closings = new Set();
after(async () => {
  await browser?.close();
  for (const stop of closings) await stop();
});

const points = (page) => page.evaluate(() => window.lidarPage.scene.fresh.count);

async function open(channels, { rest = '', options = {}, server: how = {} } = {}) {
  const port = await freePort();
  const server = await FakeServer.start(port, channels, how);
  const { page, context, complaints } = await openPage(browser, `http://127.0.0.1:${port}/${rest}`, options);
  const stop = () => server.stop();
  closings.add(stop);
  const close = async () => {
    closings.delete(stop);
    await context.close();
    await stop();
  };
  return { server, page, complaints, close };
}

const acknowledged = (server) => server.told.filter((m) => m.op === 'drawn').at(-1);

test('slices are decoded and drawn, and the page says which', limits, async () => {
  const clouds = { ...jsonChannel(1, '/points', 'foxglove.PointCloud'), encoding: 'protobuf' };
  const { server, page, complaints, close } = await open([clouds, sliceChannel(2, '/points', recorded)]);
  await until('a subscription', () => server.subscribed.has(2));
  assert.ok(!server.subscribed.has(1), 'clouds come, too');
  for (let i = 0; i < 16; ++i) server.sendSlice(2, recorded, i, 70);
  await until('acknowledgements', () => acknowledged(server)?.scan === 1 && acknowledged(server)?.slice === 7);
  assert.ok((await points(page)) > 1000);
  const age = await page.evaluate(() => window.lidarPage.age);
  assert.ok(age > 0.07 && age < 30, `${age} s old`);
  assert.deepEqual(complaints, []);
  await close();
});

test('a whole scan stays, however few come', limits, async () => {
  const { server, page, close } = await open([sliceChannel(2, '/points', recorded)]);
  await until('a subscription', () => server.subscribed.has(2));
  for (let i = 0; i < 8; ++i) server.sendSlice(2, recorded, i);
  await until('a scan', () => acknowledged(server)?.slice === 7);
  const whole = await points(page);
  // The next scan that arrives is four scans later. Its first half replaces the first half of the
  // old scan.
  for (let i = 32; i < 36; ++i) server.sendSlice(2, recorded, i);
  await until('half a scan', () => acknowledged(server)?.scan === 4 && acknowledged(server)?.slice === 3);
  const mixed = await points(page);
  assert.ok(Math.abs(mixed - whole) < 0.2 * whole, `${whole} points, then ${mixed}`);
  await close();
});

test('damage costs slices, and what lacks a reference is asked for once a second', limits, async () => {
  const cut = { ...recorded, coded: recorded.coded.map((slice) => slice.subarray(0, slice.length / 2)) };
  const { server, page, complaints, close } = await open([sliceChannel(2, '/points', recorded)]);
  await until('a subscription', () => server.subscribed.has(2));
  for (let i = 0; i < 8; ++i) server.sendSlice(2, cut, i);
  await until('acknowledgements', () => acknowledged(server)?.slice === 7);
  assert.equal(await page.evaluate(() => window.lidarPage.slices.damaged), 8);
  for (let i = 8; i < 16; ++i) server.sendSlice(2, recorded, i);
  await until('points', async () => (await points(page)) > 1000);
  assert.deepEqual(complaints, []);
  await close();
});

test('a sensor model that is damaged leaves the page alive', limits, async () => {
  const broken = { ...recorded, about: { ...recorded.about, sensorModel: 'AAAA' } };
  const { server, complaints, close } = await open([sliceChannel(2, '/points', broken)]);
  await until('a subscription', () => server.subscribed.has(2));
  server.sendSlice(2, recorded, 0);
  await until('an acknowledgement', () => acknowledged(server));
  assert.deepEqual(complaints, []);
  await close();
});

test('one robot of a fleet is shown, and the address keeps which', limits, async () => {
  const channels = [sliceChannel(1, '/r7/points', recorded), sliceChannel(2, '/r8/points', recorded)];
  channels.push(jsonChannel(3, '/r7/camera', 'foxglove.CompressedVideo'));
  const { server, page, complaints, close } = await open(channels, { rest: '#robot=r8&color=range' });
  await until('a subscription', () => server.subscribed.has(2));
  assert.ok(!server.subscribed.has(1) && !server.subscribed.has(3));
  assert.equal(await page.getAttribute('[data-mode=range]', 'aria-checked'), 'true');
  await page.selectOption('#robot', 'r7');
  await until('the other', () => server.subscribed.has(1) && server.subscribed.has(3) && !server.subscribed.has(2));
  await until('the address', () => page.url().includes('robot=r7'));
  assert.deepEqual(complaints, []);
  await close();
});

test('a page that is paused takes no slices', limits, async () => {
  const { server, page, close } = await open([sliceChannel(2, '/points', recorded)]);
  await until('a subscription', () => server.subscribed.has(2));
  await page.click('#pause');
  await until('none', () => !server.subscribed.has(2));
  await page.click('#pause');
  await until('a subscription', () => server.subscribed.has(2));
  await close();
});

const shownAt = (page) => page.evaluate(() => window.lidarPage.scene.fresh.time);

test('the page goes back into what it got, and returns to live', limits, async () => {
  const { server, page, complaints, close } = await open([sliceChannel(2, '/points', recorded)]);
  await until('a subscription', () => server.subscribed.has(2));
  assert.ok(!(await page.isVisible('#timeline')));
  const slices = 400; // 5 s of slices
  for (let i = 0; i < slices; ++i) server.sendSlice(2, recorded, i, (slices - i) * 12.5);
  await until('a timeline', () => page.isVisible('#timeline'));
  await until('all', () => acknowledged(server)?.scan === 49 && acknowledged(server)?.slice === 7);
  const [end, whole] = [await shownAt(page), await points(page)];
  await page.click('#pause');
  await page.fill('#timeline input', '-3');
  await until('the picture', async () => Math.abs((await shownAt(page)) - end + 3) < 0.2);
  assert.ok(Math.abs((await points(page)) - whole) < 0.2 * whole, 'the scan is not whole');
  assert.equal(await page.textContent('#state span'), 'Recorded, paused');
  assert.match(await page.textContent('#timeline output'), /^3\.0 s ago/);
  await page.fill('#timeline input', '-4');
  await until('an earlier one', async () => Math.abs((await shownAt(page)) - end + 4) < 0.2);
  // The recording continues to play. Live slices that arrive meanwhile are acknowledged.
  await page.click('#pause');
  await until('a subscription', () => server.subscribed.has(2));
  for (let i = 400; i < 408; ++i) server.sendSlice(2, recorded, i);
  await until('acknowledgements', () => acknowledged(server)?.scan === 50);
  const before = await shownAt(page);
  await until('the next scans', async () => (await shownAt(page)) > before + 0.3);
  assert.equal(await page.textContent('#state span'), 'Recorded');
  await page.click('#live');
  assert.equal(await page.textContent('#state span'), 'Live');
  for (let i = 408; i < 416; ++i) server.sendSlice(2, recorded, i);
  await until('what is new', async () => (await shownAt(page)) > end + 0.01);
  assert.deepEqual(complaints, []);
  await close();
});

/** Opens a page on a stream with a recording of the last hour. */
async function openRecorded(options = {}) {
  const opened = await open([sliceChannel(2, '/points', { about: { ...recorded.about, recording: true } })], options);
  const { server, page } = opened;
  const to = Date.now() / 1000;
  const describe = (rest = {}) => server.describe(2, { from: to - 3600, to, ...rest });
  const replay = () => server.told.findLast(({ op }) => op === 'replay');
  /** Sends slices [first, end) of 12.5 ms of the replay that the page asked for; slice 0 is 0.2 s before its time. */
  const play = (first, end) => {
    const { number, time } = replay();
    for (let i = first; i < end; ++i) server.sendSlice(2, recorded, i, Date.now() - 1000 * time + 200 - 12.5 * i, number);
  };
  await until('a subscription', () => server.subscribed.has(2));
  describe();
  await until('a timeline', () => page.isVisible('#timeline'));
  return { ...opened, to, describe, replay, play };
}
const stateOf = (page) => page.textContent('#state span');
const says = (page, words) => until(words, async () => (await stateOf(page)) === words);
/** Waits for a picture of the 5 s after `time`, thus not for a live one. */
const shows = (page, time) =>
  until(`the picture at ${time}`, async () => {
    const shown = await shownAt(page);
    return shown !== null && shown > time && shown < time + 5;
  });

test('the page goes back into a recording of the server, and returns to live at its end', limits, async () => {
  const { server, page, complaints, close, to, describe, replay, play } = await openRecorded();
  for (let i = 0; i < 8; ++i) server.sendSlice(2, recorded, i);
  await until('a scan', () => acknowledged(server)?.slice === 7);
  const whole = await points(page);
  await page.fill('#timeline input', '-600');
  const { number, time } = await until('a request', replay);
  assert.ok(Math.abs(time - to + 600) < 0.1);
  await says(page, 'Loading the recording');
  assert.match(await page.textContent('#timeline output'), /^10:00 min ago/);
  play(0, 80);
  await shows(page, time - 0.02);
  assert.ok(Math.abs((await points(page)) - whole) < 0.2 * whole, 'the scan is not whole');
  // Live slices and slices of another replay are not shown.
  server.sendSlice(2, recorded, 9);
  server.sendSlice(2, recorded, 79, Date.now() - 1000 * time - 900, number + 1);
  await shows(page, time + 0.6);
  assert.ok((await shownAt(page)) < time + 0.81);
  await until('all of them', () => server.told.some(({ scan, slice }) => scan === 9 && slice === 7));
  await says(page, 'Loading the recording');
  describe({ number, end: time + 0.7 });
  await until('what is live', () => server.told.some(({ op }) => op === 'live'));
  await says(page, 'Live');
  server.sendSlice(2, recorded, 10);
  await until('what is new', async () => (await shownAt(page)) > time + 500);
  assert.deepEqual(complaints, []);
  await close();
});

test('a recording is held, stepped through by keys and buttons, and no more of it taken than is due', limits, async () => {
  const { server, page, complaints, close, replay, play } = await openRecorded();
  await page.click('#pause');
  await until('none', () => !server.subscribed.has(2));
  await page.focus('#timeline input');
  await page.keyboard.press('PageDown');
  const first = await until('a request', replay);
  assert.ok(server.subscribed.has(2), 'without a subscription');
  play(0, 240); // 3 s of slices
  await shows(page, first.time - 0.02);
  assert.ok((await shownAt(page)) <= first.time);
  await says(page, 'Recorded, paused');
  const { scan, slice } = await until('acknowledgements', () => acknowledged(server));
  const due = 16 + 80; // slices from 0.2 s before the requested time to 1 s after it
  assert.ok(scan * 8 + slice >= due - 2 && scan * 8 + slice <= due + 1, `slice ${scan * 8 + slice} is acknowledged`);
  const another = () => until('another request', () => replay().number !== first.number && replay());
  await page.keyboard.press('ArrowRight');
  assert.ok(Math.abs((await another()).time - first.time - 1) < 1e-3);
  await page.click('#back');
  const last = await until('a request', () => replay().number > first.number + 1 && replay());
  assert.ok(Math.abs(last.time - first.time + 9) < 1e-3);
  play(0, 40);
  await until('the picture', async () => Math.abs((await shownAt(page)) - last.time) < 0.02);
  await page.focus('#timeline input');
  await page.keyboard.press(' ');
  await shows(page, last.time + 0.2);
  await page.keyboard.press('l');
  await until('what is live', () => server.told.some(({ op }) => op === 'live'));
  await says(page, 'Live');
  assert.deepEqual(complaints, []);
  await close();
});

test('a connection that comes back replays on', limits, async () => {
  const { server, page, close, describe, replay, play } = await openRecorded();
  await page.fill('#timeline input', '-600');
  const first = await until('a request', replay);
  play(0, 40);
  await shows(page, first.time - 0.02);
  server.client.terminate();
  await until('the same from there on', () => replay().number > first.number && server.subscribed.has(2));
  assert.ok(replay().time > first.time && replay().time < first.time + 1);
  describe();
  play(16, 80);
  const { time } = replay();
  await shows(page, time + 0.3);
  await close();
});

test('a recording that cannot be read is told, and what the page has itself is there', limits, async () => {
  const { server, page, complaints, close, describe } = await openRecorded({ options: { locale: 'de-DE' } });
  describe({ from: 0, to: 0 });
  await until('words', async () => /nicht lesbar/.test(await page.textContent('#recording')));
  const slices = 160; // 2 s of slices
  for (let i = 0; i < slices; ++i) server.sendSlice(2, recorded, i, (slices - i) * 12.5);
  await until('all', () => acknowledged(server)?.scan === 19 && acknowledged(server)?.slice === 7);
  const end = await shownAt(page);
  await page.fill('#timeline input', '-1');
  await until('the picture', async () => (await shownAt(page)) < end - 0.5);
  assert.ok(!server.told.some(({ op }) => op === 'replay'));
  await page.click('#live');
  describe({ damaged: 3 });
  await until('other words', async () => /Beschädigte Teile/.test(await page.textContent('#recording')));
  assert.deepEqual(complaints, []);
  await close();
});

/** Frames of a moving picture, coded by `coder`. */
function recordVideo(coder) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'lidar-video-'));
  const line = `videotestsrc num-buffers=12 pattern=ball ! video/x-raw,width=160,height=120 ! ${coder} ! multifilesink location=${folder}/%05d.bin`;
  execFileSync('gst-launch-1.0', line.split(' '));
  const frames = readdirSync(folder).sort().map((file) => readFileSync(path.join(folder, file)));
  rmSync(folder, { recursive: true });
  return frames;
}

/** foxglove.CompressedVideo. */
function videoMessage(format, data, ms) {
  const varint = (v) => (v < 128 ? [v] : [(v & 127) | 128, ...varint(Math.floor(v / 128))]);
  const bytes = (field, content) => Buffer.concat([Buffer.from([(field << 3) | 2, ...varint(content.length)]), content]);
  const time = Buffer.from([8, ...varint(Math.floor(ms / 1000)), 16, ...varint(Math.floor((ms % 1000) * 1e6))]);
  return Buffer.concat([bytes(1, time), bytes(3, data), bytes(4, Buffer.from(format))]);
}

const CAMERAS = {
  vp8: 'vp8enc keyframe-max-dist=4 deadline=1',
  h264: 'openh264enc gop-size=4 ! video/x-h264,stream-format=byte-stream,alignment=au',
};
for (const [format, coder] of Object.entries(CAMERAS)) {
  test(`a camera is shown beside the cloud, in time with it: ${format}`, limits, async () => {
    const frames = recordVideo(coder);
    const camera = { ...jsonChannel(3, '/camera', 'foxglove.CompressedVideo'), encoding: 'protobuf' };
    const { server, page, complaints, close } = await open([sliceChannel(2, '/points', recorded), camera]);
    await until('subscriptions', () => server.subscribed.has(2) && server.subscribed.has(3));
    for (let i = 0; i < 8; ++i) server.sendSlice(2, recorded, i, 80);
    await until('a scan', () => acknowledged(server)?.slice === 7);
    const time = (await shownAt(page)) * 1000;
    frames.slice(0, 3).forEach((data, i) => server.send(3, videoMessage(format, data, time + 30 * (i - 1))));
    const shown = () => page.evaluate(() => window.lidarPage.video.shown);
    await until('the picture of that time', async () => Math.abs((await shown()) * 1000 - time) < 2);
    assert.equal(await page.evaluate(() => window.lidarPage.video.held.length), 1);
    assert.ok(await page.isVisible('#video'));
    server.sendSlice(2, recorded, 8);
    await until('the next', async () => (await shown()) * 1000 > time + 20);
    for (const data of frames.slice(3)) server.send(3, videoMessage(format, data, time + 900));
    await until('few are held', () => page.evaluate(() => window.lidarPage.video.held.length <= 4));
    assert.deepEqual(complaints, []);
    await close();
  });
}

test('a camera goes back with the cloud, and returns to live', limits, async () => {
  const frames = recordVideo(CAMERAS.vp8);
  const camera = { ...jsonChannel(3, '/camera', 'foxglove.CompressedVideo'), encoding: 'protobuf' };
  const { server, page, complaints, close } = await open([sliceChannel(2, '/points', recorded), camera]);
  await until('subscriptions', () => server.subscribed.has(2) && server.subscribed.has(3));
  const begun = Date.now() - 5000;
  for (let i = 0; i < 400; ++i) server.sendSlice(2, recorded, i, 5000 - 12.5 * i);
  frames.forEach((data, i) => server.send(3, videoMessage('vp8', data, begun + 400 * i)));
  await until('all', () => acknowledged(server)?.scan === 49 && acknowledged(server)?.slice === 7);
  await page.click('#pause');
  const shown = () => page.evaluate(() => window.lidarPage.video.shown);
  for (const ago of [2.5, 1, 4.9]) {
    const before = await shownAt(page);
    await page.fill('#timeline input', `-${ago}`);
    await until('another cloud', async () => (await shownAt(page)) !== before);
    const time = await shownAt(page);
    await until('the picture of that time', async () => time - (await shown()) >= 0 && time - (await shown()) < 0.4);
  }
  await page.click('#live');
  assert.ok(!(await page.isVisible('#video')));
  server.send(3, videoMessage('vp8', frames[0], Date.now()));
  await until('what is new', async () => (await shown()) * 1000 > begun + 4500);
  assert.deepEqual(complaints, []);
  await close();
});

test('a replay has the poses that the recording has', limits, async () => {
  const { server, page, complaints, close, replay, play } = await openRecorded();
  await page.fill('#timeline input', '-600');
  const { number, time } = await until('a request', replay);
  server.sendPose(2, [7, 0, 0], 1000 * time - 200, number);
  server.sendPose(2, [9, 0, 0], 1000 * time - 200, number + 1); // a pose of another replay
  play(0, 80);
  await shows(page, time - 0.02);
  await until('the place', async () => (await page.evaluate(() => window.lidarPage.scene.sensor.x)) === 7);
  assert.deepEqual(complaints, []);
  await close();
});

test('statistics of two links are two lines, and a fast link flattens nothing', limits, async () => {
  const { server, page, complaints, close } = await open([jsonChannel(1, '/statistics', 'lidar.Statistics')]);
  await until('a subscription', () => server.subscribed.has(1));
  const link = (name, sent, rtt, rest) =>
    ({ link: `edge:5004@${name}`, sent_bitrate: sent, rtt, queue_delay: rtt / 10, usable: true, in_gap: false, ...rest });
  const message = {
    estimated_capacity: 118e6, target_bitrate: 4.2e6, sent_bitrate: 4.1e6,
    elements: { tx: { links: [link('wwan0', 3e6, 40e6), link('wwan1', 1e6, 60e6, { in_gap: true })] } },
  };
  server.send(1, Buffer.from(JSON.stringify(message)));
  const shown = await until('links', () =>
    page.$$eval('.chart:not([hidden])', (all) => all.map((c) => c.innerText).filter((s) => s.includes('wwan1'))),
  );
  assert.equal(shown.length, 3);
  assert.match(shown[0], /wwan0\s+3\.00\s+wwan1 \(in a gap\)\s+1\.00/);
  assert.match(shown[1], /wwan0\s+40\.0\s+wwan1 \(in a gap\)\s+60\.0/);
  assert.match(shown[2], /wwan0\s+4\.00\s+wwan1 \(in a gap\)\s+6\.00/);
  const top = await page.evaluate(() => {
    const chart = window.lidarPage.charts.charts.find((c) => c.config.title === 'Bitrate');
    return chart.top();
  });
  assert.ok(top < 13, `${top} Mbit/s high`);
  assert.deepEqual(complaints, []);
  await close();
});

test('a wrong token is said to be wrong', limits, async () => {
  const { page, close } = await open([], { server: { token: 'right' } });
  await until('the dialog', () => page.isVisible('#entry'));
  assert.ok(!(await page.isVisible('#wrong')));
  await page.fill('#token', 'other');
  await page.keyboard.press('Enter');
  await until('the refusal', () => page.isVisible('#wrong'));
  assert.match(await page.textContent('#wrong'), /wrong/);
  await close();
});

test('a token that expires is asked for anew', limits, async () => {
  const { server, page, close } = await open([], { rest: '?token=short', server: { token: 'short' } });
  await until('the page is live', async () => (await page.textContent('#state span')) === 'Live');
  server.token = 'long';
  server.client.close(4401);
  await until('the dialog', () => page.isVisible('#wrong'));
  assert.match(await page.textContent('#wrong'), /expired/);
  assert.equal(await page.textContent('#state span'), 'Token expired');
  await page.fill('#token', 'long');
  await page.keyboard.press('Enter');
  await until('the page is live', async () => (await page.textContent('#state span')) === 'Live');
  await close();
});

test('a hidden page takes nothing', limits, async () => {
  const channels = [sliceChannel(2, '/points', recorded), jsonChannel(3, '/statistics', 'lidar.Statistics')];
  const { server, page, close } = await open(channels);
  await until('subscriptions', () => server.subscribed.size === 2);
  const hide = (hidden) =>
    page.evaluate((value) => {
      Object.defineProperty(document, 'hidden', { value, configurable: true });
      document.dispatchEvent(new Event('visibilitychange'));
    }, hidden);
  await hide(true);
  await until('none', () => server.subscribed.size === 0);
  await hide(false);
  await until('subscriptions', () => server.subscribed.size === 2);
  await close();
});

test('the header says how old the cloud is, and which rate it shows', limits, async () => {
  const { server, page, close } = await open([sliceChannel(2, '/points', recorded)]);
  await until('a subscription', () => server.subscribed.has(2));
  let i = 0;
  await until('facts', async () => {
    server.sendSlice(2, recorded, i++, 90);
    return /^\d+ ms old · \d+\.\d Mbit\/s to this page · [\d,]+ pt\/s$/.test(await page.textContent('#facts'));
  });
  await close();
});

test('the page speaks German', limits, async () => {
  const { page, complaints, close } = await open([], { options: { locale: 'de-DE' } });
  assert.equal(await page.getAttribute('html', 'lang'), 'de');
  assert.equal(await page.textContent('[data-mode=height]'), 'Höhe');
  assert.deepEqual(complaints, []);
  await close();
});

test('the distance between two points is measured, and heights are clipped', limits, async () => {
  const { server, page, complaints, close } = await open([sliceChannel(2, '/points', recorded)]);
  await until('a subscription', () => server.subscribed.has(2));
  for (let i = 0; i < 8; ++i) server.sendSlice(2, recorded, i);
  await until('a scan', () => acknowledged(server)?.slice === 7);
  await page.click('#more');
  await page.click('#measure');
  const places = await page.evaluate(() => {
    const { fresh, camera, canvas, sensor } = window.lidarPage.scene;
    const { width, height } = canvas.getBoundingClientRect();
    const seen = [];
    fresh.each((at) => {
      const p = sensor.clone().fromArray(fresh.data, at).project(camera);
      if (Math.abs(p.x) < 0.5 && Math.abs(p.y) < 0.4) seen.push([((p.x + 1) / 2) * width, ((1 - p.y) / 2) * height]);
    });
    return [seen[0], seen.at(-1)];
  });
  for (const [x, y] of places) await page.mouse.click(x, y);
  await until('a distance', async () => /\d m/.test(await page.textContent('#distance')));
  await page.fill('#clip_high', '-1');
  await sleep(600);
  assert.match(page.url(), /to=-1/);
  assert.match(await page.textContent('.clip'), /-1\.0|−1\.0/);
  assert.deepEqual(complaints, []);
  await close();
});

/** The rules of axe that the page breaks. */
const violations = async (page) => (await audit(page)).violations;

const VIEWS = {
  'a desk, dark': { viewport: { width: 1280, height: 800 }, colorScheme: 'dark' },
  'a phone, light': { viewport: { width: 390, height: 780 }, colorScheme: 'light' },
};
for (const [name, options] of Object.entries(VIEWS)) {
  test(`axe finds nothing: ${name}`, limits, async () => {
    const about = { ...recorded.about, recording: true };
    const channels = [sliceChannel(1, '/r7/points', { about }), sliceChannel(2, '/r8/points', recorded)];
    channels.push(jsonChannel(3, '/statistics', 'lidar.Statistics'));
    const { server, page, close } = await open(channels, { options });
    await until('a subscription', () => server.subscribed.has(1));
    for (let i = 0; i < 160; ++i) server.sendSlice(1, recorded, i, 2000 - 12.5 * i);
    server.send(3, Buffer.from(JSON.stringify({ target_bitrate: 4e6, sent_bitrate: 3e6, elements: {} })));
    await page.click('#more');
    if (await page.evaluate(() => document.body.dataset.panel === 'closed')) await page.click('#panel');
    await until('a chart', () => page.isVisible('.chart:not([hidden])'));
    server.describe(1, { from: 0, to: 0 });
    await until('words', () => page.isVisible('#recording'));
    assert.ok(await page.isVisible('#timeline'));
    assert.deepEqual(await violations(page), []);
    await close();
  });
}

test('axe finds nothing: the question for a token', limits, async () => {
  const { page, close } = await open([], { server: { token: 'right' } });
  await until('the dialog', () => page.isVisible('#entry'));
  assert.deepEqual(await violations(page), []);
  await close();
});
