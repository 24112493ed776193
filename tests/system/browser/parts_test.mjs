// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the parts of the page that need no browser.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { chooseChannels } from '../../../ext/web/page/src/channels.js';
import { Clock, nowSeconds } from '../../../ext/web/page/src/clock.js';
import { ellipseOf } from '../../../ext/web/page/src/ellipse.js';
import { History, Player } from '../../../ext/web/page/src/history.js';
import { Links } from '../../../ext/web/page/src/links.js';
import { Poses } from '../../../ext/web/page/src/poses.js';
import { readHeader } from '../../../ext/web/page/src/slices.js';
import { Replay } from '../../../ext/web/page/src/replay.js';
import { duration } from '../../../ext/web/page/src/timeline.js';

const pose = (time, x, yaw) => ({
  time, child: 'lidar', position: [x, 0, 0], rotation: [0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2)],
});

test('a frame is where steady motion takes it', () => {
  const poses = new Poses();
  assert.equal(poses.at('lidar', 1), null);
  for (const i of [0, 1, 2]) poses.add(pose(10 + 0.1 * i, i, 0.1 * i));
  const at = (time) => poses.at('lidar', time).elements;
  assert.ok(Math.abs(at(10.05)[12] - 0.5) < 1e-6);
  assert.ok(Math.abs(at(10.3)[12] - 3) < 1e-6);
  assert.ok(Math.abs(at(10.3)[1] - Math.sin(0.3)) < 1e-6);
  assert.ok(at(99)[12] < 8, 'it leaves for ever where poses end');
});

test('a server that comes back brings poses of its own', () => {
  const poses = new Poses();
  poses.add(pose(10, 5, 0));
  poses.end();
  assert.equal(poses.at('lidar', 10.1), null);
  poses.add(pose(11, 0, 0));
  const x = (time) => poses.at('lidar', time).elements[12];
  assert.deepEqual([x(10), x(10.9), x(11.2)], [5, 0, 0]);
  poses.end();
  poses.add(pose(3, 7, 0)); // an earlier time, as in a recording
  assert.equal(x(3), 7);
});

test('the ellipse of a position has three standard deviations along each of its axes', () => {
  const corners = (xx, xy, yy) => {
    const covariance = Array(36).fill(0);
    Object.assign(covariance, { 0: xx, 1: xy, 6: xy, 7: yy });
    const numbers = ellipseOf(covariance);
    return Array.from({ length: numbers.length / 3 }, (_, i) => numbers.slice(3 * i, 3 * i + 2));
  };
  const most = (points, [x, y]) => Math.max(...points.map((p) => Math.abs(p[0] * x + p[1] * y)));
  const slope = Math.SQRT1_2;
  // The rectangle that is expected has 4 m along the diagonal and 1 m across it.
  const tilted = corners(8.5, 7.5, 8.5);
  assert.ok(Math.abs(most(tilted, [slope, slope]) - 12) < 0.05);
  assert.ok(Math.abs(most(tilted, [slope, -slope]) - 3) < 0.05);
  assert.deepEqual(tilted[0].map((v) => v.toFixed(6)), tilted.at(-1).map((v) => v.toFixed(6)));
  assert.ok(Math.abs(most(corners(0, 0, 4), [0, 1]) - 6) < 1e-9);
  assert.equal(most(corners(0, 0, 4), [1, 0]), 0);
  assert.equal(most(corners(0, 0, 0), [1, 1]), 0);
  assert.ok(corners(1, 1 + 1e-12, 1).flat().every(Number.isFinite));
});

test('of several cameras the page takes the first one of its robot', () => {
  const video = (topic) => ({ topic, schemaName: 'foxglove.CompressedVideo', schema: '' });
  const clouds = (topic) => ({ topic, schemaName: 'foxglove.PointCloud', schema: '' });
  const known = { 'foxglove.CompressedVideo': 1, 'foxglove.PointCloud': 1 };
  const chosen = (list, robot = '') =>
    chooseChannels(list, { known, robot, idle: false, paused: false }).map(({ topic }) => topic);
  assert.deepEqual(chosen([video('/camera_1'), clouds('/points'), video('/camera')]), ['/points', '/camera']);
  assert.deepEqual(
    chosen([video('/r1/camera'), video('/r2/left'), video('/r2/right'), clouds('/r1/points'), clouds('/r2/points')], 'r2'),
    ['/r2/left', '/r2/points'],
  );
});

