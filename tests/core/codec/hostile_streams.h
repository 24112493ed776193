// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks that each slice decoder must pass with damaged streams.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/core/codec/test_clouds.h"

namespace lidar::test {

constexpr std::uint32_t kHostileMaxPoints = 4096;
constexpr int kMutations = 400;

/// Returns the format of organised slices of RoomSensor().
inline codec::CloudFormat RoomFormat() { return {OrganisedLayout(), 32, RoomSensor()}; }

/// Returns the raw cloud of a slice that has at most kHostileMaxPoints points.
inline std::vector<std::uint8_t> SmallSlice() {
  const SensorModel model = RoomSensor();
  return RawCloud(model, RoomScan(model, 0, 64));
}

/// Decodes kMutations damaged copies of the stream, and returns how many of them decode. Expects
/// that each decoded cloud is within the limits.
template <class Decoder>
int CountDecodedMutations(const std::vector<std::uint8_t>& stream, Decoder* decoder) {
  std::mt19937 random(42);
  int decoded = 0;
  for (int i = 0; i < kMutations; ++i) {
    auto bytes = stream;
    const std::size_t damage = 1 + random() % 4;
    // About half of the flipped bits are in the first 64 bytes, which contain the headers.
    for (std::size_t k = 0; k < damage; ++k) {
      const std::size_t reach =
          random() % 2 == 0 ? std::min<std::size_t>(64, bytes.size()) : bytes.size();
      bytes[random() % reach] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    const auto shape = decoder->Decode({bytes.data(), bytes.size()});
    if (!shape) continue;
    ++decoded;
    const std::size_t points = std::size_t{shape->width} * shape->height;
    EXPECT_LE(points, kHostileMaxPoints);
    std::vector<std::uint8_t> raw(points * 20);
    decoder->Write(raw.data());
  }
  return decoded;
}

/// Expects that beginnings of the stream do not decode. If `all` is true, the stream without its
/// last byte must not decode either.
template <class Decoder>
void ExpectNothingOfCutStreams(const std::vector<std::uint8_t>& stream, bool all,
                               Decoder* decoder) {
  for (std::size_t n = 0; n < std::min<std::size_t>(stream.size(), 200); ++n)
    EXPECT_FALSE(decoder->Decode({stream.data(), n})) << n;
  if (all) {
    EXPECT_FALSE(decoder->Decode({stream.data(), stream.size() - 1}));
  }
  EXPECT_TRUE(decoder->Decode({stream.data(), stream.size()}));
}

/// Returns a format with fields of types that no decoder writes.
inline codec::CloudFormat OddFormat() {
  codec::CloudFormat format = RoomFormat();
  format.layout.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:U8:12,range:U8:13");
  format.layout.point_step = 14;
  return format;
}

/// Expects that the decoder sets the fields of odd types to 0 and writes nothing after the cloud.
/// `decoder` must have the format OddFormat().
template <class Decoder>
void ExpectOddFieldsToStayZero(const std::vector<std::uint8_t>& stream, Decoder* decoder) {
  const auto shape = decoder->Decode({stream.data(), stream.size()});
  ASSERT_TRUE(shape);
  const std::size_t size = std::size_t{shape->width} * shape->height * 14;
  std::vector<std::uint8_t> raw(size + 16, 0xAA);
  decoder->Write(raw.data());
  EXPECT_EQ(std::count(raw.begin() + static_cast<std::ptrdiff_t>(size), raw.end(), 0xAA), 16);
  EXPECT_EQ(raw[12], 0);
  EXPECT_EQ(raw[13], 0);
}

}  // namespace lidar::test
