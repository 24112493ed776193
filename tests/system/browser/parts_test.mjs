// SPDX-License-Identifier: LGPL-2.1-or-later
// Parts of the page that need no browser.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Clock, nowSeconds } from '../../../ext/web/page/src/clock.js';
import { Poses } from '../../../ext/web/page/src/poses.js';
import { readHeader } from '../../../ext/web/page/src/slices.js';

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
