// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes slices beside the page: {open, model} and {close} of a stream, and {stream, data, offset}
// in; {stream, id, points, step, error, has} or {stream, id, lacksReference} out.
import { Decoder } from './decoder.js';

const module = WebAssembly.compileStreaming(fetch(new URL('lidar_decoder.wasm', self.location.href)));
const decoders = new Map(); // null for a sensor model that is damaged

async function open(stream, model) {
  try {
    decoders.set(stream, new Decoder(await module, model));
  } catch {
    decoders.set(stream, null);
  }
}

function decode({ stream, id, data, offset }) {
  const decoder = decoders.get(stream);
  if (!decoder) return postMessage({ stream, id, points: null, lacksReference: false });
  const slice = decoder.decode(new Uint8Array(data, offset));
  // What leaves is a copy: the decoder writes the next slice to the same place.
  const points = slice.points?.slice() ?? null;
  postMessage({ ...slice, stream, id, points }, points ? [points.buffer] : []);
}

// One after the other: a decoder may still be on its way.
let last = Promise.resolve();
onmessage = ({ data: message }) => {
  last = last.then(() => {
    if (message.open !== undefined) return open(message.open, message.model);
    if (message.close !== undefined) return decoders.delete(message.close);
    return decode(message);
  });
};
