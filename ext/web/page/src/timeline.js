// SPDX-License-Identifier: LGPL-2.1-or-later
// The time that is shown: the newest as it comes, or a while before, playing on or held.
import { number, t } from './text.js';

const LEAST_S = 1; // that is worth a slider
const HOLE_S = 1; // while which nothing came: it is passed over

export class Timeline {
  /** `ask(time)` for the picture of a time, null for none any more; `onLive()` and `onPast()` at changes. */
  constructor(element, on) {
    Object.assign(this, { element, on });
    this.slider = element.querySelector('input');
    this.output = element.querySelector('output');
    this.at = null; // what is shown [s]; null: the newest
    this.asked = null; // and not answered
    this.span = [0, 0];
    this.slider.oninput = () => this.seek(this.span[1] + Number(this.slider.value));
    this.update();
  }

  get isPast() {
    return this.at !== null;
  }

  seek(time) {
    const [from, to] = this.span;
    const wasPast = this.isPast;
    this.at = Math.min(Math.max(time, from), to);
    this.ask();
    if (!wasPast) this.on.past();
    this.update();
  }

  live() {
    if (!this.isPast) return;
    this.at = this.asked = null;
    this.on.ask(null);
    this.on.live();
    this.update();
  }

  /** There is nothing to go back to any more. */
  forget() {
    this.live();
    this.span = [0, 0];
    this.update();
  }

  ask() {
    this.asked = this.at;
    this.on.ask(this.at);
  }

  /** What was asked for has come; whether it is still wanted. */
  answered({ time, next }, isHeld) {
    if (time !== this.asked) return false;
    this.asked = null;
    if (!isHeld && next !== null && next > this.at + HOLE_S) this.at = next;
    return true;
  }

  /** Time goes on by `seconds`. */
  tick(seconds, isHeld) {
    if (!this.isPast || isHeld) return;
    this.at = Math.max(this.at + seconds, this.span[0]);
    if (this.at >= this.span[1]) this.live();
    else if (this.asked === null) this.ask();
  }

  /** Shows where it is. */
  update() {
    const [from, to] = this.span;
    this.element.hidden = to - from < LEAST_S;
    const ago = this.isPast ? to - this.at : 0;
    this.slider.min = (from - to).toFixed(1);
    this.slider.value = -ago;
    const text = this.isPast ? `${number(ago, ago < 10 ? 1 : 0)} s ${t('ago')}` : t('live');
    this.output.textContent = this.isPast ? text : '';
    this.slider.setAttribute('aria-valuetext', text);
  }
}
