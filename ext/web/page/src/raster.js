// SPDX-License-Identifier: LGPL-2.1-or-later
// Draws points on the CPU, for browsers without a graphics card. Their WebGL needs half a
// microsecond per point, and this code a tenth of that. The picture is behind everything that WebGL
// draws.
import * as THREE from 'three';
import { rampOf, texels } from './palette.js';
import { STRIDE } from './points.js';

const VALUES = { height: 2, intensity: 3, range: 5, beam: 4 }; // indices of floats in a point
const MOST_PX = 6;
const LEAST_PX = 1.6;
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Returns true if `gl` draws on the CPU. */
export function isSoftware(gl) {
  const about = gl.getParameter(gl.RENDERER) === 'WebKit WebGL' && gl.getExtension('WEBGL_debug_renderer_info');
  return SOFTWARE.test(gl.getParameter(about ? about.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}

const packed = (r, g, b) => (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
const packedColor = (color) => {
  const hex = color.getHex(THREE.SRGBColorSpace);
  return packed(hex >> 16, (hex >> 8) & 255, hex & 255);
};

export class Raster {
  constructor() {
    const material = new THREE.ShaderMaterial({
      uniforms: { picture: { value: null } },
      vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }',
      fragmentShader:
        'uniform sampler2D picture; varying vec2 at; void main() { gl_FragColor = texture2D(picture, at); }',
      depthTest: false,
      depthWrite: false,
    });
    this.object = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material);
    this.object.frustumCulled = false;
    this.object.renderOrder = -1;
    this.table = new Uint32Array(256);
  }

  resize(width, height) {
    if (this.width === width && this.height === height) return;
    Object.assign(this, { width, height });
    this.pixels = new Uint32Array(width * height);
    this.depths = new Float32Array(width * height);
    this.texture?.dispose();
    this.texture = new THREE.DataTexture(new Uint8Array(this.pixels.buffer), width, height);
    this.object.material.uniforms.picture.value = this.texture;
  }

  setColors(mode, isDark, ground) {
    this.mode = mode;
    this.ramp = texels(rampOf(mode, isDark));
    this.ground = packedColor(ground);
  }

  /**
   * Draws the points of `fresh` and `map` as `camera` sees them. A point is about `scale /
   * distance` pixels wide.
   */
  draw(fresh, map, camera) {
    this.pixels.fill(this.ground);
    this.depths.fill(Infinity);
    const matrix = new THREE.Matrix4();
    matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    if (map.object.visible && map.count > 0) {
      this.table.fill(packedColor(map.material.color));
      this.splat(map.positions, { from: 0, count: map.count, stride: 3, value: 2 }, matrix.elements, [0, 0, 0, 0, 1e9]);
    }
    const { now, low, high, scale, floor, ceiling } = fresh.uniforms;
    const root = this.mode === 'intensity';
    const gain = 255 / Math.max(high.value - low.value, 1e-6);
    const look = [scale.value, low.value, gain, floor.value, ceiling.value];
    for (const { start, count, stamp } of fresh.batches) {
      const age = now.value - stamp;
      if (age > fresh.uniforms.hidden.value) continue;
      this.tint(fresh.uniforms, age);
      const value = VALUES[this.mode] ?? 2;
      for (const [from, n] of fresh.spans(start, count))
        this.splat(fresh.data, { from, count: n, stride: STRIDE, value, root }, matrix.elements, look);
    }
    this.texture.needsUpdate = true;
  }

  /** Fills the table of colours for points whose age is `age` [s]. */
  tint({ span, glow, low, high }, age) {
    const fresh = Math.min(Math.max(1 - age / span.value, 0), 1);
    const bright = glow.value > 0.5 ? 0.62 + 0.38 * fresh * fresh : 1;
    const share = (age * 1000 - low.value) / Math.max(high.value - low.value, 1e-6);
    const only = this.mode === 'age' ? Math.round(255 * Math.min(Math.max(share, 0), 1)) : -1;
    for (let i = 0; i < 256; ++i) {
      const at = 4 * (only < 0 ? i : only);
      this.table[i] = packed(this.ramp[at] * bright, this.ramp[at + 1] * bright, this.ramp[at + 2] * bright);
    }
  }

  splat(data, { from, count, stride, value, root = false }, e, [scale, low, gain, floor, ceiling]) {
    const { width, height, pixels, depths, table } = this;
    const [halfWidth, halfHeight] = [width / 2, height / 2];
    for (let i = 0, at = from * stride; i < count; ++i, at += stride) {
      const x = data[at];
      const y = data[at + 1];
      const z = data[at + 2];
      if (scale > 0 && (z < floor || z > ceiling)) continue;
      const w = e[3] * x + e[7] * y + e[11] * z + e[15];
      if (w <= 0.1) continue;
      const size = Math.min(Math.max(scale / w, LEAST_PX), MOST_PX);
      const px = (((e[0] * x + e[4] * y + e[8] * z + e[12]) / w + 1) * halfWidth - size / 2 + 0.5) | 0;
      const py = (((e[1] * x + e[5] * y + e[9] * z + e[13]) / w + 1) * halfHeight - size / 2 + 0.5) | 0;
      const side = (size + 0.5) | 0;
      if (px < 0 || py < 0 || px + side > width || py + side > height) continue;
      let share = (data[at + value] - low) * gain;
      if (root) share = 15.97 * Math.sqrt(Math.max(share, 0));
      const color = table[share < 0 ? 0 : share > 255 ? 255 : share | 0];
      for (let row = py * width + px, end = row + side * width; row < end; row += width) {
        for (let pixel = row; pixel < row + side; ++pixel) {
          if (depths[pixel] <= w) continue;
          depths[pixel] = w;
          pixels[pixel] = color;
        }
      }
    }
  }
}
