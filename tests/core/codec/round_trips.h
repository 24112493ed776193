// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that pass blocks through a range encoder and a range decoder. They work with each coder.
#pragma once
#include <gtest/gtest.h>

#include <random>

#include "src/codec/range_codec.h"
#include "tests/core/codec/test_clouds.h"

namespace lidar::test {

struct CodingCase {
  codec::RangeCoder coder;
  double cells;  // per bin
  unsigned intensity_bits;
  RangeGrid grid() const { return RangeGrid::ForStep(1e-3 * cells, 1); }
};

/// An encoder and a decoder that code all slices of a test. A slice must not change how the next
/// slice is coded.
struct Codec {
  explicit Codec(const SensorModel& model, const codec::IntegerCoder* integers = nullptr)
      : encoder(model, integers), decoder(model, integers) {}
  codec::RangeEncoder encoder;
  codec::RangeDecoder decoder;
};

inline void ExpectRoundTrip(const codec::RangeImage& image, const codec::RangeSettings& settings,
                            Codec* codec) {
  codec::RangeEncoder& encoder = codec->encoder;
  codec::RangeDecoder& decoder = codec->decoder;
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(encoder.Encode(image, settings, &bytes));
  ByteReader reader(bytes.data(), bytes.size());
  codec::RangeImage back;
  codec::IntensityScale scale;
  ASSERT_TRUE(decoder.Decode(&reader, 1U << 20, &back, &scale));
  EXPECT_EQ(reader.remaining(), 0U);
  EXPECT_EQ(back.first_column, image.first_column);
  ASSERT_EQ(back.ranges.size(), image.ranges.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint32_t range = image.ranges[i];
    ASSERT_EQ(back.ranges[i], range == 0 ? 0 : settings.grid.RangeOf(settings.grid.BinOf(range)));
    if (settings.intensity.bits() > 0 && range != 0) {
      ASSERT_EQ(back.intensity[i], settings.intensity.Coarsen(image.intensity[i]));
    }
  }
}

/// Expects that the decoder refuses a block whose mask or payload is one word longer than `coder`
/// wrote it. `part` is the field of the header with the size of that mask or payload.
inline void ExpectNoWordBehind(codec::RangeCoder coder, const codec::IntegerCoder* integers,
                               std::uint32_t codec::RangeHeader::*part) {
  const SensorModel model = RoomSensor();
  Codec codec(model, integers);
  codec::RangeSettings settings;
  settings.coder = coder;
  settings.grid = RangeGrid(1, 41);
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(codec.encoder.Encode(RoomScan(model, 0, 64), settings, &bytes));
  for (const std::uint32_t more : {0U, 4U}) {
    ByteReader reader(bytes.data(), bytes.size());
    auto header = codec::RangeHeader::Read(&reader);
    ASSERT_TRUE(header);
    std::vector<std::vector<std::uint8_t>> parts;
    for (const auto size : {&codec::RangeHeader::mask_size, &codec::RangeHeader::payload_size}) {
      const ByteView view = reader.Bytes(*header.*size);
      parts.emplace_back(view.begin(), view.end());
      if (size == part) parts.back().resize(view.size + more);
    }
    *header.*part += more;
    std::vector<std::uint8_t> changed;
    header->Write(&changed);
    for (const auto& each : parts) changed.insert(changed.end(), each.begin(), each.end());
    ByteReader again(changed.data(), changed.size());
    codec::RangeImage back;
    codec::IntensityScale scale;
    EXPECT_EQ(codec.decoder.Decode(&again, 1U << 20, &back, &scale), more == 0);
  }
}

/// Expects that blocks of a room decode to the same bins. The blocks have several widths.
inline void ExpectBinsOfRooms(const CodingCase& c, const codec::IntegerCoder* integers) {
  const SensorModel model = RoomSensor();
  const codec::RangeSettings settings{
      c.coder, c.grid(), codec::IntensityScale(codec::FullScale::kByte, c.intensity_bits)};
  Codec codec(model, integers);
  ExpectRoundTrip(RoomScan(model), settings, &codec);
  ExpectRoundTrip(RoomScan(model, 448, 64), settings, &codec);
  ExpectRoundTrip(RoomScan(model, 0, 259), settings, &codec);
  ExpectRoundTrip(RoomScan(model, 0, 1), settings, &codec);
  codec.decoder = codec::RangeDecoder(model, integers);
  ExpectRoundTrip(RoomScan(model, 500, 37), settings, &codec);
}

/// Expects that blocks of noise decode to the same bins. Noise is the hardest case, because no
/// predictor helps.
inline void ExpectBinsOfNoise(const CodingCase& c, const codec::IntegerCoder* integers) {
  const SensorModel model = RoomSensor();
  std::mt19937 random(5);
  Codec codec(model, integers);
  for (const unsigned lost : {0U, 3U, 90U, 100U}) {
    codec::RangeImage image = RoomScan(model, 0, lost % 2 == 0 ? 128 : 511);
    for (std::size_t i = 0; i < image.size(); ++i) {
      image.ranges[i] =
          random() % 100 < lost ? 0 : 1 + static_cast<std::uint32_t>(random() % 250'000);
      image.intensity[i] = static_cast<std::uint8_t>(random());
    }
    ExpectRoundTrip(
        image,
        {c.coder, c.grid(), codec::IntensityScale(codec::FullScale::kByte, c.intensity_bits)},
        &codec);
    codec.decoder = codec::RangeDecoder(model, integers);
  }
}

}  // namespace lidar::test
