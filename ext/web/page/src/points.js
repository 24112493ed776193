// SPDX-License-Identifier: LGPL-2.1-or-later
// The points of the last scans in a ring buffer on the graphics card, where a shader colours them.
import * as THREE from 'three';
import { FLOATS } from './fields.js';
import { MODES, rampOf, texels } from './palette.js';

const CAPACITY = 1 << 19; // room for two scans of the largest sensors
export const STRIDE = FLOATS + 1; // the last float is the time
const FOR_EVER_S = 1e6;
export const NO_CLIP = 1e6;

const vertexShader = `
attribute vec4 rest;   // intensity, beam, range, time
uniform float now, span, hidden, mode, low, high, scale, floor, ceiling;
varying float vValue, vFresh, vSize;
void main() {
  float age = now - rest.w;
  float value = mode < 0.5 ? position.z : mode < 1.5 ? rest.x : mode < 2.5 ? rest.z
              : mode < 3.5 ? rest.y : age * 1000.0;
  vValue = clamp((value - low) / max(high - low, 1e-6), 0.0, 1.0);
  if (mode > 0.5 && mode < 1.5) vValue = sqrt(vValue);
  vFresh = clamp(1.0 - age / span, 0.0, 1.0);
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  bool isOut = age < -1e-4 || age > hidden || position.z < floor || position.z > ceiling;
  gl_Position = isOut ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * view;
  vSize = clamp(scale / -view.z, 1.6, 6.0);
  gl_PointSize = vSize;
}`;

const fragmentShader = `
uniform sampler2D ramp;
uniform float glow;
varying float vValue, vFresh, vSize;
void main() {
  vec2 corner = gl_PointCoord - 0.5;
  if (vSize > 2.5 && dot(corner, corner) > 0.25) discard; // near points are round
  vec3 color = texture2D(ramp, vec2(vValue, 0.5)).rgb;
  // What the sensor has just seen is brightest: the sweep shows.
  float bright = glow > 0.5 ? 0.62 + 0.38 * vFresh * vFresh : 1.0;
  gl_FragColor = vec4(color * bright, 1.0);
}`;

