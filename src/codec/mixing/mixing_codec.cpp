// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/mixing_codec.h"

#include <algorithm>
#include <array>
#include <optional>

#include "src/base/byte_writer.h"
#include "src/codec/mixing/range_part.h"
#include "src/codec/mixing/start_states.h"
#include "src/codec/varint.h"

namespace lidar::codec {
namespace {

using mixing::SliceBins;

// The fields in the first byte of a payload.
constexpr unsigned kEffortMask = 3;
constexpr unsigned kGapsBit = 4;
constexpr unsigned kSearchedBit = 8;
constexpr unsigned kVersionShift = 4;

bool Fits(const AzimuthAlignment& alignment, const RangeImage& image) {
  return image.beams == alignment.beams() && image.columns > 0 &&
         image.columns <= alignment.columns_per_scan();
}

std::int64_t StepMm(const RangeGrid& grid) {
  const std::int64_t parts = std::int64_t{grid.parts()} * grid.unit_mm();
  return std::max<std::int64_t>((parts + RangeGrid::kParts / 2) / RangeGrid::kParts, 1);
}

}  // namespace

void PrepareMixing() { mixing::Trained(); }

/// The buffers and models that encoder and decoder have in common.
struct MixingCoderState {
  explicit MixingCoderState(const SensorModel& sensor)
      : alignment(sensor), coder(alignment), model(std::make_unique<mixing::Model>()) {}

  template <class Coder>
  bool Code(unsigned effort, const mixing::Recollection& recollection, Coder* bits) {
    mixing::Trained().CopyTo(effort, slice.step_mm, slice.level_bits, model.get());
    if (slice.refined) model->Refine();
    return coder.Code(effort, model.get(), &slice, bits,
                      recollection.memory.pixels != nullptr ? &recollection : nullptr);
  }

  AzimuthAlignment alignment;
  mixing::SliceCoder coder;
  std::unique_ptr<mixing::Model> model;
  SliceBins slice;
};

struct MixingEncoder::State : MixingCoderState {
  using MixingCoderState::MixingCoderState;

  /// Loads the image into `slice`. Returns false if a range is too long.
  bool Load(const RangeImage& image, const MixingSettings& settings) {
    slice.beams = image.beams;
    slice.columns = image.columns;
    slice.step_mm = StepMm(settings.grid);
    slice.level_bits = settings.intensity.bits();
    slice.has_gaps = false;
    slice.refined = settings.refined && settings.effort > 1 && settings.memory.pixels == nullptr;
    slice.bins.resize(image.size());
    const std::uint32_t most = static_cast<std::uint32_t>(mixing::kMaxBins);
    const RangeGrid::BinFinder bins(settings.grid);
    for (std::size_t i = 0; i < image.size(); ++i) {
      const std::uint32_t bin = bins.Of(std::min(image.ranges[i], RangeGrid::kMaxRangeMm));
      if (bin >= most) return false;
      const bool is_gap = image.ranges[i] == 0;
      slice.has_gaps = slice.has_gaps || is_gap;
      slice.bins[i] = is_gap ? mixing::kNoReturn : static_cast<std::int32_t>(bin);
    }
    slice.spare.clear();
    if (settings.error_mm > 0 && settings.memory.pixels == nullptr) Spare(image, settings);
    slice.levels.clear();
    if (slice.level_bits == 0) return true;
    std::array<std::uint8_t, 256> coarse{};
    for (unsigned i = 0; i < coarse.size(); ++i)
      coarse[i] = settings.intensity.Coarsen(static_cast<std::uint8_t>(i));
    slice.levels.resize(image.size());
    for (std::size_t i = 0; i < image.size(); ++i) slice.levels[i] = coarse[image.intensity[i]];
    return true;
  }

