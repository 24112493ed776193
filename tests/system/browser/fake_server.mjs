// SPDX-License-Identifier: LGPL-2.1-or-later
// A server that speaks the protocol of foxglovesink. A test chooses its channels and messages. The
// server records what the page sends.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import { WebSocketServer } from 'ws';

const web = new URL('../../../ext/web/', import.meta.url);
const TYPES = { html: 'text/html', js: 'text/javascript', css: 'text/css', wasm: 'application/wasm' };
const NS = 1_000_000n;
const now = () => BigInt(Math.round(performance.timeOrigin + performance.now())) * NS;

/** Slices of lidartestsrc, coded by lidarenc, and the `about` of their channel. */
export function recordSlices({ model = 'os0-32', mode = '512x10', slices = 8, scans = 10, coder = '' } = {}) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'lidar-slices-'));
  const line =
    `lidartestsrc model=${model} mode=${mode} slices-per-scan=${slices} num-buffers=${slices * scans} speed=5 ` +
    `! lidarenc ${coder} ! multifilesink location=${folder}/%05d.bin`;
  const output = execFileSync('gst-launch-1.0', ['-v', ...line.split(/\s+/)], { encoding: 'utf8' });
  const hex = /sensor-model=\(buffer\)([0-9a-f]+)/.exec(output)[1];
  const about = {
    geometry: 'range',
    fields: 'x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16',
    framerate: [10, 1],
    sensorModel: Buffer.from(hex, 'hex').toString('base64'),
    frameId: 'lidar',
  };
  const coded = readdirSync(folder).sort().map((file) => readFileSync(path.join(folder, file)));
  rmSync(folder, { recursive: true });
  return { about, coded, slices };
}

/** The channel of recorded slices for clouds of `topic`. */
export const sliceChannel = (id, topic, { about }) => ({
  id, topic: `${topic}/slices`, encoding: 'lidar-slice', schemaName: 'lidar.Slice', schemaEncoding: 'json',
  schema: JSON.stringify({ ...about, clouds: topic }),
});
export const jsonChannel = (id, topic, schemaName) =>
  ({ id, topic, encoding: 'json', schemaName, schemaEncoding: 'jsonschema', schema: '' });

/** A foxglove.FrameTransform without rotation. */
function transform(ns, child, position) {
  const varint = (v) => (v < 128n ? [Number(v)] : [Number(v & 127n) | 128, ...varint(v >> 7n)]);
  const bytes = (field, content) => Buffer.concat([Buffer.from([(field << 3) | 2, content.length]), content]);
  const double = (value, i) => {
    const out = Buffer.alloc(9);
    out.writeUInt8(((i + 1) << 3) | 1, 0);
    out.writeDoubleLE(value, 1);
    return out;
  };
  const time = Buffer.from([8, ...varint(ns / 1_000_000_000n), 16, ...varint(ns % 1_000_000_000n)]);
  const rotation = double(1, 3);
  const parts = [bytes(1, time), bytes(3, Buffer.from(child)), bytes(4, Buffer.concat(position.map(double))), bytes(5, rotation)];
  return Buffer.concat(parts);
}

export class FakeServer {
  static async start(port, channels, { token = null } = {}) {
    const server = new FakeServer();
    Object.assign(server, { channels, token, told: [], subscribed: new Map(), policy: '', status: 200 });
    const code = readFileSync(new URL('page_files.cpp', web), 'utf8');
    server.policy = [.../kPolicy =([^;]|;[^\n])*?";\n/.exec(code)[0].matchAll(/"([^"]*)"/g)].map((m) => m[1]).join('');
    server.http = http.createServer((request, answer) => server.answer(request, answer));
    server.sockets = new WebSocketServer({ noServer: true, handleProtocols: () => 'foxglove.sdk.v1' });
    server.http.on('upgrade', (request, socket, head) => {
      if (!server.admits(request)) return socket.end('HTTP/1.1 401 Unauthorized\r\n\r\n');
      server.sockets.handleUpgrade(request, socket, head, (client) => server.join(client));
    });
    await new Promise((done) => server.http.listen(port, '127.0.0.1', done));
    return server;
  }

  admits({ url }) {
    return this.token === null || new URL(url, 'http://x').searchParams.get('token') === this.token;
  }

  answer(request, answer) {
    const name = new URL(request.url, 'http://x').pathname.slice(1) || 'index.html';
    if (name === 'session') return answer.writeHead(this.admits(request) ? 200 : 401).end();
    try {
      const folder = name === 'lidar_decoder.wasm' ? 'decoder/' : 'page/dist/';
      const body = readFileSync(new URL(folder + name, web));
      const type = TYPES[name.split('.').pop()] ?? 'text/plain';
      answer.writeHead(200, { 'Content-Type': type, 'Content-Security-Policy': this.policy }).end(body);
    } catch {
      answer.writeHead(404).end();
    }
  }

  join(client) {
    this.client = client;
    this.subscribed.clear();
    client.send(JSON.stringify({ op: 'serverInfo', name: 'fake', capabilities: [], sessionId: '1' }));
    client.send(JSON.stringify({ op: 'advertise', channels: this.channels }));
    client.on('message', (text) => {
      const message = JSON.parse(text);
      this.told.push(message);
      for (const { id, channelId } of message.subscriptions ?? []) this.subscribed.set(channelId, id);
      if (message.op !== 'unsubscribe') return;
      for (const [channel, id] of this.subscribed)
        if (message.subscriptionIds.includes(id)) this.subscribed.delete(channel);
    });
  }

  /** Sends a message of a channel, if the page has subscribed to it; returns whether it has. */
  send(channel, payload, captured = now()) {
    const subscription = this.subscribed.get(channel);
    if (subscription === undefined) return false;
    const head = Buffer.alloc(13);
    head.writeUInt8(1, 0);
    head.writeUInt32LE(subscription, 1);
    head.writeBigUInt64LE(captured, 5);
    this.client.send(Buffer.concat([head, payload]));
    return true;
  }

  /** Sends the status of a channel's recording. */
  describe(channel, status) {
    const subscriptionId = this.subscribed.get(channel);
    this.client.send(JSON.stringify({ op: 'recording', subscriptionId, number: 0, damaged: 0, end: null, ...status }));
  }

  /** Sends the pose of the sensor at `ms`, as part of a replay. */
  sendPose(channel, position, ms, replay) {
    const head = Buffer.alloc(24);
    head.writeUInt8(1, 0);
    head.writeUInt8(2, 1);
    head.writeUInt16LE(replay, 6);
    const at = BigInt(Math.round(ms * 1e6));
    const pose = transform(at, 'lidar', position);
    return this.send(channel, Buffer.concat([head, pose]), at);
  }

  /** Sends recorded slice `i` as captured `age` ms ago; `replay` is 0 for the live stream. */
  sendSlice(channel, { coded, slices }, i, age = 0, replay = 0) {
    const head = Buffer.alloc(24);
    head.writeUInt8(1, 0);
    head.writeUInt16LE(i % slices, 2);
    head.writeUInt16LE(slices, 4);
    head.writeUInt16LE(replay, 6);
    head.writeUInt32LE(Math.floor(i / slices), 8);
    head.writeBigUInt64LE(now(), 16);
    return this.send(channel, Buffer.concat([head, coded[i % coded.length]]), now() - BigInt(Math.round(age * 1e6)));
  }

  stop() {
    this.client?.terminate();
    this.http.closeAllConnections();
    return new Promise((done) => this.http.close(done));
  }
}
