// SPDX-License-Identifier: LGPL-2.1-or-later
// The camera's picture. Decodes the frames of foxglove.CompressedVideo by WebCodecs, and shows each
// picture together with the cloud of the same time, live or in the past.

const CODECS = { h264: 'avc1.42E01F', vp8: 'vp8' };
const MOST_WAITING = 8;
const MOST_HELD = 4; // decoded pictures that are kept; a decoder has few buffers
const FAR_S = 1; // a larger difference of times means another clock, or a jump
const MOST_BYTES = 32 << 20; // of coded frames

/**
 * Returns true if `data` is an H.264 access unit (Annex B) with an IDR slice, or a VP8 key frame.
 */
export function isKey(format, data) {
  if (format === 'vp8') return (data[0] & 1) === 0;
  for (let i = 0; i + 3 < data.length; ++i)
    if (data[i] === 0 && data[i + 1] === 0 && data[i + 2] === 1 && (data[i + 3] & 31) === 5) return true;
  return false;
}

export class Video {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
    this.held = []; // decoded pictures, the oldest first
    this.clear();
  }

  /** Drops the frames of the robot that was shown before. */
  clear() {
    this.kept = []; // coded frames, the oldest first
    this.bytes = 0;
    this.first = 0; // the number of kept[0]
    this.live();
  }

  /** Shows new frames as soon as they arrive. */
  live() {
    this.next = null; // number of the kept frame that is decoded next
    this.at = null; // the time that is shown [s]; null: live
    this.reset();
  }

  reset() {
    this.canvas.hidden = true;
    this.held.splice(0).forEach((picture) => picture.close());
    this.format = null;
    if (this.decoder?.state === 'configured') this.decoder.close();
  }

  start(format) {
    this.format = format;
    this.needsKey = true;
    this.decoder = new VideoDecoder({
      output: (picture) => this.held.push(picture),
      error: () => (this.format = null), // the next key frame starts a new decoder
    });
    this.decoder.configure({ codec: CODECS[format], optimizeForLatency: true });
  }

  add({ time, format, data }) {
    if (!(format in CODECS) || typeof VideoDecoder !== 'function') return;
    const frame = { time, format, data, key: isKey(format, data) };
    this.keep(frame);
    if (this.at === null) this.decode(frame);
  }

  keep(frame) {
    this.kept.push(frame);
    this.bytes += frame.data.length;
    for (; this.bytes > MOST_BYTES; ++this.first) this.bytes -= this.kept.shift().data.length;
  }

  decode({ time, format, data, key }) {
    if (format !== this.format) {
      if (!key) return;
      this.start(format);
    }
    // If the decoder is too slow, frames are skipped until the next key frame.
    if (this.decoder.decodeQueueSize > MOST_WAITING) this.needsKey = true;
    if (this.needsKey && !key) return;
    this.needsKey = false;
    const timestamp = Math.round(time * 1e6);
    this.decoder.decode(new EncodedVideoChunk({ type: key ? 'key' : 'delta', timestamp, data }));
  }

  /** Shows the kept picture of the time `time` [s] in the past, if there is one. */
  replay(time) {
    const isJump = this.next === null || time < this.at || time > this.at + FAR_S || this.next < this.first;
    this.at = time;
    if (isJump) this.jump(time);
    if (this.next === null) return;
    for (let frame; (frame = this.kept[this.next - this.first])?.time <= time; ++this.next) {
      if (this.decoder?.decodeQueueSize >= MOST_WAITING) break;
      this.decode(frame);
    }
    this.draw(time);
  }

  jump(time) {
    this.reset();
    const key = this.kept.findLastIndex((frame) => frame.key && frame.time <= time);
    this.next = key < 0 ? null : this.first + key;
  }

  /**
   * Shows the newest picture that is not later than `time` [s], the time of the cloud. If `time` is
   * null, shows the newest of all pictures.
   */
  draw(time) {
    const ahead = (picture) => picture.timestamp * 1e-6 - time;
    const isDue = (picture) => time === null || ahead(picture) <= 0 || ahead(picture) > FAR_S;
    let due = this.held.findLastIndex(isDue);
    due = Math.max(due, this.held.length - 1 - MOST_HELD);
    if (due < 0) return;
    const old = this.held.splice(0, due + 1);
    this.show(old[due]);
    old.forEach((picture) => picture.close());
  }

  show(picture) {
    const { canvas } = this;
    canvas.hidden = false;
    if (canvas.width !== picture.displayWidth) canvas.width = picture.displayWidth;
    if (canvas.height !== picture.displayHeight) canvas.height = picture.displayHeight;
    this.context.drawImage(picture, 0, 0);
    this.shown = picture.timestamp * 1e-6;
  }
}
