// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes slices of clouds that have no sensor model.
#include <cmath>
#include <cstring>
#include <string>

#include "src/codec/cloud/cloud_encoder.h"
#include "src/codec/cloud/exact_decoder.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace lidar;
using namespace lidar::codec;

constexpr std::uint32_t kMaxPoints = 4'096;

/// Returns a name for a field of this type: "line" or "timestamp", because the encoder looks for
/// paths of beams only if a cloud has such fields. If `others` has a field with that name, returns
/// another name.
std::string NameOf(FieldType type, const PointFields& others) {
  const char* name = type == FieldType::kU8 ? "line" : "timestamp";
  return others.Find(name) == nullptr ? name : "f" + std::to_string(others.all().size());
}

/// Returns a layout that has x, y, z and the exact fields of the slice.
CloudLayout LayoutFor(ByteView section) {
  PointFields fields;
  for (const char* axis : {"x", "y", "z"}) fields.Add(axis, FieldType::kF32);
  const auto types = cloud::ExactTypesOf(section);
  // A layout has at most kMaxFields fields. Three of them are x, y and z.
  for (std::size_t k = 0; types && k < types->size() && k + 3 < PointFields::kMaxFields; ++k)
    fields.Add(NameOf((*types)[k], fields), (*types)[k]);
  return {fields, fields.MinimumStep()};
}

/// Encodes the points again with all other fields and their order. Checks that decoding returns the
/// same values.
void CheckExact(const CloudLayout& layout, const std::vector<std::uint8_t>& raw) {
  cloud::ExactChoice choice;
  choice.fields = ExactFields(layout.fields);
  choice.keeps_order = true;
  auto encoder = cloud::CloudEncoder::Create(layout, choice);
  encoder->Load({raw.data(), raw.size()}, false);
  EncodedSlice slice;
  if (encoder->Encode({0.02, 0, 0}, &slice) != SliceResult::kEncoded) return;
  cloud::ExactDecoder decoder(choice.fields, kMaxPoints);
  FUZZ_CHECK(decoder.Decode({slice.bytes.data(), slice.bytes.size()}));
  FUZZ_CHECK(decoder.size() == encoder->returns());
  std::vector<std::uint8_t> again(decoder.size() * layout.point_step);
  decoder.Write(layout, again.data());
  XyzCloud points;
  std::vector<std::uint32_t> rows;
  ReadXyz({raw.data(), raw.size()}, layout, false, &points, &rows);
  constexpr std::size_t kXyz = 3 * sizeof(float);
  for (std::size_t i = 0; i < rows.size(); ++i)
    FUZZ_CHECK(std::memcmp(&again[i * layout.point_step + kXyz],
                           &raw[rows[i] * layout.point_step + kXyz],
                           layout.point_step - kXyz) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cloud::CloudDecoder geometry(kMaxPoints);
  const bool has_points = geometry.Decode({data, size});
  const CloudLayout layout = LayoutFor(has_points ? geometry.exact_section() : ByteView());
  cloud::ExactDecoder decoder(ExactFields(layout.fields), kMaxPoints);
  // Decodes the slice twice, because the first decoding must not change the result of the second
  // one.
  const bool first = decoder.Decode({data, size});
  FUZZ_CHECK(first == decoder.Decode({data, size}));
  FUZZ_CHECK(has_points || !first);
  if (!has_points) return 0;
  const XyzCloud& decoded = geometry.cloud();
  FUZZ_CHECK(decoded.xyz == decoder.geometry().cloud().xyz && decoded.size() <= kMaxPoints);
  FUZZ_CHECK(decoded.intensity.size() == (geometry.intensity_bits() > 0 ? decoded.size() : 0));
  for (const float v : decoded.xyz) FUZZ_CHECK(std::isfinite(v));

  // The points of an accepted slice can be encoded again, and their number does not change.
  std::vector<std::uint8_t> raw(decoded.size() * layout.point_step);
  first ? decoder.Write(layout, raw.data()) : WriteXyz(decoded, layout, raw.data());
  auto encoder = cloud::CloudEncoder::Create(layout);
  encoder->Load({raw.data(), raw.size()}, false);
  const std::size_t returns = encoder->returns();
  EncodedSlice slice;
  if (encoder->Encode({geometry.error_m(), 0, 0}, &slice) != SliceResult::kEncoded) return 0;
  if (first && !geometry.exact_section().empty()) CheckExact(layout, raw);
  FUZZ_CHECK(geometry.Decode({slice.bytes.data(), slice.bytes.size()}));
  FUZZ_CHECK(geometry.cloud().size() == returns);
  return 0;
}
