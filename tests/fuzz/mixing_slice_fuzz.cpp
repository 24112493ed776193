// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes payloads of the mixing coder. The first byte of the input chooses the sensor, the number
// of intensity bits, the grid of ranges, and whether the decoder remembers earlier scans.
#include "src/codec/block_memory.h"
#include "src/codec/mixing/mixing_codec.h"
#include "src/codec/mixing/start_states.h"
#include "tests/fuzz/fuzz.h"

namespace {

// Loads the trained start states before the first input, because the time for each input is
// limited.
[[maybe_unused]] const auto& kStart = lidar::codec::mixing::Trained();

lidar::SensorModel Sensor(std::uint32_t beams, std::uint32_t columns) {
  lidar::SensorModel model;
  model.columns_per_scan = columns;
  for (std::uint32_t i = 0; i < beams; ++i)
    model.beams.push_back({0.5, 10.0 - i, static_cast<int>(i % 3)});
  return model;
}

/// Returns the memory that a decoder has after three scans with walls, poles, gaps and far returns.
std::shared_ptr<lidar::codec::BlockMemory> Before(const lidar::codec::RangeImage& like,
                                                  const lidar::RangeGrid& grid) {
  lidar::codec::RangeImage image = like;
  std::shared_ptr<lidar::codec::BlockMemory> memory;
  for (std::uint32_t scan = 0; scan < 3; ++scan) {
    image.ranges.clear();
    for (std::uint32_t i = 0; i < image.size(); ++i) {
      const std::uint32_t far = i % 31 == 7 ? lidar::RangeGrid::kMaxRangeMm - 9 : 4'000 + 11 * i;
      image.ranges.push_back(i % 13 == scan ? 0 : far + i * (scan + 1) % 7);
    }
    memory = lidar::codec::Remember(image, grid, memory.get());
  }
  return memory;
}

/// Decodes the payload once. The decoder has no memory of earlier scans if `before` is null.
bool Decode(lidar::codec::MixingDecoder* decoder, lidar::ByteView payload,
            const lidar::RangeGrid& grid, unsigned bits, const lidar::codec::BlockMemory* before,
            lidar::codec::RangeImage* image) {
  if (before == nullptr) return decoder->Decode(payload, grid, bits, image);
  const auto model = std::make_unique<lidar::codec::mixing::TemporalModel>(before->model);
  return decoder->Decode(payload, grid, bits, image, {before->pixels.data(), model.get()});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const unsigned choice = data[0];
  const lidar::SensorModel sensor = Sensor((choice & 1) != 0 ? 16 : 4, (choice & 2) != 0 ? 96 : 32);
  const unsigned bits = (choice & 4) == 0 ? 0 : (choice & 8) != 0 ? 8 : 5;
  // The four possible steps reach from 1 mm, which is lossless, to 19 m.
  const lidar::RangeGrid grid(1, 1 + (choice >> 4 & 3) * (choice >> 4 & 3) * 2'111);
  lidar::codec::RangeImage image;
  image.beams = static_cast<std::uint32_t>(sensor.beams.size());
  image.columns = (choice & 64) != 0 ? sensor.columns_per_scan : sensor.columns_per_scan / 2;
  lidar::codec::MixingDecoder decoder(sensor);
  // Decodes the slice twice, because the first decoding must not change the result of the second
  // one.
  const auto before = (choice & 128) != 0 ? Before(image, grid) : nullptr;
  const bool first = Decode(&decoder, {data + 1, size - 1}, grid, bits, before.get(), &image);
  const auto ranges = image.ranges;
  const bool second = Decode(&decoder, {data + 1, size - 1}, grid, bits, before.get(), &image);
  FUZZ_CHECK(first == second);
  if (!first) return 0;
  FUZZ_CHECK(image.ranges == ranges && ranges.size() == image.size());
  FUZZ_CHECK(image.intensity.size() == (bits > 0 ? image.size() : 0));

  // The image of an accepted payload can be encoded again. Its ranges do not change. If the encoder
  // may choose other bins, the ranges stay within the error.
  lidar::codec::MixingEncoder encoder(sensor);
  std::vector<std::uint8_t> payload;
  lidar::codec::MixingSettings settings;
  settings.grid = grid;
  settings.effort = data[1] & 3U;
  settings.error_mm = decoder.error_mm();
  const auto next = before ? lidar::codec::Remember(image, grid, before.get()) : nullptr;
  if (next) settings.memory = {before->pixels.data(), &next->model};
  if (!encoder.Encode(image, settings, &payload)) return 0;
  lidar::codec::RangeImage again = image;
  FUZZ_CHECK(Decode(&decoder, {payload.data(), payload.size()}, grid, 0, before.get(), &again));
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    FUZZ_CHECK((again.ranges[i] == 0) == (ranges[i] == 0));
    const std::int64_t moved = std::int64_t{again.ranges[i]} - ranges[i];
    FUZZ_CHECK(std::abs(moved) <= settings.error_mm);
  }
  return 0;
}
