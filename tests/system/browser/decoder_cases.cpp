// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes streams, and the native decoder's results for them, for decoder_test.mjs:
//   decoder_cases GOLDEN_FOLDER CORPUS_FOLDER
// Numbers are u32, little-endian. A stream is a name, a sensor model (empty: points), the count of
// slices, and each slice with its result, the count of its points, and the points as RawPoint.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>

#include "src/codec/cloud/cloud_decoder.h"
#include "src/codec/cloud/cloud_encoder.h"
#include "src/codec/slice_decoder.h"
#include "tests/core/codec/golden.h"
#include "tests/core/codec/test_clouds.h"

namespace lidar {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kMaxPoints = 1U << 17;
constexpr std::uint32_t kDamaged = UINT32_MAX;
constexpr std::uint32_t kLacksReference = UINT32_MAX - 1;

void Put(std::uint32_t number) { std::fwrite(&number, sizeof number, 1, stdout); }
void PutBytes(const Bytes& bytes) {
  Put(static_cast<std::uint32_t>(bytes.size()));
  std::fwrite(bytes.data(), 1, bytes.size(), stdout);
}

void PutResult(std::uint32_t result, std::size_t points, const Bytes& raw) {
  Put(result);
  Put(static_cast<std::uint32_t>(points));
  std::fwrite(raw.data(), 1, raw.size(), stdout);
}

void PutStream(const std::string& name, const std::optional<SensorModel>& model,
               const std::vector<Bytes>& slices) {
  PutBytes({name.begin(), name.end()});
  PutBytes(model ? model->Serialise() : Bytes());
  Put(static_cast<std::uint32_t>(slices.size()));
  const codec::CloudLayout layout = test::OrganisedLayout();
  std::optional<codec::SliceDecoder> ranges;
  // The sensor model is serialised and parsed, as it is on the way to a receiver.
  if (model) {
    const Bytes sent = model->Serialise();
    ranges.emplace(codec::CloudFormat{layout, static_cast<std::uint32_t>(model->beams.size()),
                                      SensorModel::Parse({sent.data(), sent.size()})},
                   kMaxPoints);
  }
  codec::cloud::CloudDecoder cloud(kMaxPoints);
  for (const Bytes& slice : slices) {
    PutBytes(slice);
    Bytes raw;
    if (!ranges) {
      const bool good = cloud.Decode({slice.data(), slice.size()});
      raw.resize(good ? cloud.cloud().size() * layout.point_step : 0);
      if (good) codec::WriteXyz(cloud.cloud(), layout, raw.data());
      PutResult(good ? 0 : kDamaged, raw.size() / layout.point_step, raw);
      continue;
    }
    const auto shape = ranges->Decode({slice.data(), slice.size()});
    if (!shape) {
      PutResult(ranges->lacks_reference() ? kLacksReference : kDamaged, 0, raw);
      continue;
    }
    const std::size_t points = std::size_t{shape->width} * shape->height;
    raw.resize(points * layout.point_step);
    ranges->Write(raw.data());
    PutResult(0, points, raw);
  }
}

/// Writes the stream once more with damaged slices after the first slice, which stays intact.
void PutDamaged(const std::string& name, const std::optional<SensorModel>& model,
                const std::vector<Bytes>& slices, unsigned count) {
  std::mt19937 random(7);
  std::vector<Bytes> damaged = {slices[0]};
  for (unsigned i = 0; i < count; ++i) {
    Bytes bytes = slices[i % slices.size()];
    for (unsigned hits = 1 + random() % 4; hits > 0; --hits) {
      const std::size_t reach =
          random() % 2 == 0 ? std::min<std::size_t>(64, bytes.size()) : bytes.size();
      bytes[random() % reach] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    if (random() % 8 == 0) bytes.resize(random() % bytes.size());
    damaged.push_back(bytes);
  }
  PutStream(name + ", damaged", model, damaged);
}

void PutBoth(const std::string& name, const std::optional<SensorModel>& model,
             const std::vector<Bytes>& slices) {
  PutStream(name, model, slices);
  PutDamaged(name, model, slices, 60);
}

Bytes ReadFile(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::filesystem::path> FilesOf(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry);
  std::sort(files.begin(), files.end());
  return files;
}

/// Writes the golden blocks. They were encoded for the sensor that GoldenSensor() returns.
void PutGolden(const std::filesystem::path& folder) {
  for (const auto& file : FilesOf(folder)) {
    const std::string name = file.stem();
    if (name.find("dependent") != std::string::npos) continue;
    const Bytes bytes = ReadFile(file);
    if (name.find("temporal") == 0) {
      const Bytes dependent = ReadFile(folder / (name.substr(0, 9) + "_dependent.bin"));
      PutBoth(name, test::GoldenSensor(16, 256), {bytes, dependent});
      PutStream(name + ", lost", test::GoldenSensor(16, 256), {dependent, bytes, dependent});
      continue;
    }
    ByteReader reader(bytes.data(), bytes.size());
    const auto header = codec::RangeHeader::Read(&reader);
    if (header) PutBoth(name, test::GoldenSensor(header->beams, 1024), {bytes});
  }
}

/// Writes three scans of a room. Each of their two slices refers to the same slice of the previous
/// scan if the effort is above 0.
void PutRoom(unsigned effort) {
  const SensorModel model = test::RoomSensor();
  codec::RangeEncoder encoder(model);
  codec::RangeSettings settings;
  settings.coder = effort == 0 ? codec::RangeCoder::kAdaptive : codec::RangeCoder::kMixing;
  settings.effort = effort;
  settings.grid = RangeGrid(1, 41);
  settings.intensity = codec::IntensityScale(codec::FullScale::kByte, 5);
  std::vector<Bytes> slices;
  codec::BlockLink links[2];
  for (std::uint32_t scan = 0; scan < 3; ++scan) {
    for (std::uint32_t half = 0; half < 2; ++half) {
      codec::BlockLink& link = links[half];
      const codec::RangeImage image = test::RoomScan(model, 256 * half, 256, scan + 1);
      Bytes bytes;
      if (!encoder.Encode(image, settings, &bytes, effort == 0 ? nullptr : &link)) std::abort();
      slices.push_back(bytes);
      link.reference = std::move(link.left);
    }
  }
  PutBoth("room at effort " + std::to_string(effort), model, slices);
}

void PutClouds() {
  const SensorModel model = test::RoomSensor();
  const codec::CloudLayout layout = test::OrganisedLayout();
  for (unsigned effort = 0; effort < 5; ++effort) {
    codec::cloud::ExactChoice exact;
    // These slices contain ranges and the order of points, too. The page draws their points and
    // ignores the rest.
    if (effort == 4) exact = {{*layout.fields.Find("range")}, true};
    auto encoder = codec::cloud::CloudEncoder::Create(layout, exact);
    encoder->set_effort(std::min(effort, 3U));
    std::vector<Bytes> slices;
    for (std::uint32_t scan = 0; scan < 2; ++scan) {
      const Bytes raw = test::RawCloud(model, test::RoomScan(model, 0, 512, scan + 1));
      encoder->Load({raw.data(), raw.size()}, true);
      codec::EncodedSlice slice;
      if (encoder->Encode({0.02, 0, 5}, &slice) != codec::SliceResult::kEncoded) std::abort();
      slices.push_back(slice.bytes);
    }
    PutBoth(
        effort == 4 ? "cloud with ranges and order" : "cloud at effort " + std::to_string(effort),
        std::nullopt, slices);
  }
}

/// Returns the sensor that mixing_slice_fuzz.cpp uses if the first byte of its input is `choice`.
SensorModel CorpusSensor(unsigned choice) {
  return test::GoldenSensor((choice & 1) != 0 ? 16 : 4, (choice & 2) != 0 ? 96 : 32);
}

/// Returns a block whose payload is the input without its first byte. The header of the block has
/// the settings that mixing_slice_fuzz.cpp derives from the first byte.
Bytes BlockOf(const Bytes& input) {
  const unsigned choice = input[0];
  const SensorModel model = CorpusSensor(choice);
  codec::RangeHeader header;
  header.coder = codec::RangeCoder::kMixing;
  header.has_gaps = true;
  header.beams = static_cast<std::uint32_t>(model.beams.size());
  header.columns = (choice & 64) != 0 ? model.columns_per_scan : model.columns_per_scan / 2;
  header.grid = RangeGrid(1, 1 + (choice >> 4 & 3) * (choice >> 4 & 3) * 2'111);
  const unsigned bits = (choice & 4) == 0 ? 0 : (choice & 8) != 0 ? 8 : 5;
  header.intensity = codec::IntensityScale(codec::FullScale::kByte, bits);
  header.payload_size = static_cast<std::uint32_t>(input.size() - 1);
  Bytes block;
  header.Write(&block);
  block.insert(block.end(), input.begin() + 1, input.end());
  return block;
}

void PutCorpora(const std::filesystem::path& folder) {
  std::vector<Bytes> clouds;
  for (const auto& file : FilesOf(folder / "cloud_slice")) clouds.push_back(ReadFile(file));
  PutStream("corpus of clouds", std::nullopt, clouds);
  std::map<unsigned, std::vector<Bytes>> blocks;  // the blocks of each sensor
  for (const auto& file : FilesOf(folder / "mixing_slice")) {
    const Bytes bytes = ReadFile(file);
    if (!bytes.empty()) blocks[bytes[0] & 3U].push_back(BlockOf(bytes));
  }
  for (const auto& [sensor, of_sensor] : blocks)
    PutStream("corpus of blocks " + std::to_string(sensor), CorpusSensor(sensor), of_sensor);
}

}  // namespace
}  // namespace lidar

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  lidar::PutGolden(argv[1]);
  for (unsigned effort = 0; effort < 4; ++effort) lidar::PutRoom(effort);
  lidar::PutClouds();
  lidar::PutCorpora(argv[2]);
  return 0;
}
