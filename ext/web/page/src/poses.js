// SPDX-License-Identifier: LGPL-2.1-or-later
// Where each frame was and is: the newest transforms, and between and behind them what steady motion
// gives, since slices come before the pose of their scan.
import { Matrix4, Quaternion, Vector3 } from 'three';

const KEPT = 256;
const MOST_AHEAD_S = 0.5;
const ONE = new Vector3(1, 1, 1);

export class Poses {
  constructor() {
    this.frames = new Map(); // child frame to transforms, the oldest first
  }

  add({ time, child, position, rotation }) {
    if (!this.frames.has(child)) this.frames.set(child, []);
    const list = this.frames.get(child);
    if (list.length > 0 && time <= list[list.length - 1].time) return;
    list.push({
      time,
      position: new Vector3(...position),
      rotation: new Quaternion(...rotation).normalize(),
    });
    if (list.length > KEPT) list.shift();
  }

  /** The transform at a time, or null where the frame has none. */
  at(frame, time) {
    const list = this.frames.get(frame);
    if (!list?.length) return null;
    let i = list.length - 1;
    while (i > 1 && list[i - 1].time > time) --i;
    const b = list[i];
    const a = list[Math.max(i - 1, 0)];
    const until = Math.min(time, b.time + MOST_AHEAD_S);
    const share = b.time > a.time ? Math.max((until - a.time) / (b.time - a.time), 0) : 1;
    return new Matrix4().compose(
      a.position.clone().lerp(b.position, share),
      a.rotation.clone().slerp(b.rotation, share),
      ONE,
    );
  }

  clear() {
    this.frames.clear();
  }
}
