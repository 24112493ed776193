// SPDX-License-Identifier: LGPL-2.1-or-later
// Replays a recording of the server. Requests the slices after a time, and acknowledges the slices
// that are shown. The acknowledgements control how fast the server sends.

const AHEAD_S = 1; // slices are acknowledged this long before they are shown

const hasRecording = ({ schemaName, schema }) => {
  try {
    return schemaName === 'lidar.Slice' && JSON.parse(schema).recording === true;
  } catch {
    return false;
  }
};

export class Replay {
  /**
   * Calls `on.begin(number)` before the slices of a replay, and `on.end()` after it. Calls
   * `on.show(time)` as soon as all slices up to the requested time have arrived, and `on.known()`
   * after each status of a recording. `connection()` returns the Connection of the streams.
   */
  constructor(on, connection) {
    Object.assign(this, { on, connection });
    this.number = 0; // number of the last replay, which all its slices contain
    this.isOn = false;
    this.streams = new Map(); // by channel: {newest, end, unshown}
    this.recordings = new Map(); // by channel: {from, to, damaged}
    this.wanted = null; // time [s] that is shown as soon as its slices have arrived
  }

  get channels() {
    return [...(this.connection()?.subscriptions.values() ?? [])].filter(hasRecording);
  }

  /** The first and the last time [s] of all recordings, or null if there are no recordings. */
  get span() {
    const known = [...this.recordings.values()].filter(({ to }) => to > 0);
    return known.length ? [Math.min(...known.map((r) => r.from)), Math.max(...known.map((r) => r.to))] : null;
  }

  /** True if the server cannot read any of its recordings. */
  get isBroken() {
    return this.recordings.size > 0 && this.span === null;
  }

  get isDamaged() {
    return [...this.recordings.values()].some(({ damaged }) => damaged > 0);
  }

  begin(time) {
    this.number = (this.number % 65535) + 1;
    this.isOn = true;
    this.time = this.wanted = time;
    this.drop();
    this.on.begin(this.number);
    for (const channel of this.channels) {
      this.streams.set(channel, { newest: null, end: null, unshown: [] });
      this.connection().tell('replay', channel, { number: this.number, time });
    }
  }

  end() {
    if (!this.isOn) return;
    const channels = [...this.streams.keys()];
    this.drop();
    for (const channel of channels) this.connection().tell('live', channel);
    this.isOn = false;
    this.wanted = null;
    this.on.end();
  }

  /**
   * Acknowledges the slices that will not be shown, because the server waits for acknowledgements.
   */
  drop() {
    for (const [channel, { unshown }] of this.streams) if (unshown.length > 0) this.tell(channel, unshown.at(-1));
    this.streams.clear();
  }

  tell(channel, { scan, slice }) {
    this.connection().tell('drawn', channel, { scan, slice });
  }

  /**
   * Restarts a running replay after a subscription, because the server begins each subscription
   * with live slices.
   */
  subscribed(channel) {
    const offered = [...this.connection().offered.values()];
    for (const known of this.recordings.keys()) if (!offered.includes(known)) this.recordings.delete(known);
    if (this.isOn && hasRecording(channel)) this.begin(this.time);
  }

  dropped(channel) {
    this.streams.delete(channel);
  }

  /** Forgets the recordings of streams that are no longer shown. */
  forget() {
    this.recordings.clear();
    this.on.known();
  }

  /** Handles the server's status of the recording of `channel`. */
  status(channel, { number, from, to, damaged, end }) {
    this.recordings.set(channel, { from, to, damaged });
    const stream = number === this.number ? this.streams.get(channel) : undefined;
    if (stream) stream.end = end;
    this.on.known();
    this.release();
  }

  /** Notes a pose, or a slice that the worker has kept. */
  arrived(channel, header) {
    const stream = this.streams.get(channel);
    if (!stream || header.replay !== this.number) return this.tell(channel, header);
    // Poses do not pass through the worker, so a pose may arrive here before slices that were sent
    // earlier.
    if (!header.isPose) stream.newest = Math.max(stream.newest ?? 0, header.captured);
    stream.unshown.push(header);
    this.release();
  }

  isWhole({ newest, end }) {
    return end !== null && (newest ?? 0) >= end;
  }

  /** The time [s] up to which all slices have arrived. */
  get reach() {
    if (this.streams.size === 0) return -Infinity;
    return Math.min(...[...this.streams.values()].map((s) => (this.isWhole(s) ? Infinity : s.newest ?? -Infinity)));
  }

  /** The time [s] of the last slice of all streams, or Infinity if it is not yet known. */
  get last() {
    const streams = [...this.streams.values()];
    if (streams.length === 0 || !streams.every((s) => this.isWhole(s))) return Infinity;
    return Math.max(...streams.map(({ newest }) => newest ?? -Infinity));
  }

  show(time) {
    this.time = this.wanted = time;
    this.release();
  }

  release() {
    if (this.wanted === null || this.wanted > this.reach) return;
    const time = this.wanted;
    this.wanted = null;
    this.on.show(time);
  }

  /** Acknowledges the slices that are shown now or within the next AHEAD_S. */
  acknowledge() {
    for (const [channel, { unshown }] of this.streams) {
      let last = null;
      while (unshown.length > 0 && unshown[0].captured <= this.time + AHEAD_S) last = unshown.shift();
      if (last) this.tell(channel, last);
    }
  }
}