/** Slice `i` of scans of two slices at 10 Hz; it refers to slice `i` - 2, except in every `period`th scan. */
function coded(i, { period = 5, size = 100, source = 'a' } = {}) {
  const scan = i >> 1;
  const link = { name: i, needs: scan % period === 0 ? null : i - 2 };
  return { captured: 100 + 0.05 * i, header: { scan, slice: i & 1 }, bytes: { length: size, i }, links: [link], source };
}

/** A decoder that keeps the names of its slices; a slice that lacks its reference gives no points. */
class Decoder {
  constructor(slices) {
    Object.assign(this, { slices, known: new Set(), decoded: 0 });
  }
  decode({ i }) {
    ++this.decoded;
    const [{ name, needs }] = this.slices[i].links;
    if (needs !== null && !this.known.has(needs)) return { points: null };
    this.known.add(name);
    return { points: [i] };
  }
}

const filled = (slices, mostBytes = 1e9) => {
  const history = new History(mostBytes);
  for (const slice of slices) history.add(slice);
  return history;
};
const shown = ({ slices }) => slices.map(({ decoded }) => decoded.points[0]);

test('a history is bounded, and begins with what can be shown', () => {
  const history = filled(Array.from({ length: 40 }, (_, i) => coded(i)), 2450);
  assert.ok(history.bytes <= 2450);
  assert.deepEqual(history.slices.map(({ bytes }) => bytes.i), Array.from({ length: 20 }, (_, i) => 20 + i));
  assert.deepEqual(history.span, [101, 100 + 39 * 0.05]);
});

test('any time of a history is shown, by what it needs', async () => {
  const slices = Array.from({ length: 40 }, (_, i) => coded(i));
  const history = filled(slices);
  const decoders = [];
  const player = new Player(history, () => decoders[decoders.push(new Decoder(slices)) - 1], () => {});
  const first = await player.show(slices[17].captured + 0.01);
  assert.deepEqual([first.jumped, shown(first), first.next], [true, [14, 15, 16, 17], slices[18].captured]);
  assert.equal(decoders[0].decoded, 8); // slices 10 to 17
  const on = await player.show(slices[19].captured);
  assert.deepEqual([on.jumped, shown(on)], [false, [18, 19]]);
  const back = await player.show(slices[3].captured);
  assert.deepEqual([back.jumped, shown(back)], [true, [0, 1, 2, 3]]);
  assert.equal((await player.show(999)).next, null);
});

test('who asks for another time waits for no older one', async () => {
  const slices = Array.from({ length: 400 }, (_, i) => coded(i, { period: 1000 }));
  const history = filled(slices);
  const slow = new Decoder(slices);
  const decode = slow.decode.bind(slow);
  slow.decode = (bytes) => {
    for (const end = performance.now() + 5; performance.now() < end; ) continue;
    return decode(bytes);
  };
  let asked = 0;
  const player = new Player(history, () => slow, () => ++asked);
  assert.equal(await player.show(120, () => asked < 2), null);
  assert.ok(slow.decoded < 100);
});

test('the decoder of a closed stream ends with the last of its slices', async () => {
  const sources = [{}, {}];
  const slices = Array.from({ length: 40 }, (_, i) => coded(i, { source: sources[i < 20 ? 0 : 1] }));
  const history = filled(slices);
  const player = new Player(history, () => new Decoder(slices), () => {});
  for (const i of [10, 30]) await player.show(slices[i].captured);
  sources[0].isClosed = true;
  player.stop();
  assert.equal(player.decoders.size, 2);
  history.clear();
  player.stop();
  assert.deepEqual([...player.decoders.keys()], [sources[1]]);
});

