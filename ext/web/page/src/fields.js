// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts points of any layout to the drawn layout: x, y, z, intensity, beam and range as floats.

export const FLOATS = 6; // per point

/** The functions that read a number, indexed by foxglove.PackedElementField.NumericType. */
const readers = [
  null,
  (v, at) => v.getUint8(at),
  (v, at) => v.getInt8(at),
  (v, at) => v.getUint16(at, true),
  (v, at) => v.getInt16(at, true),
  (v, at) => v.getUint32(at, true),
  (v, at) => v.getInt32(at, true),
  (v, at) => v.getFloat32(at, true),
  (v, at) => v.getFloat64(at, true),
];

function find(fields, names) {
  for (const name of names) {
    const field = fields.find((f) => f.name === name);
    if (field && readers[field.type]) return { offset: field.offset, read: readers[field.type] };
  }
  return null;
}

/** Returns the points of a decoded foxglove.PointCloud. */
export function unpack(cloud) {
  const { fields, stride, data } = cloud;
  const count = stride > 0 ? Math.floor(data.length / stride) : 0;
  const axes = ['x', 'y', 'z'].map((name) => find(fields, [name]));
  const points = new Float32Array(axes.every(Boolean) ? count * FLOATS : 0);
  const intensity = find(fields, ['intensity', 'reflectivity', 'signal']);
  const beam = find(fields, ['ring', 'beam', 'channel']);
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const [x, y, z] = axes;
  for (let i = 0, to = 0, at = 0; to < points.length; ++i, to += FLOATS, at += stride) {
    points[to] = x.read(view, at + x.offset);
    points[to + 1] = y.read(view, at + y.offset);
    points[to + 2] = z.read(view, at + z.offset);
    if (intensity) points[to + 3] = intensity.read(view, at + intensity.offset);
    if (beam) points[to + 4] = beam.read(view, at + beam.offset);
    points[to + 5] = Math.hypot(points[to], points[to + 1], points[to + 2]);
  }
  return { points, has: { intensity: !!intensity, beam: !!beam } };
}

/** Returns the points in the arrays of Draco's decoder. `intensities` may be null. */
export function fromDraco(positions, intensities) {
  const count = positions.length / 3;
  const points = new Float32Array(count * FLOATS);
  for (let i = 0; i < count; ++i) {
    const to = i * FLOATS;
    points.set(positions.subarray(3 * i, 3 * i + 3), to);
    if (intensities) points[to + 3] = intensities[i];
    points[to + 5] = Math.hypot(points[to], points[to + 1], points[to + 2]);
  }
  return { points, has: { intensity: !!intensities, beam: false } };
}
