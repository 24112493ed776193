// SPDX-License-Identifier: LGPL-2.1-or-later
// An ellipse that shows the horizontal uncertainty of the sensor's position, as three standard
// deviations.
import * as THREE from 'three';

const SIGMAS = 3;
const CORNERS = 64;

/**
 * Returns the points of the ellipse around 0 as x, y, 0. `covariance` is the covariance in
 * lidar.Statistics.
 */
export function ellipseOf(covariance) {
  const [xx, xy, yy] = [0, 1, 7].map((i) => covariance[i]);
  // The Cholesky factor of the covariance transforms a circle into the ellipse.
  const a = Math.sqrt(xx);
  const b = a > 0 ? xy / a : 0;
  const c = Math.sqrt(Math.max(yy - b * b, 0));
  return Array.from({ length: CORNERS + 1 }, (_, i) => {
    const turn = (i / CORNERS) * 2 * Math.PI;
    const [u, v] = [SIGMAS * Math.cos(turn), SIGMAS * Math.sin(turn)];
    return [a * u, b * u + c * v, 0];
  }).flat();
}

export class Ellipse {
  constructor() {
    this.geometry = new THREE.BufferGeometry();
    this.corners = new THREE.BufferAttribute(new Float32Array((CORNERS + 1) * 3), 3);
    this.geometry.setAttribute('position', this.corners);
    this.object = new THREE.Line(this.geometry, new THREE.LineBasicMaterial());
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  set(covariance) {
    this.corners.array.set(ellipseOf(covariance));
    this.corners.needsUpdate = true;
  }
}
