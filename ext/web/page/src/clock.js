// SPDX-License-Identifier: LGPL-2.1-or-later
// The age of clouds. A browser's clock may be far from the server's, so the least difference seen
// counts as the offset of the clocks plus the shortest delay.

const SYNCHRONISED_S = 1; // a larger difference is an offset of the clocks, not a delay
const KEPT = 600;

export const nowSeconds = () => (performance.timeOrigin + performance.now()) * 1e-3;

export class Clock {
  constructor() {
    this.differences = [];
  }

  /** Notes a message that left the server at `sent` [s]; returns the present time [s]. */
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
