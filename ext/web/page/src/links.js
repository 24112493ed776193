// SPDX-License-Identifier: LGPL-2.1-or-later
// The links of a sender over several, as a sender sees them, or as its receiver does.

export const MOST_LINKS = 4;
const NS_TO_MS = 1e-6;
const SENDER_S = 3; // while what it says of its links counts, and not what a receiver does

const inMs = (ns) => (typeof ns === 'number' ? ns * NS_TO_MS : undefined);

/** What a sender calls `host:port@interface` is the interface to its user. */
const nameOf = ({ link, address }, i) => String(link ?? address ?? i + 1).replace(/^.*@/, '');

const stateOf = ({ usable, in_gap: inGap }) => (usable === false ? 'unusable' : inGap ? 'in_gap' : null);

export class Links {
  constructor() {
    this.sender = -Infinity; // when it said something
    this.before = []; // what a receiver had got of each link, and when
  }

  /** Members for the charts of a lidar.Statistics that came at `now` [s]: `link_0` to `link_3`. */
  of({ elements = {} }, now) {
    const all = Object.values(elements).filter(({ links }) => links?.length > 1);
    const sender = all.find(({ links }) => 'sent_bitrate' in links[0]);
    if (sender) this.sender = now;
    const teller = sender ?? (now - this.sender < SENDER_S ? undefined : all[0]);
    const members = {};
    teller?.links.slice(0, MOST_LINKS).forEach((link, i) => {
      const bitrate = sender ? link.sent_bitrate : this.received(link, i, now);
      members[`link_${i}`] = { name: nameOf(link, i), state: stateOf(link) };
      Object.assign(members, {
        [`link_${i}_bitrate`]: bitrate,
        [`link_${i}_rtt`]: inMs(link.rtt),
        [`link_${i}_queue`]: inMs(link.queue_delay),
      });
    });
    return members;
  }

  received({ bytes_received: bytes }, i, now) {
    const before = this.before[i];
    this.before[i] = { bytes, now };
    if (!before || now <= before.now || bytes < before.bytes) return undefined;
    return ((bytes - before.bytes) * 8) / (now - before.now);
  }
}
