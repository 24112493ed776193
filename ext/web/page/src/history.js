// SPDX-License-Identifier: LGPL-2.1-or-later
// Keeps the coded slices of the last minutes, ordered by capture time, and shows them again.

const MOST_AHEAD_S = 1; // a time that is further ahead is a jump
const PATIENCE_MS = 20; // time of decoding after which the worker reads its messages

/** Slices are {captured, header, bytes, links, source}. There is a decoder for each `source`. */
export class History {
  constructor(mostBytes) {
    this.mostBytes = mostBytes;
    this.clear();
  }

  clear() {
    this.slices = [];
    this.first = 0; // the number of slices[0]
    this.bytes = 0;
    this.named = new Map();
  }

  /**
   * Inserts a slice by its time. If there is no room, drops the oldest slices, and also the slices
   * that refer to dropped slices.
   */
  add(slice) {
    this.slices.splice(this.after(slice.captured) - this.first, 0, slice);
    this.bytes += slice.bytes.length;
    for (const { name } of slice.links) this.named.set(name, slice);
    let old = 0;
    const isOver = () => this.bytes > this.mostBytes || !this.hasNeeds(this.slices[old]);
    for (; old < this.slices.length - 1 && isOver(); ++old) this.forget(this.slices[old]);
    this.first += old;
    this.slices.splice(0, old);
  }

  forget(slice) {
    this.bytes -= slice.bytes.length;
    for (const { name } of slice.links) if (this.named.get(name) === slice) this.named.delete(name);
  }

  hasNeeds({ links }) {
    return links.every(({ needs }) => needs === null || this.named.has(needs));
  }

  /**
   * Returns the capture times [s] of the oldest and the newest slice, or null if there are no
   * slices.
   */
  get span() {
    return this.slices.length > 0 ? [this.slices[0].captured, this.slices.at(-1).captured] : null;
  }

  get end() {
    return this.first + this.slices.length;
  }
  at(number) {
    return this.slices[number - this.first];
  }

  /** Returns the number of the first slice that is later than `time`. */
  after(time) {
    let [low, high] = [0, this.slices.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.slices[middle].captured <= time) low = middle + 1;
      else high = middle;
    }
    return this.first + low;
  }

  /**
   * Returns the number at which the last two scans before slice `number` begin. Two scans contain a
   * whole picture.
   */
  scanBefore(number) {
    const scans = new Set();
    const source = this.at(number - 1)?.source;
    for (; number > this.first; --number) {
      const slice = this.at(number - 1);
      if (slice.source === source) scans.add(slice.header.scan);
      if (scans.size > 2) break;
    }
    return number;
  }

  /**
   * Returns the slices that must be decoded before `slice`, the oldest first. `known` are the
   * blocks that the decoders have.
   */
  needs(slice, known) {
    const found = new Set();
    const open = [slice];
    while (open.length > 0) {
      for (const { needs } of open.pop().links) {
        const other = needs === null || known.has(needs) ? undefined : this.named.get(needs);
        if (!other || found.has(other)) continue;
        found.add(other);
        open.push(other);
      }
    }
    return [...found].sort((a, b) => a.captured - b.captured);
  }
}

/**
 * Decodes the slices of a history. Its decoders are separate from the decoders of the live streams.
 */
export class Player {
  /** `open(source)` returns a Decoder. `pause()` lets the worker read its messages. */
  constructor(history, open, pause) {
    Object.assign(this, { history, open, pause });
    this.decoders = new Map();
    this.stop();
  }

  /**
   * Forgets the picture. Also deletes the decoders of closed streams of which the history has no
   * slices.
   */
  stop() {
    const kept = new Set(this.history.slices.map(({ source }) => source));
    for (const source of this.decoders.keys()) if (source.isClosed && !kept.has(source)) this.decoders.delete(source);
    this.shown = null; // time of the last picture
    this.next = 0; // number of the slice to be shown next
    this.known = new Set(); // blocks that the decoders have
  }

  decode(slice) {
    const { source, links, bytes } = slice;
    if (!this.decoders.has(source)) this.decoders.set(source, this.open(source));
    for (const { name } of links) this.known.add(name);
    return this.decoders.get(source).decode(bytes);
  }

  /** Returns true if the slices up to `time` do not continue the last picture. */
  isJump(time) {
    const { shown, next, history } = this;
    return shown === null || time < shown || time > shown + MOST_AHEAD_S || next < history.first;
  }

  /**
   * Decodes the picture at `time` and returns {jumped, slices: [{slice, decoded}], next}. `slices`
   * are the slices that are new in this picture, or all its slices after a jump. `next` is the time
   * of the slice after them. Returns null as soon as `isWanted()` returns false.
   */
  async show(time, isWanted = () => true) {
    const { history } = this;
    const jumped = this.isJump(time);
    const end = history.after(time);
    const start = jumped ? history.scanBefore(end) : this.next;
    if (jumped) this.stop();
    const wanted = Array.from({ length: Math.max(end - start, 0) }, (_, i) => history.at(start + i));
    const slices = [];
    let began = performance.now();
    for (const slice of wanted) {
      for (const one of [...history.needs(slice, this.known), slice]) {
        const { points, ...decoded } = this.decode(one);
        if (one === slice && points) slices.push({ slice, decoded: { ...decoded, points: points.slice() } });
        if (performance.now() - began < PATIENCE_MS) continue;
        await this.pause();
        began = performance.now();
        if (!isWanted()) return this.stop() ?? null;
      }
    }
    this.shown = time;
    this.next = end;
    return { jumped, slices, next: history.at(end)?.captured ?? null };
  }
}
