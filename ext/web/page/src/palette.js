// SPDX-License-Identifier: LGPL-2.1-or-later
// The colours of numbers on dark and light backgrounds, for the scene and its legend.

/**
 * The lightness increases with the number, from blue to yellow. Colour-blind people, and prints in
 * black and white, therefore show the order, too.
 */
const dark = {
  spectrum: ['#3d4fa8', '#3a73b4', '#3697b0', '#45b79b', '#86d079', '#cfe25f', '#fff4a8'],
  glow: ['#33415c', '#56708f', '#8ea3b5', '#c9c6b8', '#fff3d6'],
  fade: ['#ffffff', '#7fd6e0', '#2f86d6', '#2a3f78', '#232c45'],
};
const light = {
  spectrum: ['#2a1a5e', '#2f3f8f', '#1f5f94', '#14807f', '#3f9a5c', '#8fa52e', '#c99f1e'],
  glow: ['#b9c0c9', '#8f9aa8', '#657286', '#3f4a60', '#141a2b'],
  fade: ['#0b1a33', '#1f5c8f', '#5b93bd', '#a3bfd4', '#ccd8e2'],
};

export const MODES = {
  height: { label: 'Height', unit: 'm', ramp: 'spectrum' },
  intensity: { label: 'Intensity', unit: '', ramp: 'glow' },
  range: { label: 'Range', unit: 'm', ramp: 'spectrum' },
  beam: { label: 'Beam', unit: '', ramp: 'spectrum' },
  age: { label: 'Age', unit: 'ms', ramp: 'fade' },
};

export const rampOf = (mode, isDark) => (isDark ? dark : light)[MODES[mode].ramp];

function channels(color) {
  return [1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16));
}

/** Returns a ramp as 256 RGBA pixels. */
export function texels(colors) {
  const out = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) {
    const at = (i / 255) * (colors.length - 1);
    const k = Math.min(Math.floor(at), colors.length - 2);
    const a = channels(colors[k]);
    const b = channels(colors[k + 1]);
    for (let c = 0; c < 3; ++c) out[4 * i + c] = Math.round(a[c] + (b[c] - a[c]) * (at - k));
    out[4 * i + 3] = 255;
  }
  return out;
}
