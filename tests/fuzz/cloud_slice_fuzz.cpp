// SPDX-License-Identifier: LGPL-2.1-or-later
// Coded clouds without a sensor model.
#include <cmath>

#include "src/codec/cloud/cloud_decoder.h"
#include "src/codec/cloud/cloud_encoder.h"
#include "tests/fuzz/fuzz.h"

namespace {

constexpr std::uint32_t kMaxPoints = 4'096;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lidar::codec;
  cloud::CloudDecoder decoder(kMaxPoints);
  // Twice: what one slice leaves behind must not change the next.
  const bool first = decoder.Decode({data, size});
  const XyzCloud decoded = decoder.cloud();
  const bool second = decoder.Decode({data, size});
  FUZZ_CHECK(first == second);
  if (!first) return 0;
  FUZZ_CHECK(decoded.xyz == decoder.cloud().xyz && decoded.size() <= kMaxPoints);
  FUZZ_CHECK(decoded.intensity.size() == (decoder.intensity_bits() > 0 ? decoded.size() : 0));
  for (const float v : decoded.xyz) FUZZ_CHECK(std::isfinite(v));

  // What is accepted can be written again, with as many points.
  const CloudLayout layout = {*lidar::PointFields::Parse("x:F32:0,y:F32:4,z:F32:8"), 12};
  auto encoder = cloud::CloudEncoder::Create(layout);
  encoder->Load({reinterpret_cast<const std::uint8_t*>(decoded.xyz.data()), decoded.size() * 12},
                false);
  const std::size_t returns = encoder->returns();
  EncodedSlice slice;
  if (encoder->Encode({decoder.error_m(), 0, 0}, &slice) != SliceResult::kEncoded) return 0;
  FUZZ_CHECK(decoder.Decode({slice.bytes.data(), slice.bytes.size()}));
  FUZZ_CHECK(decoder.cloud().size() == returns);
  return 0;
}
