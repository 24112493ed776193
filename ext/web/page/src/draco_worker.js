// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes Draco clouds beside the page: {id, data} in, {id, positions, intensities} out.
importScripts('draco_wasm_wrapper.js');

const ready = fetch('draco_decoder.wasm')
  .then((answer) => answer.arrayBuffer())
  .then((wasmBinary) => DracoDecoderModule({ wasmBinary }));

function attribute(draco, decoder, cloud, kind, components) {
  const id = decoder.GetAttributeId(cloud, kind);
  if (id < 0) return null;
  const array = new draco.DracoFloat32Array();
  decoder.GetAttributeFloatForAllPoints(cloud, decoder.GetAttribute(cloud, id), array);
  const out = new Float32Array(cloud.num_points() * components);
  for (let i = 0; i < out.length; ++i) out[i] = array.GetValue(i);
  draco.destroy(array);
  return out;
}

onmessage = async ({ data: { id, data } }) => {
  const draco = await ready;
  const decoder = new draco.Decoder();
  const buffer = new draco.DecoderBuffer();
  const cloud = new draco.PointCloud();
  buffer.Init(new Int8Array(data), data.byteLength);
  const good = decoder.DecodeBufferToPointCloud(buffer, cloud).ok();
  const positions = good ? attribute(draco, decoder, cloud, draco.POSITION, 3) : null;
  const intensities = good ? attribute(draco, decoder, cloud, draco.GENERIC, 1) : null;
  for (const object of [cloud, buffer, decoder]) draco.destroy(object);
  const moved = [positions, intensities].filter(Boolean).map((a) => a.buffer);
  postMessage({ id, positions, intensities }, moved);
};
