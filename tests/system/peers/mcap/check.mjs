// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads a recording with @mcap/core and with Foxglove's decoders of ROS 2 messages, and checks the
// checksums.
// Usage: node check.mjs FILE TOPIC=COUNT ...
import assert from "node:assert";
import { open } from "node:fs/promises";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress as zstd } from "fzstd";
import lz4 from "lz4js";

const [path, ...expected] = process.argv.slice(2);
const decompressHandlers = {
  lz4: (buffer) => lz4.decompress(buffer),
  zstd: (buffer, size) => zstd(buffer, new Uint8Array(Number(size))),
};
const file = await open(path);
const size = BigInt((await file.stat()).size);
const readable = {
  size: async () => size,
  read: async (offset, length) => {
    const bytes = new Uint8Array(Number(length));
    await file.read(bytes, 0, Number(length), Number(offset));
    return bytes;
  },
};

const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
assert.equal(reader.header.profile, "ros2");
assert.ok(reader.statistics.chunkCount > 0);

// Decodes messages by the definition that is in the file.
const decoders = new Map();
function decode(channel, data) {
  if (!decoders.has(channel.id)) {
    const schema = reader.schemasById.get(channel.schemaId);
    assert.equal(schema.encoding, "ros2msg");
    assert.equal(channel.messageEncoding, "cdr");
    const definition = parse(new TextDecoder().decode(schema.data), { ros2: true });
    decoders.set(channel.id, [schema.name, new MessageReader(definition)]);
  }
  const [name, messages] = decoders.get(channel.id);
  return [name, messages.readMessage(data)];
}

const checks = {
  "sensor_msgs/msg/PointCloud2": (m) => {
    assert.equal(m.data.length, m.row_step * m.height);
    assert.equal(m.row_step, m.point_step * m.width);
    assert.deepEqual(m.fields.slice(0, 3).map((f) => [f.name, f.datatype, f.offset]), [
      ["x", 7, 0],
      ["y", 7, 4],
      ["z", 7, 8],
    ]);
    const view = new DataView(m.data.buffer, m.data.byteOffset);
    let returns = 0;
    for (let i = 0; i < m.width * m.height; ++i) {
      const x = view.getFloat32(i * m.point_step, true);
      assert.ok(Math.abs(x) < 200);
      returns += x !== 0 ? 1 : 0;
    }
    assert.ok(returns > (m.width * m.height) / 4);
  },
  "gst_lidar_msgs/msg/CodedSlice": (m) => {
    assert.ok(m.slice_index < m.slice_count);
    assert.ok(m.data.length > 0);
    assert.ok(m.header.stamp.sec > 1_500_000_000);
  },
  "nav_msgs/msg/Odometry": (m) => {
    const q = m.pose.pose.orientation;
    assert.ok(Math.abs(Math.hypot(q.x, q.y, q.z, q.w) - 1) < 1e-6);
    assert.equal(m.child_frame_id, "lidar");
  },
  "sensor_msgs/msg/Imu": (m) => {
    assert.ok(Math.abs(m.linear_acceleration.z) < 40);
  },
};

const counts = {};
let last = 0n;
for await (const message of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(message.channelId);
  assert.ok(message.logTime >= last);
  last = message.logTime;
  const [name, content] = decode(channel, message.data);
  checks[name](content);
  counts[channel.topic] = (counts[channel.topic] ?? 0) + 1;
}
for (const pair of expected) {
  const [topic, count] = pair.split("=");
  assert.equal(counts[topic], Number(count), topic);
}

// The reader uses the message indexes to find messages from a start time on.
const middle = (reader.statistics.messageStartTime + reader.statistics.messageEndTime) / 2n;
for await (const message of reader.readMessages({ startTime: middle })) {
  assert.ok(message.logTime >= middle);
}

// A reader that reads the whole file in order checks the checksum of the data section.
const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(await readable.read(0n, size));
let streamed = 0n;
for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message" ? 1n : 0n;
assert.ok(stream.done());
assert.equal(streamed, reader.statistics.messageCount);
console.log(`${path}: ${streamed} messages, as recorded`);
