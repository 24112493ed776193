// SPDX-License-Identifier: LGPL-2.1-or-later
// The scene: fresh points, the map, rings on the ground, the ellipse of the position, and a camera
// that orbits or follows the sensor.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { Ellipse } from './ellipse.js';
import { WorldMap } from './map.js';
import { FreshPoints } from './points.js';
import { isSoftware, Raster } from './raster.js';
import { Ruler } from './ruler.js';

const RINGS_M = [10, 20, 30, 40, 50];
const HOME = new THREE.Vector3(-27, -9, 24);
const LOOK = new THREE.Vector3(6, 0, -1);
const TURN = 0.08; // angle per key press [rad]
const DAMPING_MS = 330; // time in which the camera's motion decreases to about a third
const ZOOM = 0.88;

function rings() {
  const group = new THREE.Group();
  for (const radius of RINGS_M) {
    const corners = Array.from({ length: 129 }, (_, i) => {
      const a = (i / 128) * 2 * Math.PI;
      return new THREE.Vector3(radius * Math.cos(a), radius * Math.sin(a), 0);
    });
    const geometry = new THREE.BufferGeometry().setFromPoints(corners);
    group.add(new THREE.Line(geometry, new THREE.LineBasicMaterial({ transparent: true })));
  }
  const tip = [
    [1.6, 0],
    [-0.9, 0.75],
    [-0.5, 0],
    [-0.9, -0.75],
    [1.6, 0],
  ].map(([x, y]) => new THREE.Vector3(x, y, 0));
  const arrow = new THREE.Line(
    new THREE.BufferGeometry().setFromPoints(tip),
    new THREE.LineBasicMaterial(),
  );
  arrow.name = 'sensor';
  group.add(arrow);
  return group;
}

