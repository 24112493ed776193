// SPDX-License-Identifier: LGPL-2.1-or-later
// The coded slices of the last minutes, in the order in which they came, and what shows them again.

const MOST_AHEAD_S = 1; // a later time is a jump
const PATIENCE_MS = 20; // until others have their turn

/** Slices are {captured, header, bytes, links, source}; `source` stands for their decoder. */
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

  /** In the order of time; the oldest go where there is no room, and what cannot be shown without them. */
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

  /** Capture times [s] of the oldest and of the newest; null where there is none. */
  get span() {
    return this.slices.length > 0 ? [this.slices[0].captured, this.slices.at(-1).captured] : null;
  }

  get end() {
    return this.first + this.slices.length;
  }
  at(number) {
    return this.slices[number - this.first];
  }

  /** The number of the first slice behind `time`. */
  after(time) {
    let [low, high] = [0, this.slices.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.slices[middle].captured <= time) low = middle + 1;
      else high = middle;
    }
    return this.first + low;
  }

  /** Where the scan before that of the slice before `number` begins: from there on the picture is whole. */
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

  /** What has to be decoded before `slice` by a decoder that has the blocks `known`, the oldest first. */
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

/** Decodes what a history has, by decoders of its own. */
export class Player {
  /** `open(source)` gives a Decoder; `pause()` lets others have their turn. */
  constructor(history, open, pause) {
    Object.assign(this, { history, open, pause });
    this.decoders = new Map();
    this.stop();
  }

  stop() {
    this.shown = null; // time
    this.next = 0; // number of the slice
    this.known = new Set(); // blocks that the decoders have
  }

  decode(slice) {
    const { source, links, bytes } = slice;
    if (!this.decoders.has(source)) this.decoders.set(source, this.open(source));
    for (const { name } of links) this.known.add(name);
    return this.decoders.get(source).decode(bytes);
  }

  /** Whether the slices up to `time` do not just follow what has been shown. */
  isJump(time) {
    const { shown, next, history } = this;
    return shown === null || time < shown || time > shown + MOST_AHEAD_S || next < history.first;
  }

  /**
   * {jumped, slices: [{slice, decoded}], next}: what is new in the picture at `time`, after a jump
   * all of it, and the time of the slice behind it. Null where `isWanted()` ends meanwhile.
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
