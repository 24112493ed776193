// SPDX-License-Identifier: LGPL-2.1-or-later
// The time that is shown. It is live or in the past, and plays or is paused.
import { number, t } from './text.js';

const LEAST_S = 1; // a shorter span has no slider
const HOLE_S = 1; // playback skips longer gaps between slices
const STEP_S = 10; // of the buttons 'back' and 'forth'
const KEYS_S = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -60, PageUp: 60 };

/** Formats a duration, as 7.0 s, 42 s, 3:20 min or 5:03:20 h. */
export function duration(seconds) {
  if (seconds < 60) return `${number(seconds, seconds < 10 ? 1 : 0)} s`;
  const whole = Math.round(seconds);
  const parts = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  const isLong = parts[0] > 0;
  const text = (isLong ? parts : parts.slice(1)).map((n, i) => (i > 0 ? String(n).padStart(2, '0') : n)).join(':');
  return `${text} ${isLong ? 'h' : 'min'}`;
}

export class Timeline {
  /**
   * Requests pictures by `on.jump(time)`, and then by `on.ask(time)`. Calls `on.past()` and
   * `on.live()` when the time changes between live and past. `on.reach()` is the time up to which
   * slices have arrived, and `on.last()` the time of the last slice.
   */
  constructor(element, on) {
    Object.assign(this, { element, on });
    this.slider = element.querySelector('input');
    this.output = element.querySelector('output');
    this.words = element.querySelector('#recording');
    this.at = null; // the time that is shown [s]; null: live
    this.asked = null; // the time [s] of a request that has no answer yet
    this.span = [0, 0];
    this.slider.oninput = () => this.seek(this.span[1] + Number(this.slider.value));
    this.slider.onkeydown = (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in KEYS_S)) return;
      event.preventDefault();
      this.step(KEYS_S[event.key]);
    };
    element.querySelector('#back').onclick = () => this.step(-STEP_S);
    element.querySelector('#forth').onclick = () => this.step(STEP_S);
    this.update();
  }

  get isPast() {
    return this.at !== null;
  }

  seek(time) {
    const [from, to] = this.span;
    const wasPast = this.isPast;
    this.at = this.asked = Math.min(Math.max(time, from), to);
    this.on.jump(this.at);
    if (!wasPast) this.on.past();
    this.update();
  }

  /** Jumps by `seconds`. If the time is live, jumps only back. */
  step(seconds) {
    if (this.isPast || seconds < 0) this.seek((this.at ?? this.span[1]) + seconds);
  }

  live() {
    if (!this.isPast) return;
    this.at = this.asked = null;
    this.on.live();
    this.update();
  }

  /** Returns to live, and empties the range. */
  forget() {
    this.live();
    this.span = [0, 0];
    this.update();
  }

  /** Handles the answer to a request. Returns true if the answer is still wanted. */
  answered({ time, next }, isHeld) {
    if (time !== this.asked) return false;
    this.asked = null;
    if (!isHeld && next !== null && next > this.at + HOLE_S) this.at = next;
    return true;
  }

  /** Advances the shown time by `seconds`. */
  tick(seconds, isHeld) {
    if (!this.isPast || isHeld) return;
    const at = Math.max(this.at + seconds, this.span[0]);
    if (at >= this.on.last()) return this.live();
    this.at = Math.max(this.at, Math.min(at, this.on.reach()));
    if (this.asked !== null) return;
    this.asked = this.at;
    this.on.ask(this.at);
  }

  /** Shows a text about the state of the recording. */
  tell(words) {
    if (words !== this.words.textContent) this.words.textContent = words;
  }

  /** Updates the slider and its text. */
  update() {
    const [from, to] = this.span;
    this.element.hidden = !this.isPast && this.words.textContent === '' && to - from < LEAST_S;
    const ago = this.isPast ? Math.max(to - this.at, 0) : 0;
    this.slider.min = (from - to).toFixed(1);
    this.slider.value = -ago;
    const text = this.isPast ? `${duration(ago)} ${t('ago')}` : t('live');
    this.output.textContent = this.isPast ? text : '';
    this.slider.setAttribute('aria-valuetext', text);
  }
}
