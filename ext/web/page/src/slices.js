// SPDX-License-Identifier: LGPL-2.1-or-later
// Streams of slices as the robot encoded them. Passes slices to the worker, decoded points to the
// page, and acknowledgements to the server.
import { Clock } from './clock.js';

const HEADER = 24;
const VERSION = 1;
const NO_REFERENCE_MS = 1000; // time between two 'lacksReference'

/** A WebAssembly module that is valid only in browsers that have SIMD. */
const SIMD = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];

export const canDecode = () => typeof Worker === 'function' && WebAssembly.validate(new Uint8Array(SIMD));

const fromBase64 = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/** Returns the header of a message, or null if the header has another version. */
export function readHeader(bytes) {
  if (bytes.length < HEADER) return null;
  const view = new DataView(bytes.buffer, bytes.byteOffset, HEADER);
  if (view.getUint8(0) !== VERSION) return null;
  return {
    recoded: (view.getUint8(1) & 1) !== 0,
    isPose: (view.getUint8(1) & 2) !== 0,
    slice: view.getUint16(2, true),
    slices: view.getUint16(4, true),
    replay: view.getUint16(6, true),
    scan: view.getUint32(8, true),
    sent: Number(view.getBigUint64(16, true)) * 1e-9,
  };
}

class Stream {
  constructor(id, channel, about) {
    Object.assign(this, { id, channel, about });
    this.clock = new Clock();
    this.newest = null; // header of the last live slice that the worker has answered
    this.told = null; // header that was acknowledged last
    this.complained = 0;
  }
}

export class Slices {
  /**
   * Calls `on.points(about, header, decoded, clock)` for live slices, `on.arrived(channel, header)`
   * for slices and poses of a replay, `on.pose(header, bytes)` for poses of a replay,
   * `on.picture(picture)` as the answer to show(), and `on.span([from, to])` with the times that
   * show() accepts. `connection()` returns the Connection of the streams.
   */
  constructor(on, connection) {
    Object.assign(this, { on, connection });
    this.streams = new Map(); // by channel
    this.abouts = []; // by id of the stream, also of streams that have ended
    this.damaged = 0;
  }

  open(channel) {
    const about = JSON.parse(channel.schema);
    const stream = new Stream(this.abouts.push(about) - 1, channel, about);
    this.streams.set(channel, stream);
    const model = about.geometry === 'range' ? fromBase64(about.sensorModel) : new Uint8Array();
    this.start().postMessage({ open: stream.id, model });
    return stream;
  }

  /** Returns the worker. The first call starts it. */
  start() {
    if (this.worker) return this.worker;
    this.worker = new Worker(new URL('./slice_worker.js', import.meta.url), { type: 'module' });
    this.worker.onmessage = ({ data }) => this.decoded(data);
    return this.worker;
  }

  close(channel) {
    const stream = this.streams.get(channel);
    if (!stream) return;
    this.streams.delete(channel);
    this.worker.postMessage({ close: stream.id });
  }

  /** Handles a message of `channel`. `captured` is in nanoseconds. */
  add(channel, bytes, captured) {
    const header = readHeader(bytes);
    if (!header) return;
    const stream = this.streams.get(channel) ?? this.open(channel);
    header.captured = Number(captured) * 1e-9;
    if (header.isPose) {
      this.on.pose(header, bytes.subarray(HEADER));
      return this.on.arrived(channel, header);
    }
    if (header.replay === 0) stream.clock.arrived(header.sent);
    const offset = bytes.byteOffset + HEADER;
    this.worker.postMessage({ stream: stream.id, header, data: bytes.buffer, offset }, [bytes.buffer]);
  }

  decoded({ picture, span, stream: id, header, ...result }) {
    if (picture) return this.on.picture(picture);
    if (span) this.on.span(span);
    const stream = [...this.streams.values()].find((s) => s.id === id);
    if (!stream) return; // the stream has ended
    if (header.replay !== 0) return this.on.arrived(stream.channel, header);
    stream.newest = header;
    if (result.points) return this.on.points(stream.about, header, result, stream.clock);
    ++this.damaged;
    const now = performance.now();
    if (!result.lacksReference || now - stream.complained < NO_REFERENCE_MS) return;
    stream.complained = now;
    this.connection().tell('lacksReference', stream.channel);
  }

  /**
   * Requests the picture at a capture time [s] of the replay or the live streams. null stops the
   * pictures.
   */
  show(time, isReplay = false) {
    this.worker?.postMessage({ show: time, isReplay });
  }

  /** Makes the worker keep the slices of this replay, and no others. 0 means no replay. */
  replay(number) {
    this.start().postMessage({ replay: number });
  }

  /** Drops the slices of live streams that the worker keeps. */
  forget() {
    this.worker?.postMessage({ forget: true });
  }

  /** Acknowledges the newest slice of each stream, which the page has drawn. */
  drawn() {
    for (const stream of this.streams.values()) {
      const { newest } = stream;
      if (newest === stream.told) continue;
      stream.told = newest;
      this.connection().tell('drawn', stream.channel, { scan: newest.scan, slice: newest.slice });
    }
  }
}
