// SPDX-License-Identifier: LGPL-2.1-or-later
// The camera beside the cloud: frames of foxglove.CompressedVideo, decoded by WebCodecs.

const CODECS = { h264: 'avc1.42E01F', vp8: 'vp8' };
const MOST_WAITING = 8;

/** Whether an H.264 access unit (Annex B) begins anew, or a VP8 frame does. */
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
    this.format = null;
  }

  start(format) {
    this.format = format;
    this.needsKey = true;
    this.decoder = new VideoDecoder({
      output: (frame) => this.show(frame),
      error: () => (this.format = null), // the next key frame starts anew
    });
    this.decoder.configure({ codec: CODECS[format], optimizeForLatency: true });
  }

  add({ time, format, data }) {
    if (!(format in CODECS) || typeof VideoDecoder !== 'function') return;
    const key = isKey(format, data);
    if (format !== this.format) {
      if (!key) return;
      this.start(format);
    }
    // A decoder that falls behind goes on with the next key frame.
    if (this.decoder.decodeQueueSize > MOST_WAITING) this.needsKey = true;
    if (this.needsKey && !key) return;
    this.needsKey = false;
    const timestamp = Math.round(time * 1e6);
    this.decoder.decode(new EncodedVideoChunk({ type: key ? 'key' : 'delta', timestamp, data }));
  }

  show(frame) {
    const { canvas } = this;
    canvas.hidden = false;
    if (canvas.width !== frame.displayWidth) canvas.width = frame.displayWidth;
    if (canvas.height !== frame.displayHeight) canvas.height = frame.displayHeight;
    this.context.drawImage(frame, 0, 0);
    frame.close();
  }
}