export class FreshPoints {
  constructor() {
    this.data = new Float32Array(CAPACITY * STRIDE);
    this.isTrail = false;
    this.buffer = new THREE.InterleavedBuffer(this.data, STRIDE).setUsage(THREE.DynamicDrawUsage);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(this.buffer, 3, 0));
    geometry.setAttribute('rest', new THREE.InterleavedBufferAttribute(this.buffer, 4, 3));
    const ramp = new THREE.DataTexture(new Uint8Array(1024), 256, 1);
    ramp.magFilter = ramp.minFilter = THREE.LinearFilter;
    this.uniforms = {
      now: { value: 0 },
      span: { value: 0.1 }, // age at which a point no longer glows [s]
      hidden: { value: 0.1 }, // age at which a point disappears [s]
      floor: { value: -NO_CLIP },
      ceiling: { value: NO_CLIP },
      mode: { value: 0 },
      low: { value: -2 },
      high: { value: 6 },
      scale: { value: 60 },
      ramp: { value: ramp },
      glow: { value: 1 },
    };
    const material = new THREE.ShaderMaterial({
      uniforms: this.uniforms,
      vertexShader,
      fragmentShader,
    });
    // Two objects draw the ring, because the points may wrap around its end.
    this.parts = [geometry, geometry.clone()].map((part) => {
      for (const name of ['position', 'rest']) part.setAttribute(name, geometry.getAttribute(name));
      const points = new THREE.Points(part, material);
      points.frustumCulled = false;
      return points;
    });
    this.object = new THREE.Group();
    this.object.add(...this.parts);
    this.clear();
  }

  clear() {
    this.next = 0;
    this.batches = []; // {start, count, stamp, place}, the oldest first
    this.scan = this.scanBefore = undefined; // numbers of the last two scans, for slices
    this.epoch = null; // the time that is 0 in the floats [s]
    this.latest = 0;
    for (const part of this.parts) part.geometry.setDrawRange(0, 0);
  }

  /** The number of points that are drawn. */
  get count() {
    return this.parts.reduce((sum, part) => sum + part.geometry.drawRange.count, 0);
  }

  /** The capture time of the newest point [s], or null if there are no points. */
  get time() {
    return this.epoch === null ? null : this.epoch + this.latest;
  }

  /**
   * Adds `points`, in the layout of fields.js, that were captured at `time` [s]. Applies `matrix`
   * to them unless it is null. A slice has a `place`, {scan, slice, slices}, and is shown until the
   * next scan covers the place.
   */
  add(points, time, matrix, place = null) {
    const count = Math.min(points.length / FLOATS, CAPACITY);
    if (this.epoch === null || time - this.epoch > 3600 || time < this.epoch) {
      this.clear();
      this.epoch = time;
    }
    const stamp = time - this.epoch;
    this.latest = Math.max(this.latest, stamp);
    const m = matrix?.elements;
    const { data } = this;
    const start = this.next;
    for (let i = 0, from = 0; i < count; ++i, from += FLOATS) {
      const to = ((start + i) % CAPACITY) * STRIDE;
      const x = points[from];
      const y = points[from + 1];
      const z = points[from + 2];
      data[to] = m ? m[0] * x + m[4] * y + m[8] * z + m[12] : x;
      data[to + 1] = m ? m[1] * x + m[5] * y + m[9] * z + m[13] : y;
      data[to + 2] = m ? m[2] * x + m[6] * y + m[10] * z + m[14] : z;
      data[to + 3] = points[from + 3];
      data[to + 4] = points[from + 4];
      data[to + 5] = points[from + 5];
      data[to + 6] = stamp;
    }
    this.markDirty(start, count);
    this.next = (start + count) % CAPACITY;
    this.batches.push({ start, count, stamp, place });
    if (place && place.scan !== this.scan) [this.scanBefore, this.scan] = [this.scan, place.scan];
    this.applySpan(place !== null);
    this.forget();
  }

  /** Returns true if a batch is too old, or if slices of the next scan cover its place. */
  isOver({ stamp, place }) {
    if (!place || this.isTrail) return stamp < this.latest - this.uniforms.hidden.value;
    if (place.scan === this.scan) return false;
    const newest = this.batches[this.batches.length - 1].place;
    if (place.scan !== this.scanBefore || !newest) return true;
    return (place.slice + 1) * newest.slices <= (newest.slice + 1) * place.slices;
  }

  /** Drops batches that are too old or covered, or that new points in the ring have overwritten. */
  forget() {
    const { batches } = this;
    let held = batches.reduce((sum, batch) => sum + batch.count, 0);
    while (batches.length > 1 && (held > CAPACITY || this.isOver(batches[0])))
      held -= batches.shift().count;
    const start = batches.length ? batches[0].start : 0;
    const first = Math.min(held, CAPACITY - start);
    this.parts[0].geometry.setDrawRange(start, first);
    this.parts[1].geometry.setDrawRange(0, held - first);
  }

  /** Marks the new points, so that only they are copied to the graphics card. */
  markDirty(start, count) {
    const end = Math.min(start + count, CAPACITY);
    this.buffer.addUpdateRange(start * STRIDE, (end - start) * STRIDE);
    if (start + count > CAPACITY) this.buffer.addUpdateRange(0, (start + count - CAPACITY) * STRIDE);
    this.buffer.needsUpdate = true;
  }

  /**
   * Returns the parts [[from, count]] of the ring that contain `count` points from `start` on.
   * There are two parts if the points wrap around the end.
   */
  spans(start, count) {
    const first = Math.min(count, CAPACITY - start);
    return first < count ? [[start, first], [0, count - first]] : [[start, count]];
  }

  /** Calls `visit(offset in data)` for each drawn point. */
  each(visit) {
    const { floor, ceiling } = this.uniforms;
    for (const { start, count } of this.batches) {
      for (let i = 0; i < count; ++i) {
        const at = ((start + i) % CAPACITY) * STRIDE;
        const z = this.data[at + 2];
        if (z >= floor.value && z <= ceiling.value) visit(at);
      }
    }
  }

  /**
   * Returns the drawn point that is nearest to the pixel `[x, y]` of a picture of `width` by
   * `height` pixels. Returns null if no point is within `reach` pixels.
   */
  nearest(camera, { width, height }, [x, y], reach) {
    const e = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
    const { data } = this;
    let [best, found] = [reach * reach, null];
    this.each((at) => {
      const [px, py, pz] = [data[at], data[at + 1], data[at + 2]];
      const w = e[3] * px + e[7] * py + e[11] * pz + e[15];
      if (w <= 0) return;
      const dx = ((e[0] * px + e[4] * py + e[8] * pz + e[12]) / w + 1) * 0.5 * width - x;
      const dy = (1 - (e[1] * px + e[5] * py + e[9] * pz + e[13]) / w) * 0.5 * height - y;
      if (dx * dx + dy * dy >= best) return;
      best = dx * dx + dy * dy;
      found = [px, py, pz];
    });
    return found;
  }

  /** Must be called after each frame. */
  drawn() {
    this.buffer.clearUpdateRanges();
  }

  setColors(mode, isDark) {
    this.uniforms.mode.value = Object.keys(MODES).indexOf(mode);
    this.uniforms.glow.value = isDark && mode !== 'age' ? 1 : 0;
    const { value: ramp } = this.uniforms.ramp;
    ramp.image.data.set(texels(rampOf(mode, isDark)));
    ramp.needsUpdate = true;
  }

  setScale(low, high) {
    this.uniforms.low.value = low;
    this.uniforms.high.value = high;
  }

  /** Sets how long [s] points without a place are shown. In a trail, this applies to all points. */
  setSpan(span, isTrail) {
    this.uniforms.span.value = span;
    this.isTrail = isTrail;
    this.applySpan(this.batches[this.batches.length - 1]?.place);
  }

  applySpan(hasPlaces) {
    this.uniforms.hidden.value = hasPlaces && !this.isTrail ? FOR_EVER_S : this.uniforms.span.value;
  }

  /** Draws only points between the heights `floor` and `ceiling` [m]. */
  setClip(floor, ceiling) {
    this.uniforms.floor.value = floor;
    this.uniforms.ceiling.value = ceiling;
  }

  update() {
    this.uniforms.now.value = this.latest;
  }
}
