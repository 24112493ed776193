// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests foxglovesink with Foxglove's own client: the npm package @foxglove/ws-protocol receives the
// messages, and protobufjs reads them with the schemas of the channels.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import ws from '@foxglove/ws-protocol';
import protobuf from 'protobufjs';
import descriptor from 'protobufjs/ext/descriptor/index.js';
import WebSocket from 'ws';
import { freePort, Pipeline, until } from './support.mjs';

// These packages are CommonJS modules, and Node.js cannot import single names from them.
const require = createRequire(import.meta.url);
const { NumericType } = require('@foxglove/schemas');
const jsonSchemas = require('@foxglove/schemas/jsonschema');

/** Waits until `count` channels had a message; returns the first of each, decoded. */
async function messages(port, subprotocol, count) {
  const socket = new WebSocket(`ws://127.0.0.1:${port}`, [subprotocol]);
  const client = new ws.FoxgloveClient({ ws: socket });
  const channels = new Map();
  const got = {};
  client.on('error', (error) => assert.fail(error));
  client.on('advertise', (list) => {
    for (const channel of list) channels.set(client.subscribe(channel.id), channel);
  });
  client.on('message', ({ subscriptionId, timestamp, data }) => {
    const channel = channels.get(subscriptionId);
    if (got[channel.topic]) return;
    const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
    const decoded = channel.encoding === 'json' ? JSON.parse(new TextDecoder().decode(bytes)) : decode(channel, bytes);
    got[channel.topic] = { channel, timestamp, message: decoded, type: typeOf(channel) };
  });
  await until(`messages of ${count} channels`, () => Object.keys(got).length >= count);
  assert.equal(socket.protocol, subprotocol);
  assert.equal(socket.extensions, '');
  client.close();
  return got;
}

function typeOf(channel) {
  if (channel.schemaEncoding !== 'protobuf') return null;
  const set = descriptor.FileDescriptorSet.decode(Buffer.from(channel.schema, 'base64'));
  const root = protobuf.Root.fromDescriptor(set);
  root.resolveAll();
  return root.lookupType(channel.schemaName);
}
const decode = (channel, bytes) => typeOf(channel).decode(bytes);

/** Asserts that our schema has the same names of fields as Foxglove's. */
function assertSameFields({ channel, type }) {
  const schema = jsonSchemas[channel.schemaName.replace('foxglove.', '')];
  assert.ok(schema, channel.schemaName);
  assert.deepEqual(type.fieldsArray.map((f) => f.name).sort(), Object.keys(schema.properties).sort());
}

for (const subprotocol of ['foxglove.sdk.v1', 'foxglove.websocket.v1']) {
  test(`clouds, poses and statistics over ${subprotocol}`, { timeout: 120_000 }, async () => {
    const port = await freePort();
    const way =
      `lidartestsrc is-live=true model=os0-32 mode=512x10 ! tee name=t t. ! queue ! lidarodometry name=o ! queue ! web.sink_0 ` +
      `o.odometry ! queue ! web.sink_2 t. ! queue ! dracoenc geometry=xyz ! queue ! web.sink_1 foxglovesink name=web port=${port}`;
    const pipeline = await Pipeline.start(way.replace(/ {2,}/g, ' '), port);
    const got = await messages(port, subprotocol, 6);
    const points = got['/points'].message;
    assert.equal(points.frame_id, 'lidar');
    assert.ok(Math.abs(Number(points.timestamp.seconds) - Date.now() / 1000) < 60);
    const x = points.fields.find((f) => f.name === 'x');
    assert.equal(x.type, NumericType.FLOAT32);
    assert.equal(points.data.length % points.point_stride, 0);
    assert.ok(points.data.length / points.point_stride > 100);
    const draco = got['/points_draco_1'].message;
    assert.equal(draco.format, 'draco');
    assert.equal(new TextDecoder().decode(draco.data.subarray(0, 5)), 'DRACO');
    assert.equal(got['/tf'].message.parent_frame_id, 'odom');
    const poses = Object.values(got).find((g) => g.channel.schemaName === 'foxglove.PoseInFrame');
    assert.ok(Math.abs(Math.hypot(...['x', 'y', 'z', 'w'].map((k) => poses.message.pose.orientation[k])) - 1) < 1e-6);
    const statistics = got['/statistics'].message;
    assert.ok(statistics.step >= 0 && statistics.elements.web.clients === 1);
    for (const topic of ['/points', '/points_draco_1', '/tf']) assertSameFields(got[topic]);
    assertSameFields(poses);
    await pipeline.stop();
  });
}
