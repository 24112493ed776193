// SPDX-License-Identifier: LGPL-2.1-or-later
// The transforms of each frame. Transforms between two poses are interpolated. Transforms after the
// newest pose are extrapolated, because slices arrive before the pose of their scan. Nothing is
// interpolated between poses before and after a loss of the connection.
import { Matrix4, Quaternion, Vector3 } from 'three';

const KEPT = 1 << 14; // half an hour at 10 Hz, which is longer than slices are kept
const MOST_AHEAD_S = 0.5;
const ONE = new Vector3(1, 1, 1);

export class Poses {
  constructor() {
    this.frames = new Map(); // lists of transforms by child frame, each with the oldest first
    this.begun = 0; // number of losses of the connection
  }

  /** Ends the series of transforms. Later transforms do not continue it. */
  end() {
    ++this.begun;
  }

  add({ time, child, position, rotation }) {
    if (!this.frames.has(child)) this.frames.set(child, []);
    const list = this.frames.get(child);
    const isNew = list.at(-1)?.begun !== this.begun;
    while (isNew && list.length > 0 && list.at(-1).time >= time) list.pop();
    if (list.length > 0 && time <= list.at(-1).time) return;
    list.push({
      time,
      begun: this.begun,
      position: new Vector3(...position),
      rotation: new Quaternion(...rotation).normalize(),
    });
    if (list.length > KEPT) list.shift();
  }

  /** Returns the transform of `frame` at `time` [s], or null if there is none. */
  at(frame, time) {
    const list = this.frames.get(frame) ?? [];
    if (list.length === 0) return null;
    const after = list.findLastIndex((pose) => pose.time <= time) + 1;
    let i = Math.min(Math.max(after, 1), list.length - 1);
    const isGap = i > 0 && list[i - 1].begun !== list[i].begun;
    if (isGap && time - list[i - 1].time < list[i].time - time) --i;
    const b = list[i];
    if (time > b.time && b.begun !== this.begun) return null;
    const a = list[i - 1]?.begun === b.begun ? list[i - 1] : b;
    const until = Math.min(time, b.time + MOST_AHEAD_S);
    const share = b.time > a.time ? Math.max((until - a.time) / (b.time - a.time), 0) : 1;
    return new Matrix4().compose(
      a.position.clone().lerp(b.position, share),
      a.rotation.clone().slerp(b.rotation, share),
      ONE,
    );
  }
}
