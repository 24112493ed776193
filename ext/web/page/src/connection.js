// SPDX-License-Identifier: LGPL-2.1-or-later
// The connection to a server: subscribes to what the page understands, and comes back after a loss.
import { FoxgloveClient } from '@foxglove/ws-protocol';

const RETRY_FIRST_MS = 500;
const RETRY_MOST_MS = 5000;
const PROTOCOLS = ['foxglove.sdk.v1', 'foxglove.websocket.v1'];

export class Connection {
  /**
   * `on.state(state)`: connecting, open, lost, refused (the token) or full;
   * `on.message(channel, bytes)`; `wanted(channel)` says what to subscribe to.
   */
  constructor(host, token, on, wanted) {
    Object.assign(this, { host, token, on, wanted });
    this.retry = RETRY_FIRST_MS;
    this.open();
  }

  get secure() {
    return location.protocol === 'https:' ? 's' : '';
  }

  get query() {
    return this.token ? `?token=${encodeURIComponent(this.token)}` : '';
  }

  open() {
    this.on.state('connecting');
    const socket = new WebSocket(`ws${this.secure}://${this.host}/${this.query}`, PROTOCOLS);
    const client = new FoxgloveClient({ ws: socket });
    const channels = new Map(); // by subscription
    client.on('open', () => {
      this.retry = RETRY_FIRST_MS;
      this.on.state('open');
    });
    client.on('error', () => {}); // a close follows
    client.on('advertise', (list) => {
      for (const channel of list.filter(this.wanted))
        channels.set(client.subscribe(channel.id), channel);
    });
    client.on('unadvertise', (ids) => {
      for (const [id, channel] of channels) if (ids.includes(channel.id)) channels.delete(id);
    });
    client.on('message', ({ subscriptionId, data }) => {
      const channel = channels.get(subscriptionId);
      if (!channel) return;
      this.on.message(channel, new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
    });
    client.on('close', () => this.closed());
    this.client = client;
  }

  async closed() {
    this.on.state('lost');
    const status = await this.why();
    if (status === 401) return this.on.state('refused'); // a new token has to come
    if (status === 503) this.on.state('full');
    setTimeout(() => this.open(), this.retry);
    this.retry = Math.min(this.retry * 1.6, RETRY_MOST_MS);
  }

  /** A browser does not say why a socket was refused, but it does for a request. */
  async why() {
    if (this.host !== location.host) return 0;
    try {
      return (await fetch(`session${this.query}`, { cache: 'no-store' })).status;
    } catch {
      return 0;
    }
  }
}