export class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    // Creates the context here. A context that three.js creates has an alpha channel, so the
    // browser would blend it with the page.
    const context = canvas.getContext('webgl2', { alpha: false, antialias: false, powerPreference: 'high-performance' });
    this.renderer = new THREE.WebGLRenderer({ canvas, context });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(55, 1, 0.1, 2000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.maxPolarAngle = Math.PI * 0.98;
    this.controls.addEventListener('change', () => (this.dirty = true));
    this.fresh = new FreshPoints();
    this.map = new WorldMap();
    this.rings = rings();
    this.ruler = new Ruler(this.fresh, this.camera, canvas);
    this.ellipse = new Ellipse();
    this.scene.add(this.rings, this.ellipse.object, this.ruler.object);
    const asked = new URLSearchParams(location.search).get('draw'); // raster or webgl
    if (asked === 'raster' || (asked !== 'webgl' && isSoftware(this.renderer.getContext()))) {
      this.raster = new Raster();
      this.scene.add(this.raster.object, this.map.line);
    } else {
      this.scene.add(this.map.object, this.fresh.object);
    }
    this.sensor = new THREE.Vector3();
    this.follow = true;
    this.frames = 0;
    this.drawnAt = performance.now();
    this.ground = -1.9;
    this.home();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  home() {
    this.camera.position.copy(HOME).add(this.sensor);
    this.controls.target.copy(LOOK).add(this.sensor);
    this.controls.update();
    this.dirty = true;
  }

  resize() {
    const { clientWidth: w, clientHeight: h } = this.canvas.parentElement;
    if (w === 0 || h === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(w, h, false);
    this.camera.aspect = w / h;
    // A tall window gets a larger vertical angle, because its horizontal angle would otherwise be
    // too small.
    this.camera.fov = w < h ? 80 : 55;
    this.camera.updateProjectionMatrix();
    this.raster?.resize(this.canvas.width, this.canvas.height);
    this.fresh.uniforms.scale.value = (h * this.renderer.getPixelRatio()) / 13;
    this.dirty = true;
  }

  setTheme(colors, mode, isDark) {
    this.scene.background = new THREE.Color(colors.ground);
    for (const line of this.rings.children) {
      line.material.color.set(line.name === 'sensor' ? colors.accent : colors.line);
      line.material.opacity = 0.8;
    }
    this.map.setColors(colors.map, colors.accent);
    this.ellipse.object.material.color.set(colors.accent);
    this.ruler.setColor(colors.text);
    this.setColors(mode, isDark);
    this.dirty = true;
  }

  setColors(mode, isDark) {
    this.fresh.setColors(mode, isDark);
    this.raster?.setColors(mode, isDark, this.scene.background);
  }

  /** Moves the sensor, and also the camera if it follows the sensor. */
  moveSensor(matrix) {
    const at = new THREE.Vector3().setFromMatrixPosition(matrix);
    if (this.follow) {
      const step = at.clone().sub(this.sensor);
      this.camera.position.add(step);
      this.controls.target.add(step);
    }
    this.sensor.copy(at);
    this.rings.quaternion.setFromRotationMatrix(matrix);
    this.dirty = true;
  }

  showMap(on) {
    this.map.object.visible = this.map.line.visible = on;
    this.dirty = true;
  }

  setFollow(on) {
    if (on && !this.follow) {
      const step = this.sensor.clone().add(LOOK).sub(this.controls.target);
      this.camera.position.add(step);
      this.controls.target.add(step);
    }
    this.follow = on;
    this.dirty = true;
  }

  /** Draws points. Adds them to the map if `isNew` is true. */
  add(points, time, matrix, place, isNew) {
    this.fresh.add(points, time, matrix, place);
    if (matrix) {
      this.moveSensor(matrix);
      if (isNew) this.map.add(points, matrix);
    }
    this.dirty = true;
  }

  /** Draws the ellipse of `covariance`, or no ellipse if it is null. */
  setCovariance(covariance) {
    this.ellipse.object.visible = covariance !== null;
    if (covariance) this.ellipse.set(covariance);
    this.dirty = true;
  }

  clear() {
    this.fresh.clear();
    this.map.clear();
    this.setCovariance(null);
    this.dirty = true;
  }

  /** Turns the camera by steps of TURN, and zooms by steps of ZOOM. */
  nudge(right, up, inwards) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const s = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    s.theta += right * TURN;
    s.phi = THREE.MathUtils.clamp(s.phi - up * TURN, 0.02, Math.PI * 0.98);
    s.radius = THREE.MathUtils.clamp(s.radius * ZOOM ** inwards, 1, 800);
    const v = new THREE.Vector3().setFromSpherical(s);
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3(v.x, -v.z, v.y));
    this.controls.update();
    this.dirty = true;
  }

  /** Makes the camera look down from above. */
  lookDown() {
    const { target } = this.controls;
    const height = this.camera.position.distanceTo(target);
    this.camera.position.set(target.x - 1e-3 * height, target.y, target.z + height);
    this.controls.update();
    this.dirty = true;
  }

  /** The positions of the camera and its target relative to the sensor, as six numbers. */
  get pose() {
    const { position } = this.camera;
    return [position, this.controls.target].flatMap((v) => v.clone().sub(this.sensor).toArray());
  }

  set pose(numbers) {
    this.camera.position.fromArray(numbers, 0).add(this.sensor);
    this.controls.target.fromArray(numbers, 3).add(this.sensor);
    this.controls.update();
    this.dirty = true;
  }

  /** Draws the scene if something has changed. Returns true if it was drawn. */
  draw() {
    // The damping depends on time instead of frames. At one frame per second, the camera would
    // otherwise keep turning for minutes.
    const now = performance.now();
    this.controls.dampingFactor = 1 - Math.exp((this.drawnAt - now) / DAMPING_MS);
    this.drawnAt = now;
    this.controls.update();
    if (!this.dirty) return false;
    this.dirty = false;
    this.rings.position.copy(this.sensor);
    this.rings.position.z += this.ground;
    this.ellipse.object.position.copy(this.rings.position);
    this.fresh.update();
    if (this.raster) {
      this.camera.updateMatrixWorld();
      this.raster.draw(this.fresh, this.map, this.camera);
    }
    this.renderer.render(this.scene, this.camera);
    this.fresh.drawn();
    this.map.drawn();
    ++this.frames;
    return true;
  }

  /** Returns the picture as a PNG. */
  picture() {
    this.dirty = true;
    this.draw();
    return new Promise((done) => this.canvas.toBlob(done, 'image/png'));
  }
}
