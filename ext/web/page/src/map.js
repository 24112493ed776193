// SPDX-License-Identifier: LGPL-2.1-or-later
// The map that the poses of odometry give, with one point per cube of CUBE_M, and the path of the
// sensor.
import * as THREE from 'three';
import { FLOATS } from './fields.js';

const CAPACITY = 600_000;
const CUBE_M = 0.4;
const EVERY = 3; // every third point is enough, because a few scans fill the map anyway
const MOST_STEPS = 20_000;
const STEP_M = 0.2;

export class WorldMap {
  constructor() {
    this.positions = new Float32Array(CAPACITY * 3);
    const geometry = new THREE.BufferGeometry();
    this.attribute = new THREE.BufferAttribute(this.positions, 3).setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute('position', this.attribute);
    this.material = new THREE.PointsMaterial({ size: 1.4, sizeAttenuation: false, transparent: true });
    this.points = new THREE.Points(geometry, this.material);
    this.points.frustumCulled = false;
    const way = new THREE.BufferGeometry();
    this.way = new THREE.BufferAttribute(new Float32Array(MOST_STEPS * 3), 3);
    way.setAttribute('position', this.way.setUsage(THREE.DynamicDrawUsage));
    this.line = new THREE.Line(way, new THREE.LineBasicMaterial({ transparent: true }));
    this.line.frustumCulled = false;
    this.object = new THREE.Group();
    this.object.add(this.points, this.line);
    this.clear();
  }

  clear() {
    this.cubes = new Set();
    this.count = 0;
    this.steps = 0;
    this.points.geometry.setDrawRange(0, 0);
    this.line.geometry.setDrawRange(0, 0);
  }

  setColors(point, line) {
    this.material.color.set(point);
    this.line.material.color.set(line);
  }

  add(points, matrix) {
    const m = matrix.elements;
    const before = this.count;
    for (let from = 0; from < points.length && this.count < CAPACITY; from += FLOATS * EVERY) {
      const x = points[from];
      const y = points[from + 1];
      const z = points[from + 2];
      this.addPoint(
        m[0] * x + m[4] * y + m[8] * z + m[12],
        m[1] * x + m[5] * y + m[9] * z + m[13],
        m[2] * x + m[6] * y + m[10] * z + m[14],
      );
    }
    if (this.count > before) {
      this.attribute.addUpdateRange(before * 3, (this.count - before) * 3);
      this.attribute.needsUpdate = true;
      this.points.geometry.setDrawRange(0, this.count);
    }
    this.addStep(m[12], m[13], m[14]);
  }

  addPoint(x, y, z) {
    const i = Math.floor(x / CUBE_M) & 0x1ffff;
    const j = Math.floor(y / CUBE_M) & 0x1ffff;
    const k = Math.floor(z / CUBE_M) & 0xffff;
    const cube = (i * 0x20000 + j) * 0x10000 + k;
    if (this.cubes.has(cube)) return;
    this.cubes.add(cube);
    const at = this.count++ * 3;
    this.positions[at] = x;
    this.positions[at + 1] = y;
    this.positions[at + 2] = z;
  }

  addStep(x, y, z) {
    const { array } = this.way;
    const at = this.steps * 3;
    if (this.steps >= MOST_STEPS) return;
    const moved =
      this.steps === 0 || Math.hypot(x - array[at - 3], y - array[at - 2], z - array[at - 1]) > STEP_M;
    if (!moved) return;
    array.set([x, y, z], at);
    this.way.addUpdateRange(at, 3);
    this.way.needsUpdate = true;
    this.line.geometry.setDrawRange(0, ++this.steps);
  }

  drawn() {
    this.attribute.clearUpdateRanges();
    this.way.clearUpdateRanges();
  }
}
