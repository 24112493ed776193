// SPDX-License-Identifier: LGPL-2.1-or-later
// Statistics of several links. They come from the sender if it reports, and otherwise from the
// receiver.

export const MOST_LINKS = 4;
const NS_TO_MS = 1e-6;
const SENDER_S = 3; // for this time after the sender's report, the receiver's reports are ignored

const inMs = (ns) => (typeof ns === 'number' ? ns * NS_TO_MS : undefined);

/**
 * Returns the interface of a link `host:port@interface`, because users know the link by its
 * interface.
 */
const nameOf = ({ link, address }, i) => String(link ?? address ?? i + 1).replace(/^.*@/, '');

const stateOf = ({ usable, in_gap: inGap }) => (usable === false ? 'unusable' : inGap ? 'in_gap' : null);

export class Links {
  constructor() {
    this.sender = -Infinity; // time of the sender's last report [s]
    this.before = []; // bytes and time of each link in the receiver's last report
  }

  /**
   * Returns the members for the charts, such as `link_0`, from a lidar.Statistics that arrived at
   * `now` [s].
   */
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
