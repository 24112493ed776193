// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares the results of the page's decoder with those of the native decoder, for the streams that
// decoder_cases writes.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { Decoder } from '../../../ext/web/page/src/decoder.js';
import { History, Player } from '../../../ext/web/page/src/history.js';

const MOST_MOVED_M = 1e-6;
const MOST_MS = 50;
const TRIES = 5;
const wasm = readFileSync(new URL('../../../ext/web/decoder/lidar_decoder.wasm', import.meta.url));
const module = new WebAssembly.Module(wasm);

const folder = (path) => new URL(`../../${path}`, import.meta.url).pathname;

function* readStreams() {
  const args = [folder('core/codec/golden'), folder('fuzz/corpus')];
  const all = execFileSync(process.env.DECODER_CASES, args, { maxBuffer: 2 ** 30 });
  let at = 0;
  const number = () => all.readUInt32LE((at += 4) - 4);
  const bytes = (size = number()) => all.subarray(at, (at += size));
  while (at < all.length) {
    const stream = { name: bytes().toString(), model: bytes(), slices: [] };
    for (let left = number(); left > 0; --left)
      stream.slices.push({ coded: bytes(), result: number() | 0, raw: bytes(number() * 20) });
    yield stream;
  }
}

const streams = [...readStreams()];

/** The CPU time [ms] of a task, the least of several tries because the first one compiles. */
function cpuOf(task) {
  let least = Infinity;
  for (let i = 0; i < TRIES && least > MOST_MS; ++i) {
    const began = process.cpuUsage();
    task();
    const { user, system } = process.cpuUsage(began);
    least = Math.min(least, (user + system) / 1000);
  }
  return least;
}

/** Returns how far coordinates differ; asserts that all other bytes are equal. */
function compare(raw, expected, where) {
  assert.equal(raw.length, expected.length, where);
  const [a, b] = [raw, expected].map((v) => new DataView(v.buffer, v.byteOffset, v.byteLength));
  let moved = 0;
  for (let at = 0; at < raw.length; at += 20) {
    for (const axis of [0, 4, 8])
      moved = Math.max(moved, Math.abs(a.getFloat32(at + axis, true) - b.getFloat32(at + axis, true)));
    assert.equal(a.getFloat32(at + 12, true), b.getFloat32(at + 12, true), where);
    assert.equal(a.getUint32(at + 16, true), b.getUint32(at + 16, true), where);
  }
  return moved;
}

test('slices of every kind, good and damaged, give what lidardec gives', () => {
  let [slices, good, points, moved, traps, longest] = [0, 0, 0, 0, 0, 0];
  for (const stream of streams) {
    const decoder = new Decoder(module, stream.model, 1 << 17);
    const { wasm: first } = decoder;
    stream.slices.forEach(({ coded, result, raw }, i) => {
      const where = `${stream.name}, slice ${i}`;
      let decoded;
      longest = Math.max(longest, cpuOf(() => (decoded = decoder.decode(coded))));
      assert.equal(decoded.points ? 0 : decoded.lacksReference ? -2 : -1, result, where);
      slices += 1;
      if (!decoded.points) return;
      good += 1;
      points += decoded.points.length / 6;
      moved = Math.max(moved, compare(decoder.raw(), raw, where));
    });
    traps += decoder.wasm === first ? 0 : 1;
  }
  console.log(`${slices} slices, ${good} of them good, ${points} points, ${moved} m and ${longest.toFixed(1)} ms at most`);
  assert.ok(good > 100 && good < slices);
  assert.equal(traps, 0);
  assert.ok(moved <= MOST_MOVED_M);
  assert.ok(longest <= MOST_MS, 'a slice holds a page up');
});

test('a history of slices that refer to others shows each as it was', async () => {
  const stream = streams.find(({ name }) => name === 'room at effort 3');
  const decoder = new Decoder(module, stream.model);
  const history = new History(1e9);
  const live = stream.slices.map(({ coded: bytes }, i) => {
    const points = decoder.decode(bytes).points.slice();
    const header = { scan: i >> 1, slice: i & 1 };
    history.add({ captured: i, header, bytes, source: decoder, links: decoder.links(bytes) });
    return points;
  });
  assert.ok(history.slices.filter(({ links }) => links.some(({ needs }) => needs !== null)).length >= 3);
  for (const at of [5, 2, 4, 1]) {
    const player = new Player(history, () => new Decoder(module, stream.model), () => {});
    const { slices } = await player.show(at);
    for (const { slice, decoded } of slices) assert.deepEqual(decoded.points, live[slice.captured]);
    assert.deepEqual(slices.at(-1).slice.captured, at);
  }
});

test('a sensor model that is damaged is refused', () => {
  const corpus = folder('fuzz/corpus/sensor_model');
  let opened = 0;
  for (const file of readdirSync(corpus)) {
    const model = readFileSync(`${corpus}/${file}`);
    if (model.length === 0) continue; // an empty model stands for a cloud without a sensor model
    try {
      opened += new Decoder(module, model) ? 1 : 0;
    } catch (error) {
      assert.match(error.message, /sensor model/, file);
    }
  }
  assert.ok(opened > 0);
  for (const model of [new Uint8Array(1), new Uint8Array(90).fill(255)])
    assert.throws(() => new Decoder(module, model), /sensor model/);
});

test('the decoder is a small file that asks for nothing', () => {
  assert.deepEqual(WebAssembly.Module.imports(module), []);
  assert.ok(gzipSync(wasm, { level: 9 }).length < 300_000);
});
