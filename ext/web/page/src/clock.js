// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes the age of clouds. A browser's clock may differ much from the server's clock. The
// smallest difference between sending and arrival times is therefore taken as the offset between
// the clocks plus the shortest delay.

const SYNCHRONISED_S = 1; // a larger difference is an offset between the clocks, not a delay
const KEPT = 600;

export const nowSeconds = () => (performance.timeOrigin + performance.now()) * 1e-3;

export class Clock {
  constructor() {
    this.differences = [];
  }

  /** Notes a message that left the server at `sent` [s]. Returns the present time [s]. */
  arrived(sent) {
    this.differences.push(nowSeconds() - sent);
    if (this.differences.length > KEPT) this.differences.shift();
    return nowSeconds();
  }

  /** Returns the age [s] of data that were captured at `captured` [s]. */
  ageOf(captured) {
    const least = Math.min(...this.differences);
    const offset = least >= 0 && least < SYNCHRONISED_S ? 0 : least;
    return nowSeconds() - offset - captured;
  }
}
