// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes the slices of a stream into points by ext/web/decoder, which runs as WebAssembly. Each
// decoder is a separate instance. If a slice makes an instance trap, only the stream of that slice
// loses its references.

export const POINT_FLOATS = 6; // x, y, z, intensity, beam, range, as in fields.js
const DAMAGED = -1;
const LACKS_REFERENCE = -2;

export class Decoder {
  /**
   * `module` is the compiled lidar_decoder.wasm. `model` is the sensor model, which is empty for
   * points.
   */
  constructor(module, model, maxPoints = 1 << 20) {
    Object.assign(this, { module, model, maxPoints });
    this.start();
  }

  start() {
    this.wasm = new WebAssembly.Instance(this.module, {}).exports;
    const { wasm, model } = this;
    wasm._initialize();
    const at = wasm.allocate(model.length);
    this.bytes(at, model.length).set(model);
    this.decoder = wasm.open(at, model.length, this.maxPoints);
    wasm.release(at);
    if (this.decoder === 0) throw new Error('the sensor model is damaged');
  }

  bytes(at, size) {
    return new Uint8Array(this.wasm.memory.buffer, at, size);
  }

  /**
   * Decodes a slice and returns {points, step, error, has}. `points` is a view that is valid until
   * the next call. If the slice cannot be decoded, returns {points: null, lacksReference}.
   */
  decode(slice) {
    const result = this.run(slice);
    if (result !== 0) return { points: null, lacksReference: result === LACKS_REFERENCE };
    const at = this.wasm.slice(this.decoder);
    const words = new Uint32Array(this.wasm.memory.buffer, at, 6);
    const [, , step, error] = new Float32Array(this.wasm.memory.buffer, at, 6);
    return {
      points: new Float32Array(this.wasm.memory.buffer, words[1], words[0] * POINT_FLOATS),
      step,
      error,
      has: { intensity: words[4] !== 0, beam: words[5] !== 0 },
    };
  }

  /**
   * Returns the blocks of the slice as [{name, needs}]. Later blocks may refer to `name`. `needs`
   * is null for a block without a reference.
   */
  links(slice) {
    const count = this.put(slice) ? this.wasm.find_links(this.decoder) : 0;
    const words = new Uint32Array(this.wasm.memory.buffer, this.wasm.links(this.decoder), 3 * count);
    return Array.from({ length: count }, (_, i) => ({
      name: words[3 * i],
      needs: words[3 * i + 2] !== 0 ? words[3 * i + 1] : null,
    }));
  }

  put(slice) {
    const input = this.wasm.input(this.decoder, slice.length);
    if (input !== 0) this.bytes(input, slice.length).set(slice);
    return input !== 0;
  }

  run(slice) {
    try {
      return this.put(slice) ? this.wasm.decode(this.decoder) : DAMAGED;
    } catch {
      this.start(); // the memory may be inconsistent after the trap
      return DAMAGED;
    }
  }

  /** Returns all pixels of the last slice, 20 bytes each. Only tests use this function. */
  raw() {
    return this.bytes(this.wasm.raw(this.decoder), this.wasm.raw_count(this.decoder) * 20);
  }
}