  /// Finds all bins that each return may have. Sets `slice.bins` to the first of them, and
  /// `slice.spare` to the number of further bins.
  void Spare(const RangeImage& image, const MixingSettings& settings) {
    constexpr std::int32_t kMostSpare = 255;
    // A decoder refuses larger bins.
    const auto last_bin =
        std::min<std::int64_t>(settings.grid.BinOf(RangeGrid::kMaxRangeMm), mixing::kMaxBins - 1);
    slice.spare.assign(image.size(), 0);
    for (std::size_t i = 0; i < image.size(); ++i) {
      if (slice.bins[i] < 0) continue;
      const auto within = [&](std::int32_t bin) {
        return bin <= last_bin &&
               settings.grid.ComesBackWithin(settings.error_mm, static_cast<std::uint32_t>(bin),
                                             image.ranges[i]);
      };
      std::int32_t last = slice.bins[i];
      while (last - slice.bins[i] < kMostSpare / 2 && within(last + 1)) ++last;
      std::int32_t& first = slice.bins[i];
      while (first > 0 && last - first < kMostSpare && within(first - 1)) --first;
      slice.spare[i] = static_cast<std::uint8_t>(last - first);
    }
  }
};

MixingEncoder::MixingEncoder(const SensorModel& model) : state_(std::make_unique<State>(model)) {}
MixingEncoder::MixingEncoder(MixingEncoder&&) noexcept = default;
MixingEncoder& MixingEncoder::operator=(MixingEncoder&&) noexcept = default;
MixingEncoder::~MixingEncoder() = default;

bool MixingEncoder::Encode(const RangeImage& image, const MixingSettings& settings,
                           std::vector<std::uint8_t>* out) {
  State& s = *state_;
  if (!Fits(s.alignment, image) || image.ranges.size() != image.size() ||
      (settings.intensity.bits() > 0 && image.intensity.size() != image.size()) ||
      !s.Load(image, settings)) {
    return false;
  }
  const unsigned effort = std::clamp(settings.effort, 1U, mixing::kEfforts);
  const unsigned version = s.slice.refined ? mixing::kRefinedVersion : mixing::kTableVersion;
  const std::size_t before = out->size();
  ByteWriter writer(out);
  writer.U8(static_cast<std::uint8_t>(effort | (s.slice.has_gaps ? kGapsBit : 0) |
                                      (settings.error_mm > 0 ? kSearchedBit : 0) |
                                      version << kVersionShift));
  if (settings.error_mm > 0) WriteVarint(settings.error_mm, &writer);
  mixing::BinaryEncoder encoder(out);
  const bool coded = s.Code(effort, {settings.memory, settings.grid}, &encoder);
  encoder.Finish();
  const bool allowed = coded && image.size() <= MostMixedPixels(out->size() - before);
  if (!allowed) out->resize(before);
  return allowed;
}

struct MixingDecoder::State : MixingCoderState {
  using MixingCoderState::MixingCoderState;

  /// Reads the header and returns the effort. Returns nothing if the header is damaged or of
  /// another version.
  std::optional<unsigned> ReadHead(ByteReader* reader) {
    const unsigned first = reader->U8();
    const unsigned effort = first & kEffortMask;
    const unsigned version = first >> kVersionShift;
    slice.refined = version == mixing::kRefinedVersion;
    if ((version != mixing::kTableVersion && !slice.refined) || effort == 0 ||
        effort > mixing::kEfforts || (slice.refined && effort == 1)) {
      return std::nullopt;
    }
    slice.has_gaps = (first & kGapsBit) != 0;
    error_mm = 0;
    if ((first & kSearchedBit) == 0) return effort;
    bool ok = true;
    error_mm = ReadVarint(reader, &ok);
    if (!ok || !reader->ok() || error_mm == 0) return std::nullopt;
    return effort;
  }

  std::uint32_t error_mm = 0;
};

MixingDecoder::MixingDecoder(const SensorModel& model) : state_(std::make_unique<State>(model)) {}
MixingDecoder::MixingDecoder(MixingDecoder&&) noexcept = default;
MixingDecoder& MixingDecoder::operator=(MixingDecoder&&) noexcept = default;
MixingDecoder::~MixingDecoder() = default;

std::uint32_t MixingDecoder::error_mm() const { return state_->error_mm; }

bool MixingDecoder::Decode(ByteView payload, const RangeGrid& grid, unsigned intensity_bits,
                           RangeImage* image, const mixing::Memory& memory) {
  State& s = *state_;
  if (payload.empty() || image->size() > MostMixedPixels(payload.size) ||
      !Fits(s.alignment, *image) || !grid.IsValid() || intensity_bits > IntensityScale::kMaxBits) {
    return false;
  }
  ByteReader reader(payload);
  const auto effort = s.ReadHead(&reader);
  if (!effort) return false;
  s.slice.beams = image->beams;
  s.slice.columns = image->columns;
  s.slice.step_mm = StepMm(grid);
  s.slice.level_bits = intensity_bits;
  s.slice.bins.assign(image->size(), 0);
  s.slice.levels.assign(intensity_bits > 0 ? image->size() : 0, 0);
  mixing::BinaryDecoder decoder(reader.Rest());
  if (!s.Code(*effort, {memory, grid}, &decoder) || !decoder.AtEnd()) return false;
  image->ranges.resize(image->size());
  const auto last_bin = static_cast<std::int32_t>(grid.BinOf(RangeGrid::kMaxRangeMm));
  for (std::size_t i = 0; i < image->size(); ++i) {
    const std::int32_t bin = s.slice.bins[i];
    image->ranges[i] = bin < 0 ? 0 : grid.RangeOf(static_cast<std::uint32_t>(bin));
    // The range of a return is not 0, because 0 means that there is no return.
    if (bin > last_bin || (bin >= 0 && image->ranges[i] == 0)) return false;
  }
  image->intensity.assign(s.slice.levels.begin(), s.slice.levels.end());
  return true;
}

}  // namespace lidar::codec
