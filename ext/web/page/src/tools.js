// SPDX-License-Identifier: LGPL-2.1-or-later
// The controls: colours, camera, ruler, clip, pause, charts, theme. The address of the page stores
// them.
import { FLOATS } from './fields.js';
import { MODES, rampOf, texels } from './palette.js';
import { NO_CLIP } from './points.js';
import { number, t } from './text.js';

const TRAIL_S = 1;
const SHARE_MS = 400; // delay between the last change and the update of the address
const NARROW = '(max-width: 760px)';

const byId = (id) => document.getElementById(id);
const stored = (key) => {
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
};

/** Returns the 2nd and the 98th percentile of the values. */
function middle(values) {
  if (values.length === 0) return [0, 1];
  values.sort();
  const at = (share) => values[Math.floor(share * (values.length - 1))];
  return [at(0.02), at(0.98)];
}

class Tools {
  constructor(page) {
    this.page = page;
    this.mode = 'height';
    this.scales = { height: [-2, 6], intensity: [0, 1], range: [0, 50], beam: [0, 127], age: [0, 100] };
    this.known = { intensity: true, beam: true };
    this.theme = stored('theme') ?? 'system';
    this.learned = 0;
    this.makeColors();
    this.makeButtons();
    this.makeClip();
    this.makeRuler();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.applyTheme());
    this.setPanel(!matchMedia(NARROW).matches);
    this.applyTheme();
    addEventListener('keydown', (event) => this.onKey(event));
    this.readAddress();
    page.scene.controls.addEventListener('end', () => this.share());
  }

  // --- colours ---

  makeColors() {
    const group = byId('colors');
    for (const mode of Object.keys(MODES)) {
      const button = document.createElement('button');
      button.textContent = t(mode);
      button.dataset.mode = mode;
      button.setAttribute('role', 'radio');
      button.onclick = () => {
        this.setMode(mode);
        this.share();
      };
      group.append(button);
    }
    group.addEventListener('keydown', (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      const buttons = [...group.children].filter((b) => !b.disabled);
      const next = buttons[(buttons.indexOf(document.activeElement) + step + buttons.length) % buttons.length];
      next.focus();
      next.click();
    });
  }

  setMode(mode) {
    this.mode = mode;
    for (const button of byId('colors').children) {
      const chosen = button.dataset.mode === mode;
      button.setAttribute('aria-checked', chosen);
      button.tabIndex = chosen ? 0 : -1;
      button.disabled = this.known[button.dataset.mode] === false;
    }
    this.page.scene.setColors(mode, this.isDark);
    this.applyScale();
  }

  applyScale() {
    const [low, high] = this.scales[this.mode];
    this.page.scene.fresh.setScale(low, high);
    this.page.scene.dirty = true;
    const { unit } = MODES[this.mode];
    const legend = byId('legend');
    legend.querySelector('figcaption').textContent = t(this.mode) + (unit ? ` [${unit}]` : '');
    const round = (v) => number(v, Math.abs(v) < 10 && v % 1 ? 1 : 0);
    [low, high].forEach((v, i) => (legend.querySelectorAll('span')[i].textContent = round(v)));
    const context = legend.querySelector('canvas').getContext('2d');
    const pixels = texels(rampOf(this.mode, this.isDark));
    context.putImageData(new ImageData(new Uint8ClampedArray(pixels), 256, 1), 0, 0);
  }

  /**
   * Adapts the scales of the colours to the points. Adapts them slowly, so that colours keep their
   * meaning.
   */
  learn(points, has) {
    if (has.intensity !== this.known.intensity || has.beam !== this.known.beam) {
      this.known = has;
      this.setMode(this.known[this.mode] === false ? 'height' : this.mode);
    }
    const now = performance.now();
    if (points.length === 0 || now - this.learned < 1000) return;
    this.learned = now;
    const count = points.length / FLOATS;
    const every = Math.max(1, Math.floor(count / 2000));
    const columns = { height: 2, intensity: 3, range: 5 };
    for (const [mode, column] of Object.entries(columns)) {
      const values = [];
      for (let i = 0; i < count; i += every) values.push(points[i * FLOATS + column]);
      const found = middle(new Float32Array(values));
      const kept = this.scales[mode];
      const first = this.seen !== true;
      this.scales[mode] = kept.map((v, i) => (first ? found[i] : v + 0.2 * (found[i] - v)));
    }
    this.scales.range[0] = this.scales.intensity[0] = 0;
    // Each slice has points of all beams, so the largest number is the number of the last beam.
    let beam = this.seen ? this.scales.beam[1] : 1;
    for (let i = 4; i < points.length; i += FLOATS * 7) beam = Math.max(beam, points[i]);
    this.scales.beam[1] = beam;
    const ground = this.scales.height[0];
    if (!this.page.hasPoses) this.page.scene.ground = ground;
    this.seen = true;
    this.applyScale();
  }

  // --- time ---

  /** Sets how long points are shown: for the time of a scan, or of a trail. */
  setSpan() {
    const trail = byId('trail').getAttribute('aria-pressed') === 'true';
    const span = trail ? TRAIL_S : this.page.spanS * 0.995;
    this.page.scene.fresh.setSpan(span, trail);
    this.scales.age[1] = Math.round(span * 1000);
    if (this.mode === 'age') this.applyScale();
    this.page.scene.dirty = true;
  }

  hasPoses(yes) {
    if (this.page.hasPoses === yes) return;
    this.page.hasPoses = yes;
    byId('map').disabled = byId('follow').disabled = !yes;
  }

  // --- buttons ---

  toggle(id, on) {
    byId(id).setAttribute('aria-pressed', on);
    return on;
  }

  isOn(id) {
    return byId(id).getAttribute('aria-pressed') === 'true';
  }

  makeButtons() {
    const { page } = this;
    byId('map').disabled = byId('follow').disabled = true;
    const actions = {
      follow: () => page.scene.setFollow(this.toggle('follow', !this.isOn('follow'))),
      map: () => page.scene.showMap(this.toggle('map', !this.isOn('map'))),
      trail: () => {
        this.toggle('trail', !this.isOn('trail'));
        this.setSpan();
      },
      measure: () => page.scene.ruler.turn(this.toggle('measure', !this.isOn('measure'))),
      top: () => page.scene.lookDown(),
      pause: () => {
        page.paused = this.toggle('pause', !this.isOn('pause'));
        page.choose();
        page.showState();
      },
      snapshot: () => this.snapshot(),
      panel: () => this.setPanel(!this.isOn('panel')),
      live: () => {
        if (page.paused) byId('pause').click();
        page.timeline.live();
      },
      more: () => this.setSheet(document.body.dataset.sheet === 'closed'),
      theme: () => this.nextTheme(),
    };
    for (const [id, action] of Object.entries(actions)) byId(id).onclick = () => {
        action();
        this.share();
      };
  }

  // --- ruler and clip ---

  makeRuler() {
    const text = byId('distance');
    this.page.scene.ruler.onChange = ({ points, distance, rise }) => {
      this.page.scene.dirty = true;
      text.hidden = !this.isOn('measure');
      if (distance !== null) text.textContent = `${number(distance, 2)} m  (Δz ${number(rise, 2)} m)`;
      else text.textContent = t(points.length ? 'measure_second' : 'measure_first');
    };
  }

  makeClip() {
    const inputs = [byId('clip_low'), byId('clip_high')];
    this.clip = inputs;
    for (const input of inputs) {
      input.oninput = () => this.applyClip();
      input.onchange = () => this.share();
    }
    this.applyClip();
  }

  /** Applies the sliders of the clip. A slider at its end does not clip. */
  applyClip() {
    const [low, high] = this.clip.map((input) => Number(input.value));
    const isEnd = [low <= Number(this.clip[0].min), high >= Number(this.clip[1].max)];
    this.page.scene.fresh.setClip(isEnd[0] ? -NO_CLIP : low, isEnd[1] ? NO_CLIP : high);
    this.page.scene.dirty = true;
    [low, high].forEach((value, i) => {
      this.clip[i].parentElement.querySelector('output').textContent = isEnd[i] ? '–' : number(value, 1);
    });
  }

  // --- robots ---

  setRobots(robots) {
    const select = byId('robot');
    select.hidden = robots.length < 2;
    if (`${robots}` === `${this.robots}`) return;
    this.robots = robots;
    select.replaceChildren(...robots.map((name) => new Option(name, name)));
    if (robots.includes(this.page.robot)) select.value = this.page.robot;
    select.onchange = () => {
      this.page.robot = select.value;
      this.page.forget();
      this.page.choose();
      this.share();
    };
  }

  // --- the address ---

  /**
   * Stores the settings and the camera in the address, so that a copied link shows the same view.
   */
  share() {
    clearTimeout(this.sharing);
    this.sharing = setTimeout(() => {
      const [low, high] = this.clip;
      const settings = {
        color: this.mode === 'height' ? null : this.mode,
        robot: this.page.robot || null,
        trail: this.isOn('trail') ? 1 : null,
        from: low.value === low.min ? null : low.value,
        to: high.value === high.max ? null : high.value,
        camera: this.page.scene.pose.map((v) => v.toFixed(1)).join(),
      };
      const kept = Object.entries(settings).filter(([, value]) => value !== null);
      const url = new URL(location.href);
      url.hash = new URLSearchParams(kept);
      history.replaceState(null, '', url);
    }, SHARE_MS);
  }

  readAddress() {
    const settings = new URLSearchParams(location.hash.slice(1));
    if (settings.get('color') in MODES) this.setMode(settings.get('color'));
    this.page.robot = settings.get('robot') ?? '';
    if (settings.get('trail')) this.toggle('trail', true);
    if (settings.get('from')) this.clip[0].value = settings.get('from');
    if (settings.get('to')) this.clip[1].value = settings.get('to');
    this.applyClip();
    const camera = (settings.get('camera') ?? '').split(',').map(Number);
    if (camera.length === 6 && camera.every(Number.isFinite)) this.page.scene.pose = camera;
  }

  setSheet(open) {
    byId('more').setAttribute('aria-expanded', open);
    document.body.dataset.sheet = open ? 'open' : 'closed';
  }

  setPanel(open) {
    this.toggle('panel', open);
    document.body.dataset.panel = open ? 'open' : 'closed';
  }

  async snapshot() {
    const blob = await this.page.scene.picture();
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = `gst-lidar-${new Date().toISOString().replace(/[:.]/g, '-')}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  onKey(event) {
    const isSlider = event.target.type === 'range';
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (!isSlider && ['INPUT', 'SELECT'].includes(event.target.tagName)) return;
    const inScene = event.target === byId('scene') || event.target === document.body;
    const { scene } = this.page;
    const moves = {
      ArrowLeft: [-1, 0, 0],
      ArrowRight: [1, 0, 0],
      ArrowUp: [0, 1, 0],
      ArrowDown: [0, -1, 0],
      '+': [0, 0, 1],
      '=': [0, 0, 1],
      '-': [0, 0, -1],
    };
    if (inScene && moves[event.key]) {
      event.preventDefault();
      return scene.nudge(...moves[event.key]);
    }
    if (inScene && event.key === '0') return scene.home();
    const buttons = { f: 'follow', m: 'map', t: 'trail', s: 'snapshot', c: 'panel', d: 'theme', r: 'measure', o: 'top', l: 'live', b: 'back', n: 'forth' };
    const id = (inScene || isSlider) && event.key === ' ' ? 'pause' : buttons[event.key.toLowerCase()];
    if (!id || byId(id).disabled) return;
    event.preventDefault();
    byId(id).click();
  }

  // --- theme ---

  get isDark() {
    if (this.theme !== 'system') return this.theme === 'dark';
    return matchMedia('(prefers-color-scheme: dark)').matches;
  }

  nextTheme() {
    this.theme = this.isDark ? 'light' : 'dark';
    try {
      localStorage.setItem('theme', this.theme);
    } catch {
      // Without storage, the page shows the system's theme the next time.
    }
    this.applyTheme();
  }

  applyTheme() {
    document.documentElement.dataset.theme = this.isDark ? 'dark' : 'light';
    const css = getComputedStyle(document.documentElement);
    const color = (name) => css.getPropertyValue(`--${name}`).trim();
    this.colors = {
      muted: color('muted'),
      line: color('line'),
      series: ['accent', 'second', 'third', 'fourth'].map(color),
    };
    this.page.scene.setTheme(
      { ground: color('ground'), text: color('text'), line: color('line'), accent: color('accent'), map: color('map') },
      this.mode,
      this.isDark,
    );
    this.setMode(this.mode);
  }

  /** Returns the colours of the charts. It is a new object after each change. */
  style() {
    return this.colors;
  }
}

export const buildTools = (page) => new Tools(page);
