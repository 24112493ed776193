// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures the distance between two points that the user chooses in the picture.
import * as THREE from 'three';

const REACH_PX = 24; // largest distance from a click to the chosen point
const MOST_MOVED_PX = 6; // a longer drag turns the camera instead

export class Ruler {
  /** Calls `onChange({points, distance, rise})` after each choice. */
  constructor(fresh, camera, canvas) {
    Object.assign(this, { fresh, camera, canvas });
    this.ends = new THREE.BufferAttribute(new Float32Array(6), 3);
    const geometry = new THREE.BufferGeometry().setAttribute('position', this.ends);
    const line = new THREE.LineBasicMaterial({ depthTest: false });
    const dots = new THREE.PointsMaterial({ size: 9, sizeAttenuation: false, depthTest: false });
    this.object = new THREE.Group();
    this.object.add(new THREE.Line(geometry, line), new THREE.Points(geometry, dots));
    for (const part of this.object.children) part.frustumCulled = false;
    this.object.renderOrder = 1;
    this.isOn = false;
    canvas.addEventListener('pointerdown', ({ clientX, clientY }) => (this.down = [clientX, clientY]));
    canvas.addEventListener('pointerup', (event) => this.choose(event));
    this.set([]);
  }

  setColor(color) {
    for (const part of this.object.children) part.material.color.set(color);
  }

  turn(on) {
    this.isOn = on;
    this.set([]);
  }

  choose({ clientX, clientY }) {
    if (!this.isOn || !this.down) return;
    if (Math.hypot(clientX - this.down[0], clientY - this.down[1]) > MOST_MOVED_PX) return;
    const box = this.canvas.getBoundingClientRect();
    const point = this.fresh.nearest(this.camera, box, [clientX - box.left, clientY - box.top], REACH_PX);
    if (!point) return;
    this.set(this.points.length === 1 ? [this.points[0], point] : [point]);
  }

  set(points) {
    this.points = points;
    this.object.visible = points.length > 0;
    points.forEach((p, i) => this.ends.setXYZ(i, ...p));
    if (points.length === 1) this.ends.setXYZ(1, ...points[0]);
    this.ends.needsUpdate = true;
    const [a, b] = points;
    this.onChange?.({
      points,
      distance: b ? Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) : null,
      rise: b ? b[2] - a[2] : null,
    });
  }
}
