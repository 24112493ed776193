// SPDX-License-Identifier: LGPL-2.1-or-later
// A recording that the server has: asks for its slices from a time on, and acknowledges those whose
// time has come, so that the server sends on as they are shown.

const AHEAD_S = 1; // of the time that is shown

const hasRecording = ({ schemaName, schema }) => {
  try {
    return schemaName === 'lidar.Slice' && JSON.parse(schema).recording === true;
  } catch {
    return false;
  }
};

export class Replay {
  /**
   * `on.begin(number)` before the slices of a replay, `on.end()`, `on.show(time)` once what has come
   * reaches so far, `on.known()` after each word about a recording; `connection()` gives the one
   * that streams come by.
   */
  constructor(on, connection) {
    Object.assign(this, { on, connection });
    this.number = 0; // of the last replay: the server sends it with each slice
    this.isOn = false;
    this.streams = new Map(); // by channel: {newest, end, unshown}
    this.recordings = new Map(); // by channel: {from, to, damaged}
    this.wanted = null; // time that is to be shown once its slices have come
  }

  get channels() {
    return [...(this.connection()?.subscriptions.values() ?? [])].filter(hasRecording);
  }

  /** Times of all recordings together [s]; null: there is none. */
  get span() {
    const known = [...this.recordings.values()].filter(({ to }) => to > 0);
    return known.length ? [Math.min(...known.map((r) => r.from)), Math.max(...known.map((r) => r.to))] : null;
  }

  /** Whether no recording that the server offers can be read. */
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

  /** What has come and is not shown any more: the server paces by what is acknowledged. */
  drop() {
    for (const [channel, { unshown }] of this.streams) if (unshown.length > 0) this.tell(channel, unshown.at(-1));
    this.streams.clear();
  }

  tell(channel, { scan, slice }) {
    this.connection().tell('drawn', channel, { scan, slice });
  }

  /** A channel was subscribed to: the server begins it live. */
  subscribed(channel) {
    const offered = [...this.connection().offered.values()];
    for (const known of this.recordings.keys()) if (!offered.includes(known)) this.recordings.delete(known);
    if (this.isOn && hasRecording(channel)) this.begin(this.time);
  }

  dropped(channel) {
    this.streams.delete(channel);
  }

  /** What was known is of streams that are no longer shown. */
  forget() {
    this.recordings.clear();
    this.on.known();
  }

  /** The server's word about the recording of `channel`. */
  status(channel, { number, from, to, damaged, end }) {
    this.recordings.set(channel, { from, to, damaged });
    const stream = number === this.number ? this.streams.get(channel) : undefined;
    if (stream) stream.end = end;
    this.on.known();
    this.release();
  }

  /** A slice is where it can be shown from, or a pose. */
  arrived(channel, header) {
    const stream = this.streams.get(channel);
    if (!stream || header.replay !== this.number) return this.tell(channel, header);
    // A pose comes without the worker, before the slices in front of it.
    if (!header.isPose) stream.newest = Math.max(stream.newest ?? 0, header.captured);
    stream.unshown.push(header);
    this.release();
  }

  isWhole({ newest, end }) {
    return end !== null && (newest ?? 0) >= end;
  }

  /** Up to this time everything has come. */
  get reach() {
    if (this.streams.size === 0) return -Infinity;
    return Math.min(...[...this.streams.values()].map((s) => (this.isWhole(s) ? Infinity : s.newest ?? -Infinity)));
  }

  /** The time behind which nothing follows; Infinity: not known yet. */
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

  /** Acknowledges what has been shown, or will be soon. */
  acknowledge() {
    for (const [channel, { unshown }] of this.streams) {
      let last = null;
      while (unshown.length > 0 && unshown[0].captured <= this.time + AHEAD_S) last = unshown.shift();
      if (last) this.tell(channel, last);
    }
  }
}
