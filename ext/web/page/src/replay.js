// SPDX-License-Identifier: LGPL-2.1-or-later
// Replays a recording of the server: requests its slices from a time on, and acknowledges the
// slices that are shown. The server paces by the acknowledgements.

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
   * Calls `on.begin(number)` before the slices of a replay, `on.end()`, `on.show(time)` once all slices
   * up to the time asked for are there, and `on.known()` after each status of a recording;
   * `connection()` returns the Connection of the streams.
   */
  constructor(on, connection) {
    Object.assign(this, { on, connection });
    this.number = 0; // of the last replay; each slice of it has this number
    this.isOn = false;
    this.streams = new Map(); // by channel: {newest, end, unshown}
    this.recordings = new Map(); // by channel: {from, to, damaged}
    this.wanted = null; // time [s] to be shown once its slices have come
  }

  get channels() {
    return [...(this.connection()?.subscriptions.values() ?? [])].filter(hasRecording);
  }

  /** The first and the last time [s] of all recordings; null if there is none. */
  get span() {
    const known = [...this.recordings.values()].filter(({ to }) => to > 0);
    return known.length ? [Math.min(...known.map((r) => r.from)), Math.max(...known.map((r) => r.to))] : null;
  }

  /** Returns true if the server can read none of its recordings. */
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

  /** Acknowledges slices that will not be shown, because the server paces by acknowledgements. */
  drop() {
    for (const [channel, { unshown }] of this.streams) if (unshown.length > 0) this.tell(channel, unshown.at(-1));
    this.streams.clear();
  }

  tell(channel, { scan, slice }) {
    this.connection().tell('drawn', channel, { scan, slice });
  }

  /** Restarts a replay after a subscription, which the server begins live. */
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

  /** Takes the server's status of the recording of `channel`. */
  status(channel, { number, from, to, damaged, end }) {
    this.recordings.set(channel, { from, to, damaged });
    const stream = number === this.number ? this.streams.get(channel) : undefined;
    if (stream) stream.end = end;
    this.on.known();
    this.release();
  }

  /** Notes a slice that the worker has kept, or a pose. */
  arrived(channel, header) {
    const stream = this.streams.get(channel);
    if (!stream || header.replay !== this.number) return this.tell(channel, header);
    // A pose bypasses the worker, and so overtakes slices sent before it.
    if (!header.isPose) stream.newest = Math.max(stream.newest ?? 0, header.captured);
    stream.unshown.push(header);
    this.release();
  }

  isWhole({ newest, end }) {
    return end !== null && (newest ?? 0) >= end;
  }

  /** The time [s] up to which all slices have come. */
  get reach() {
    if (this.streams.size === 0) return -Infinity;
    return Math.min(...[...this.streams.values()].map((s) => (this.isWhole(s) ? Infinity : s.newest ?? -Infinity)));
  }

  /** The time [s] of the last slice of all; Infinity if it is not known yet. */
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

  /** Acknowledges the slices that are shown or will be within AHEAD_S. */
  acknowledge() {
    for (const [channel, { unshown }] of this.streams) {
      let last = null;
      while (unshown.length > 0 && unshown[0].captured <= this.time + AHEAD_S) last = unshown.shift();
      if (last) this.tell(channel, last);
    }
  }
}
