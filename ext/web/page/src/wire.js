// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the protobuf messages of Foxglove that the server sends.

class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.at = 0;
  }

  varint() {
    let value = 0;
    let factor = 1;
    for (;;) {
      const byte = this.bytes[this.at++];
      value += (byte & 0x7f) * factor;
      if (!(byte & 0x80)) return value;
      factor *= 128;
    }
  }

  /**
   * Calls `visit(field, value)` for each field. The values of length-delimited fields are views.
   */
  fields(visit) {
    while (this.at < this.bytes.length) {
      const tag = this.varint();
      const field = tag >>> 3;
      switch (tag & 7) {
        case 0:
          visit(field, this.varint());
          break;
        case 1:
          visit(field, this.view.getFloat64(this.at, true));
          this.at += 8;
          break;
        case 2: {
          const size = this.varint();
          visit(field, this.bytes.subarray(this.at, this.at + size));
          this.at += size;
          break;
        }
        case 5:
          visit(field, this.view.getUint32(this.at, true));
          this.at += 4;
          break;
        default:
          throw new Error('unknown wire type');
      }
    }
  }
}

const utf8 = new TextDecoder();

function collect(bytes, names) {
  const out = {};
  new Reader(bytes).fields((field, value) => {
    const name = names[field];
    if (name === undefined) return;
    if (name.endsWith('[]')) (out[name.slice(0, -2)] ??= []).push(value);
    else out[name] = value;
  });
  return out;
}

function seconds(bytes) {
  const t = bytes ? collect(bytes, { 1: 's', 2: 'ns' }) : {};
  return (t.s ?? 0) + (t.ns ?? 0) * 1e-9;
}

const numbers = (bytes, n) => {
  const v = bytes ? collect(bytes, { 1: '0', 2: '1', 3: '2', 4: '3' }) : {};
  return Array.from({ length: n }, (_, i) => v[i] ?? (i === 3 && !bytes ? 1 : 0));
};

/** Reads a foxglove.PointCloud. `data` of the result is a view of `bytes`. */
export function pointCloud(bytes) {
  const m = collect(bytes, { 1: 'time', 2: 'frame', 4: 'stride', 5: 'fields[]', 6: 'data' });
  return {
    time: seconds(m.time),
    frame: m.frame ? utf8.decode(m.frame) : '',
    stride: m.stride ?? 0,
    fields: (m.fields ?? []).map((f) => {
      const e = collect(f, { 1: 'name', 2: 'offset', 3: 'type' });
      return { name: utf8.decode(e.name), offset: e.offset ?? 0, type: e.type ?? 0 };
    }),
    data: m.data ?? new Uint8Array(),
  };
}

/** Reads a foxglove.CompressedPointCloud. */
export function compressedCloud(bytes) {
  const m = collect(bytes, { 1: 'time', 2: 'frame', 4: 'data' });
  return {
    time: seconds(m.time),
    frame: m.frame ? utf8.decode(m.frame) : '',
    data: m.data ?? new Uint8Array(),
  };
}

/** Reads a foxglove.CompressedVideo, which contains one access unit. */
export function compressedVideo(bytes) {
  const m = collect(bytes, { 1: 'time', 3: 'data', 4: 'format' });
  return {
    time: seconds(m.time),
    format: m.format ? utf8.decode(m.format) : '',
    data: m.data ?? new Uint8Array(),
  };
}

/** Reads a foxglove.FrameTransform. */
export function frameTransform(bytes) {
  const m = collect(bytes, { 1: 'time', 2: 'parent', 3: 'child', 4: 'translation', 5: 'rotation' });
  return {
    time: seconds(m.time),
    child: m.child ? utf8.decode(m.child) : '',
    position: numbers(m.translation, 3),
    rotation: numbers(m.rotation, 4),
  };
}
