// SPDX-License-Identifier: LGPL-2.1-or-later
// How old clouds are. A browser's clock may be far from the server's, so the least difference that
// was seen stands for both clocks' and for the way.

const SYNCHRONISED_S = 1; // a way that takes longer is rather a clock that is wrong
const KEPT = 600;

export const nowSeconds = () => (performance.timeOrigin + performance.now()) * 1e-3;

export class Clock {
  constructor() {
    this.differences = [];
  }

  /** A message left the server at `sent` [s]. */
  arrived(sent) {
    this.differences.push(nowSeconds() - sent);
    if (this.differences.length > KEPT) this.differences.shift();
    return nowSeconds();
  }

  /** The age [s] of what was captured at `captured`. */
  ageOf(captured) {
    const least = Math.min(...this.differences);
    const offset = least >= 0 && least < SYNCHRONISED_S ? 0 : least;
    return nowSeconds() - offset - captured;
  }
}
