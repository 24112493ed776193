// SPDX-License-Identifier: LGPL-2.1-or-later
// Where each frame was and is: the newest transforms, and between and behind them what steady motion
// gives, since slices come before the pose of their scan. A server that comes back begins anew.
import { Matrix4, Quaternion, Vector3 } from 'three';

const KEPT = 1 << 14; // half an hour: what is shown again has its poses
const MOST_AHEAD_S = 0.5;
const ONE = new Vector3(1, 1, 1);

export class Poses {
  constructor() {
    this.frames = new Map(); // child frame to transforms, the oldest first
    this.begun = 0; // times that a server came
  }

  /** What comes now has nothing to do with what came. */
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

  /** The transform at a time, or null where the frame has none. */
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
