// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes slices in a worker. It receives {open, model} and {close} for a stream, {stream, header,
// data, offset} for a slice, {show} with a time or null, {replay} with a number, and {forget}. The
// answer to a live slice is {stream, header, span}, with points, step, error and has, or with
// lacksReference. The answer to {show} is {picture}. Slices of the current replay are only kept;
// their answer is {stream, header}.
import { Decoder } from './decoder.js';
import { History, Player } from './history.js';

const MOST_BYTES = 64 << 20; // of coded slices: four minutes at 2 Mbit/s

const compiled = WebAssembly.compileStreaming(fetch(new URL('lidar_decoder.wasm', self.location.href)));
let module = null;
const sources = new Map(); // {id, model, decoder, isClosed}
const history = new History(MOST_BYTES);
const pause = () => new Promise((done) => setTimeout(done));
const recorded = new History(MOST_BYTES); // slices of the replay
const [player, replayer] = [history, recorded].map(
  (kept) => new Player(kept, ({ model }) => new Decoder(module, model), pause),
);
let replay = 0;

async function open(id, model) {
  const source = { id, model, decoder: null };
  sources.set(id, source);
  try {
    module ??= await compiled;
    source.decoder = new Decoder(module, model);
  } catch {
    // The sensor model is damaged, so the stream has no decoder.
  }
}

/** Frees the decoder of a stream at once, because kept slices refer to their source for minutes. */
function close(id) {
  Object.assign(sources.get(id) ?? {}, { decoder: null, isClosed: true });
  sources.delete(id);
}

function decode({ stream, header, data, offset }) {
  const source = sources.get(stream);
  const answer = { stream, header, points: null, lacksReference: false };
  if (!source?.decoder) return postMessage(answer);
  const bytes = new Uint8Array(data, offset);
  if (header.replay !== 0) {
    if (header.replay === replay)
      recorded.add({ captured: header.captured, header, bytes, source, links: source.decoder.links(bytes) });
    return postMessage(answer);
  }
  const slice = source.decoder.decode(bytes);
  // Copies the points into the answer, because the decoder will overwrite them with the next slice.
  const points = slice.points?.slice() ?? null;
  if (points)
    history.add({ captured: header.captured, header, bytes, source, links: source.decoder.links(bytes) });
  postMessage({ ...answer, ...slice, points, span: history.span }, points ? [points.buffer] : []);
}

function forget() {
  history.clear();
  player.stop();
}

function beginReplay(number) {
  replay = number;
  wanted = null;
  recorded.clear();
  replayer.stop();
}

let wanted = null; // {time, isReplay}
let isShowing = false;
async function show(time, isReplay) {
  wanted = time === null ? null : { time, isReplay };
  if (wanted === null) player.stop();
  if (isShowing) return;
  isShowing = true;
  while (wanted !== null) {
    const now = wanted;
    const picture = await (now.isReplay ? replayer : player).show(now.time, () => wanted === now);
    if (!picture) continue;
    const slices = picture.slices.map(({ slice: { source, header }, decoded }) => ({ stream: source.id, header, ...decoded }));
    postMessage({ picture: { ...picture, time: now.time, slices } }, slices.map(({ points }) => points.buffer));
    if (wanted === now) wanted = null;
  }
  isShowing = false;
}

// Each message waits until the message before it is done, because opening a decoder takes time.
let last = Promise.resolve();
onmessage = ({ data: message }) => {
  if (message.show !== undefined) return void show(message.show, message.isReplay);
  if (message.replay !== undefined) return beginReplay(message.replay);
  last = last.then(() => {
    if (message.open !== undefined) return open(message.open, message.model);
    if (message.close !== undefined) return close(message.close);
    if (message.forget) return forget();
    return decode(message);
  });
};
