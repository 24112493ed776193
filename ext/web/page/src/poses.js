// SPDX-License-Identifier: LGPL-2.1-or-later
// Where each frame was: the newest transforms, found by their time.
import { Matrix4, Quaternion, Vector3 } from 'three';

const KEPT = 256;

export class Poses {
  constructor() {
    this.frames = new Map(); // child frame to transforms, the oldest first
  }

  add({ time, child, position, rotation }) {
    if (!this.frames.has(child)) this.frames.set(child, []);
    const list = this.frames.get(child);
    const matrix = new Matrix4().compose(
      new Vector3(...position),
      new Quaternion(...rotation).normalize(),
      new Vector3(1, 1, 1),
    );
    list.push({ time, matrix });
    if (list.length > KEPT) list.shift();
  }

  /** The transform nearest in time, or null where the frame has none. */
  at(frame, time) {
    const list = this.frames.get(frame);
    if (!list?.length) return null;
    let best = list[list.length - 1];
    for (let i = list.length - 1; i >= 0; --i) {
      if (Math.abs(list[i].time - time) > Math.abs(best.time - time)) break;
      best = list[i];
    }
    return best.matrix;
  }

  clear() {
    this.frames.clear();
  }
}
