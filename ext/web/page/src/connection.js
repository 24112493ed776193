// SPDX-License-Identifier: LGPL-2.1-or-later
// The connection to a server: subscribes to the channels that the page wants, and reconnects.
import { FoxgloveClient } from '@foxglove/ws-protocol';

const RETRY_FIRST_MS = 500;
const RETRY_MOST_MS = 5000;
const PROTOCOLS = ['foxglove.sdk.v1', 'foxglove.websocket.v1'];
const EXPIRED = 4401; // the code with which the server closes the socket when a token expires
const REFUSALS = { 401: 'refused', 403: 'foreign', 429: 'limited', 503: 'full' };
const FINAL = ['refused', 'expired']; // no retry before the user enters another token

/**
 * Returns the address of the WebSocket. Its path is the folder of the page, because a proxy may add
 * a prefix.
 */
function socketAddress(host, token) {
  const url = new URL('.', location.href);
  if (host !== location.host) {
    url.host = host;
    url.pathname = '/';
  }
  url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
  url.hash = '';
  url.search = token ? `?token=${encodeURIComponent(token)}` : '';
  return url;
}

export class Connection {
  /**
   * Calls `on.state(state)` with connecting, open, lost, or the reason why the server refuses;
   * `on.message(channel, bytes, nanoseconds)`; `on.channels(list)` with all channels that the
   * server offers; `on.subscribed(channel)`; `on.dropped(channel)` when a subscription ends; and
   * `on.recording(channel, status)`. `wanted(list)` returns the channels to subscribe to.
   */
  constructor(host, token, on, wanted) {
    Object.assign(this, { host, token, on, wanted });
    this.retry = RETRY_FIRST_MS;
    this.open();
  }

  open() {
    this.on.state('connecting');
    this.offered = new Map(); // channels by id
    this.subscriptions = new Map(); // channels by subscription
    this.socket = new WebSocket(socketAddress(this.host, this.token), PROTOCOLS);
    const client = new FoxgloveClient({ ws: this.socket });
    client.on('open', () => {
      this.retry = RETRY_FIRST_MS;
      this.on.state('open');
    });
    client.on('error', () => {}); // a close follows
    client.on('advertise', (list) => {
      for (const channel of list) this.offered.set(channel.id, channel);
      this.choose();
    });
    client.on('unadvertise', (ids) => {
      for (const id of ids) this.offered.delete(id);
      this.choose();
    });
    client.on('message', ({ subscriptionId, timestamp, data }) => {
      const channel = this.subscriptions.get(subscriptionId);
      if (!channel) return;
      this.on.message(channel, new Uint8Array(data.buffer, data.byteOffset, data.byteLength), timestamp);
    });
    client.on('close', (event) => this.closed(event?.code));
    this.socket.addEventListener('message', ({ data }) => this.read(data));
    this.client = client;
  }

  /** Subscribes to the channels that are wanted now, and ends all other subscriptions. */
  choose() {
    const list = [...this.offered.values()];
    this.on.channels?.(list);
    const wanted = new Set(this.wanted(list));
    for (const [id, channel] of this.subscriptions) {
      if (wanted.delete(channel)) continue;
      this.subscriptions.delete(id);
      this.client.unsubscribe(id);
      this.on.dropped?.(channel);
    }
    for (const channel of wanted) {
      this.subscriptions.set(this.client.subscribe(channel.id), channel);
      this.on.subscribed?.(channel);
    }
  }

  /** Reads the operations that only our server sends. FoxgloveClient reads all others. */
  read(data) {
    if (typeof data !== 'string' || !data.includes('"recording"')) return;
    const { op, subscriptionId, ...status } = JSON.parse(data);
    const channel = op === 'recording' ? this.subscriptions.get(subscriptionId) : undefined;
    if (channel) this.on.recording?.(channel, status);
  }

  /** Sends an operation about the subscription to `channel`. Only our server knows it. */
  tell(op, channel, rest = {}) {
    if (this.socket.readyState !== WebSocket.OPEN) return;
    for (const [subscriptionId, known] of this.subscriptions)
      if (known === channel) this.socket.send(JSON.stringify({ op, subscriptionId, ...rest }));
  }

  async closed(code) {
    for (const channel of this.subscriptions.values()) this.on.dropped?.(channel);
    this.subscriptions.clear();
    this.on.state('lost');
    const state = code === EXPIRED ? 'expired' : REFUSALS[await this.why()];
    if (state) this.on.state(state);
    if (FINAL.includes(state)) return;
    setTimeout(() => this.open(), this.retry);
    this.retry = Math.min(this.retry * 1.6, RETRY_MOST_MS);
  }

  /**
   * Returns the HTTP status of the refusal. A browser hides why a socket was refused, so the page
   * sends the same request by HTTP.
   */
  async why() {
    if (this.host !== location.host) return 0;
    try {
      const query = this.token ? `?token=${encodeURIComponent(this.token)}` : '';
      return (await fetch(`session${query}`, { cache: 'no-store' })).status;
    } catch {
      return 0;
    }
  }
}