test('a receiver tells of links, too, as long as no sender does', () => {
  const links = new Links();
  const got = (...bytes) => ({ elements: { rx: { links: bytes.map((b, i) => ({ address: `10.0.0.${i}:9`, bytes_received: b })) } } });
  assert.equal(links.of(got(0, 0), 10).link_0_bitrate, undefined);
  const now = links.of(got(125_000, 25_000), 10.5);
  assert.deepEqual([now.link_0.name, now.link_0_bitrate, now.link_1_bitrate], ['10.0.0.0:9', 2e6, 4e5]);
  const sender = { elements: { tx: { links: [1e6, 2e6].map((sent_bitrate) => ({ sent_bitrate, usable: false })) } } };
  assert.deepEqual(links.of(sender, 11).link_1, { name: '2', state: 'unusable' });
  assert.deepEqual(links.of(got(130_000, 25_000), 11.1), {});
  assert.deepEqual(links.of({}, 12), {});
});

test('ages leave out how far apart the clocks are', () => {
  const clock = new Clock();
  const server = nowSeconds() - 3600;
  clock.arrived(server);
  assert.ok(Math.abs(clock.ageOf(server - 0.2) - 0.2) < 0.1);
});

test('headers of another version, and what is too short, are passed over', () => {
  assert.equal(readHeader(new Uint8Array(23)), null);
  assert.equal(readHeader(new Uint8Array(24)), null);
  const bytes = new Uint8Array(30);
  bytes.set([1, 1, 3, 0, 8, 0, 0, 0, 7]);
  const { recoded, slice, slices, scan } = readHeader(bytes);
  assert.deepEqual([recoded, slice, slices, scan], [true, 3, 8, 7]);
});

test('recordings of two sensors are one, and wait for each other', () => {
  const schema = JSON.stringify({ recording: true });
  const [left, right] = [1, 2].map((id) => ({ id, schemaName: 'lidar.Slice', schema }));
  const other = { id: 3, schemaName: 'lidar.Slice', schema: '{}' };
  const channels = new Map([left, right, other].map((channel) => [channel.id, channel]));
  const [told, shown] = [[], []];
  const connection = { subscriptions: channels, offered: channels, tell: (op, { id }, rest) => told.push({ op, id, ...rest }) };
  const on = { begin() {}, end() {}, known() {}, show: (time) => shown.push(time) };
  const replay = new Replay(on, () => connection);
  replay.status(left, { number: 0, from: 100, to: 200, damaged: 0, end: null });
  replay.status(right, { number: 0, from: 0, to: 0, damaged: 0, end: null });
  assert.deepEqual([replay.span, replay.isBroken], [[100, 200], false]);
  replay.begin(150);
  assert.deepEqual(told.splice(0), [1, 2].map((id) => ({ op: 'replay', id, number: 1, time: 150 })));
  const slice = (captured, scan) => ({ replay: 1, captured, scan, slice: 0 });
  for (const [i, time] of [149, 150, 150.9, 152].entries()) replay.arrived(left, slice(time, i));
  assert.deepEqual([replay.reach, shown], [-Infinity, []]);
  replay.acknowledge();
  assert.deepEqual(told.splice(0), [{ op: 'drawn', id: 1, scan: 2, slice: 0 }]);
  replay.status(right, { number: 9, from: 0, to: 0, damaged: 0, end: 0 }); // of another replay
  assert.deepEqual(shown, []);
  replay.status(right, { number: 1, from: 0, to: 0, damaged: 0, end: 0 });
  assert.deepEqual([replay.reach, shown, replay.last], [152, [150], Infinity]);
  replay.status(left, { number: 1, from: 100, to: 200, damaged: 0, end: 152 });
  assert.equal(replay.last, 152);
  // Slices are also acknowledged if they will not be shown.
  const rest = { op: 'drawn', id: 1, scan: 3, slice: 0 };
  replay.begin(160);
  assert.deepEqual(told.splice(0)[0], rest);
  replay.arrived(left, slice(152, 3));
  assert.deepEqual(told.splice(0), [rest]);
  replay.end();
  assert.deepEqual(told, [{ op: 'live', id: 1 }, { op: 'live', id: 2 }]);
});

test('times that are long ago are in minutes and hours', () => {
  assert.deepEqual([7, 42.3, 200, 18200].map(duration), ['7.0 s', '42 s', '3:20 min', '5:03:20 h']);
});
