// SPDX-License-Identifier: LGPL-2.1-or-later
// The controls: colours, camera, pause, snapshot, charts, theme; each has a key.
import { FLOATS } from './fields.js';
import { MODES, rampOf, texels } from './palette.js';

const TRAIL_S = 1;
const NARROW = '(max-width: 760px)';

const byId = (id) => document.getElementById(id);
const stored = (key) => {
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
};

/** What a fiftieth of the values lies below, and above. */
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
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.applyTheme());
    this.setPanel(!matchMedia(NARROW).matches);
    this.applyTheme();
    addEventListener('keydown', (event) => this.onKey(event));
  }

  // --- colours ---

  makeColors() {
    const group = byId('colors');
    for (const [mode, { label }] of Object.entries(MODES)) {
      const button = document.createElement('button');
      button.textContent = label;
      button.dataset.mode = mode;
      button.setAttribute('role', 'radio');
      button.onclick = () => this.setMode(mode);
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
    this.page.scene.fresh.setColors(mode, this.isDark);
    this.applyScale();
  }

  applyScale() {
    const [low, high] = this.scales[this.mode];
    this.page.scene.fresh.setScale(low, high);
    this.page.scene.dirty = true;
    const { label, unit } = MODES[this.mode];
    const legend = byId('legend');
    legend.querySelector('figcaption').textContent = label + (unit ? ` [${unit}]` : '');
    const round = (v) => (Math.abs(v) < 10 && v % 1 ? v.toFixed(1) : Math.round(v).toLocaleString('en'));
    [low, high].forEach((v, i) => (legend.querySelectorAll('span')[i].textContent = round(v)));
    const context = legend.querySelector('canvas').getContext('2d');
    const pixels = texels(rampOf(this.mode, this.isDark));
    context.putImageData(new ImageData(new Uint8ClampedArray(pixels), 256, 1), 0, 0);
  }

  /** Finds scales in what comes, slowly, so that colours keep their meaning. */
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
    // Beams come in slices whole: the highest number is the last beam.
    let beam = this.seen ? this.scales.beam[1] : 1;
    for (let i = 4; i < points.length; i += FLOATS * 7) beam = Math.max(beam, points[i]);
    this.scales.beam[1] = beam;
    const ground = this.scales.height[0];
    if (!this.page.hasPoses) this.page.scene.ground = ground;
    this.seen = true;
    this.applyScale();
  }

  // --- time ---

  /** A scan stays until the next has come, a trail longer. */
  setSpan() {
    const trail = byId('trail').getAttribute('aria-pressed') === 'true';
    const span = trail ? TRAIL_S : this.page.spanS * 0.995;
    this.page.scene.fresh.setSpan(span);
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
      map: () => {
        page.scene.map.object.visible = this.toggle('map', !this.isOn('map'));
        page.scene.dirty = true;
      },
      trail: () => {
        this.toggle('trail', !this.isOn('trail'));
        this.setSpan();
      },
      pause: () => {
        page.paused = this.toggle('pause', !this.isOn('pause'));
        page.showState();
      },
      snapshot: () => this.snapshot(),
      panel: () => this.setPanel(!this.isOn('panel')),
      theme: () => this.nextTheme(),
    };
    for (const [id, action] of Object.entries(actions)) byId(id).onclick = action;
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
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === 'INPUT') return;
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
    const buttons = { f: 'follow', m: 'map', t: 'trail', s: 'snapshot', c: 'panel', d: 'theme' };
    const id = inScene && event.key === ' ' ? 'pause' : buttons[event.key.toLowerCase()];
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
      // A browser that keeps nothing shows the system's theme the next time.
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
      series: [color('accent'), color('second'), color('third')],
    };
    this.page.scene.setTheme(
      { ground: color('ground'), line: color('line'), accent: color('accent'), map: color('map') },
      this.mode,
      this.isDark,
    );
    this.setMode(this.mode);
  }

  /** Colours of the charts; another object after a change. */
  style() {
    return this.colors;
  }
}

export const buildTools = (page) => new Tools(page);
