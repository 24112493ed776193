// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/range_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "src/base/byte_writer.h"
#include "src/base/crc.h"

namespace lidar::codec {
namespace {

// The values of the first byte in a payload of kTemporal.
constexpr std::uint8_t kStandsAlone = 0;
constexpr std::uint8_t kHasReference = 1;

bool HasGaps(const RangeImage& image) {
  return std::find(image.ranges.begin(), image.ranges.end(), 0U) != image.ranges.end();
}

/// Returns a grid with two thirds of the step of `grid`. For most ranges, one or two of its bins
/// decode to a range within the error of `grid`.
RangeGrid FinerGrid(const RangeGrid& grid) {
  constexpr std::uint32_t kThirds = 3 * RangeGrid::kParts;
  return {grid.unit_mm(), std::max((2 * grid.parts() + kThirds / 2) / kThirds, 1U)};
}

/// Returns true if a finer grid may give a choice of bins within the same error.
bool MayChoose(const RangeSettings& settings) {
  return settings.effort >= mixing::kSearchingEffort && settings.grid.error_m() > 0;
}

std::uint32_t ErrorMm(const RangeGrid& grid) {
  return static_cast<std::uint32_t>(std::lround(1e3 * grid.error_m()));
}

/// Moves the ranges of `image` to bins of `grid`. Several bins may decode to within `error_mm` of a
/// range. Of these, the one nearest to the mean in the pixel's memory is chosen.
RangeImage AsRecalled(const RangeImage& image, const BlockMemory& memory, const RangeGrid& grid,
                      std::uint32_t error_mm) {
  RangeImage chosen = image;
  const std::uint32_t half_cell = grid.unit_mm() * PixelMemory::kPerMm / 2;
  const std::uint32_t last = grid.BinOf(RangeGrid::kMaxRangeMm);
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (image.ranges[i] == 0) continue;
    const std::uint32_t range = std::min(image.ranges[i], RangeGrid::kMaxRangeMm);
    const auto within = [&](std::uint32_t bin) {
      return grid.ComesBackWithin(error_mm, bin, range);
    };
    const PixelMemory& p = memory.pixels[i];
    std::uint32_t bin = grid.BinOf(range);
    const std::uint32_t wanted =
        p.count > 0 ? grid.BinOf((p.mean + half_cell) / PixelMemory::kPerMm) : bin;
    while (bin < std::min(wanted, last) && within(bin + 1)) ++bin;
    while (bin > wanted && within(bin - 1)) --bin;
    chosen.ranges[i] = grid.RangeOf(bin);
  }
  return chosen;
}

}  // namespace

bool RangeEncoder::Encode(const RangeImage& image, const RangeSettings& settings,
                          std::vector<std::uint8_t>* out, BlockLink* link) {
  const bool with_levels = settings.intensity.bits() > 0;
  if (image.beams != alignment_.beams() || image.columns == 0 ||
      image.columns > alignment_.columns_per_scan() ||
      image.first_column >= alignment_.columns_per_scan() || image.ranges.size() != image.size() ||
      (with_levels && image.intensity.size() != image.size())) {
    return false;
  }
  mask_bytes_.clear();
  payload_.clear();
  const auto coder = EncodePayload(image, settings, link);
  if (!coder) return false;
  RangeHeader header;
  header.coder = *coder;
  header.beams = image.beams;
  header.first_column = image.first_column;
  header.columns = image.columns;
  header.grid = grid_;
  header.intensity = settings.intensity;
  header.kept_beams = settings.kept_beams;
  header.has_gaps = has_gaps_;
  header.mask_size = static_cast<std::uint32_t>(mask_bytes_.size());
  header.payload_size = static_cast<std::uint32_t>(payload_.size());
  const std::size_t start = out->size();
  header.Write(out);
  out->insert(out->end(), mask_bytes_.begin(), mask_bytes_.end());
  out->insert(out->end(), payload_.begin(), payload_.end());
  if (link != nullptr && link->left != nullptr)
    link->left->crc = Crc32({out->data() + start, out->size() - start});
  return true;
}

/// Fills `payload_` and `mask_bytes_`. Returns the coder that was used, or nothing on failure.
std::optional<RangeCoder> RangeEncoder::EncodePayload(const RangeImage& image,
                                                      const RangeSettings& settings,
                                                      BlockLink* link) {
  if (link != nullptr) link->left = nullptr;
  grid_ = settings.grid;
  if (settings.coder == RangeCoder::kMixing) {
    has_gaps_ = HasGaps(image);
    if (link != nullptr && EncodeLinked(image, settings, link)) return RangeCoder::kTemporal;
    payload_.clear();
    if (EncodeMixing(image, settings)) return settings.coder;
  }
  CollectReturns(image, settings);
  if (settings.coder < RangeCoder::kAdaptive) {
    if (!EncodeIntegers(settings, image.columns)) return std::nullopt;
    return settings.coder;
  }
  if (settings.coder == RangeCoder::kBlended) {
    EncodeByRans(&blended_mask_, &blended_, image.columns);
    return settings.coder;
  }
  // The mixing coder refuses an image if a range is too long, or if its payload would have too few
  // bytes for so many pixels. The adaptive coder codes these images.
  EncodeByRans(&mask_coder_, &coder_, image.columns);
  return RangeCoder::kAdaptive;
}

/// Encodes an image by kMixing. Chooses between bins if that probably saves bits.
bool RangeEncoder::EncodeMixing(const RangeImage& image, const RangeSettings& settings) {
  MixingSettings mixing{settings.grid, settings.intensity, settings.effort};
  mixing.refined = settings.refined;
  if (MayChoose(settings) && ChoiceSaves(image, settings.grid)) {
    mixing.grid = grid_ = FinerGrid(settings.grid);
    mixing.error_mm = ErrorMm(settings.grid);
    if (mixing_.Encode(image, mixing, &payload_)) return true;
    mixing.grid = grid_ = settings.grid;
    mixing.error_mm = 0;
  }
  return mixing_.Encode(image, mixing, &payload_);
}

/// Returns true if a choice between bins probably saves bits. This is estimated by the adaptive
/// coder, which is ten times as fast as kMixing.
///
/// If the bins of `grid` are mostly noise, finer bins cost log2(1.5) = 0.58 bits more per return,
/// and a choice between them saves nothing. On smooth surfaces, finer bins cost less than 0.58
/// bits.
bool RangeEncoder::ChoiceSaves(const RangeImage& image, const RangeGrid& grid) {
  const double bits = AdaptiveBits(image, grid);
  const double finer = AdaptiveBits(image, FinerGrid(grid));
  // The factors were fitted to slices of captures and synthetic drives. Each slice was coded with
  // and without a choice, at 1 to 10 cm.
  return finer <= 0.85 * bits + 0.76 * static_cast<double>(returns());
}

/// Returns the number of bits that the ranges need in the adaptive coder.
double RangeEncoder::AdaptiveBits(const RangeImage& image, const RangeGrid& grid) {
  RangeSettings geometry;
  geometry.grid = grid;
  CollectReturns(image, geometry);
  EncodeByRans(&mask_coder_, &coder_, image.columns);
  const std::size_t bytes = payload_.size();
  payload_.clear();
  return 8.0 * static_cast<double>(bytes);
}

/// Encodes an image by kTemporal. Returns false if that is impossible. The image is then coded by
/// kMixing, and no later block can refer to it. If bins may be chosen, encodes the image a second
/// time, on a finer grid, and keeps the smaller payload.
bool RangeEncoder::EncodeLinked(const RangeImage& image, const RangeSettings& settings,
                                BlockLink* link) {
  const BlockMemory* reference = link->reference.get();
  if (settings.kept_beams > 0 || (reference != nullptr && !reference->Fits(image))) return false;
  if (!EncodeOn(settings.grid, 0, image, settings, link)) return false;
  if (reference == nullptr || !MayChoose(settings)) return true;
  const RangeGrid finer = FinerGrid(settings.grid);
  const std::uint32_t error_mm = ErrorMm(settings.grid);
  std::vector<std::uint8_t> first;
  first.swap(payload_);
  BlockLink again{link->reference, nullptr};
  if (EncodeOn(finer, error_mm, AsRecalled(image, *reference, finer, error_mm), settings, &again) &&
      payload_.size() < first.size()) {
    grid_ = finer;
    link->left = std::move(again.left);
  } else {
    payload_.swap(first);
  }
  return true;
}

/// Writes one payload of kTemporal. If `error_mm` is above 0, the bins of `image` were chosen
/// within this error.
bool RangeEncoder::EncodeOn(const RangeGrid& grid, std::uint32_t error_mm, const RangeImage& image,
                            const RangeSettings& settings, BlockLink* link) {
  const BlockMemory* reference = link->reference.get();
  RangeImage decoded = image;
  for (std::uint32_t& range : decoded.ranges) {
    if (range == 0) continue;
    range = grid.RangeOf(grid.BinOf(std::min(range, RangeGrid::kMaxRangeMm)));
  }
  auto left = Remember(decoded, grid, reference);
  MixingSettings mixing{grid, settings.intensity, settings.effort, {}, error_mm};
  ByteWriter writer(&payload_);
  writer.U8(reference != nullptr ? kHasReference : kStandsAlone);
  if (reference != nullptr) {
    writer.Le32(reference->crc);
    mixing.memory = {reference->pixels.data(), &left->model};
  }
  if (!mixing_.Encode(image, mixing, &payload_)) return false;
  link->left = std::move(left);
  return true;
}

void RangeEncoder::CollectReturns(const RangeImage& image, const RangeSettings& settings) {
  mask_.resize(image.size());
  lists_.values.resize(image.size());
  // The loop computes BinOf() without divisions. `half_part` is added so that a quotient is never
  // close to an integer. Rounding therefore cannot change a bin.
  const RangeGrid& grid = settings.grid;
  const double per_mm = RangeGrid::kParts / (1.0 * grid.parts() * grid.unit_mm());
  const double half_part = 0.5 / grid.parts();
  const std::size_t size = image.size();
  const std::uint32_t* const ranges = image.ranges.data();
  std::uint8_t* const mask = mask_.data();
  for (std::size_t i = 0; i < size; ++i) mask[i] = ranges[i] != 0 ? 1 : 0;
  std::int32_t* const values = lists_.values.data();
  std::size_t count = 0;
  // Several pixels are tested at once, because most of them are empty if the cloud coder has put
  // the near points into cells.
  constexpr std::size_t kAtOnce = 8;
  for (std::size_t first = 0; first < size; first += kAtOnce) {
    const std::size_t end = std::min(first + kAtOnce, size);
    std::uint64_t returns = 0;
    std::memcpy(&returns, mask + first, end - first);
    if (returns == 0) continue;
    for (std::size_t i = first; i < end; ++i) {
      const auto range = static_cast<std::int32_t>(std::min(ranges[i], RangeGrid::kMaxRangeMm));
      values[count] = static_cast<std::int32_t>(range * per_mm + half_part);
      count += mask[i];
    }
  }
  lists_.values.resize(count);
  has_gaps_ = count < mask_.size();
  lists_.levels.resize(settings.intensity.bits() > 0 ? count : 0);
  if (lists_.levels.empty()) return;
  std::array<std::uint8_t, 256> coarse{};
  for (unsigned i = 0; i < coarse.size(); ++i)
    coarse[i] = settings.intensity.Coarsen(static_cast<std::uint8_t>(i));
  std::size_t next = 0;
  for (std::size_t i = 0; i < image.size(); ++i)
    if (mask_[i] != 0) lists_.levels[next++] = coarse[image.intensity[i]];
}

template <class Masks, class Coder>
void RangeEncoder::EncodeByRans(Masks* mask_coder, Coder* coder, std::uint32_t columns) {
  rans_.Start(MaskCoder::Pieces(alignment_.beams(), columns) +
              Coder::kMostPieces * (lists_.values.size() + lists_.levels.size()));
  if (has_gaps_) mask_coder->Encode(mask_, alignment_, columns, &rans_);
  coder->Encode({alignment_, mask_, columns}, lists_, &rans_);
  rans_.Finish(&payload_);
}

bool RangeEncoder::EncodeIntegers(const RangeSettings& settings, std::uint32_t columns) {
  if (integers_ == nullptr) return false;
  if (has_gaps_) {
    rans_.Start(MaskCoder::Pieces(alignment_.beams(), columns));
    mask_coder_.Encode(mask_, alignment_, columns, &rans_);
    rans_.Finish(&mask_bytes_);
  }
  if (returns() == 0) return true;
  if (settings.coder == RangeCoder::kResidual)
    coder_.ToResiduals({alignment_, mask_, columns}, &lists_);
  return integers_->Encode(lists_, settings.coder == RangeCoder::kDraco, &payload_);
}

bool RangeDecoder::Decode(ByteReader* reader, std::size_t max_points, RangeImage* image,
                          IntensityScale* scale, BlockStore* store) {
  lacks_reference_ = false;
  ByteReader whole = *reader;
  const auto header = RangeHeader::Read(reader);
  if (!header || header->beams != alignment_.beams() ||
      header->columns > alignment_.columns_per_scan() ||
      header->first_column >= alignment_.columns_per_scan() ||
      std::size_t{header->beams} * header->columns > max_points) {
    return false;
  }
  header_ = *header;
  image->beams = header->beams;
  image->columns = header->columns;
  image->first_column = header->first_column;
  *scale = header->intensity;
  const ByteView mask = reader->Bytes(header->mask_size);
  const ByteView payload = reader->Bytes(header->payload_size);
  image->intensity.assign(header->intensity.bits() > 0 ? image->size() : 0, 0);
  if (header->coder == RangeCoder::kMixing)
    return mixing_.Decode(payload, header->grid, header->intensity.bits(), image);
  if (header->coder == RangeCoder::kTemporal) {
    std::shared_ptr<BlockMemory> left;
    if (!DecodeLinked(*header, payload, store, image, &left)) return false;
    if (left == nullptr) return true;
    left->crc = Crc32(whole.Bytes(reader->position() - whole.position()));
    store->Add(std::move(left));
    return true;
  }
  mask_.assign(image->size(), 1);
  switch (header->coder) {
    case RangeCoder::kAdaptive:
      return DecodeByRans(&mask_coder_, &coder_, *header, payload, image);
    case RangeCoder::kBlended:
      return DecodeByRans(&blended_mask_, &blended_, *header, payload, image);
    default:
      return DecodeIntegers(*header, mask, payload, image);
  }
}

double RangeDecoder::error_m() const {
  const bool mixes = header_.coder == RangeCoder::kMixing || header_.coder == RangeCoder::kTemporal;
  const bool was_chosen = mixes && mixing_.error_mm() > 0;
  return was_chosen ? 1e-3 * mixing_.error_mm() : header_.grid.error_m();
}

/// Decodes a payload of kTemporal. If `store` is not null, sets `left` to the memory after the
/// block, which the caller adds to `store`.
bool RangeDecoder::DecodeLinked(const RangeHeader& header, ByteView payload, BlockStore* store,
                                RangeImage* image, std::shared_ptr<BlockMemory>* left) {
  ByteReader reader(payload);
  const std::uint8_t kind = reader.U8();
  if (kind != kStandsAlone && kind != kHasReference) return false;
  const unsigned bits = header.intensity.bits();
  if (kind == kStandsAlone) {
    if (!mixing_.Decode(reader.Rest(), header.grid, bits, image)) return false;
    if (store != nullptr) *left = Remember(*image, header.grid, nullptr);
    return true;
  }
  const std::uint32_t crc = reader.Le32();
  if (!reader.ok()) return false;
  const BlockMemoryPtr reference = store != nullptr ? store->Recall(crc, *image) : nullptr;
  lacks_reference_ = reference == nullptr;
  if (lacks_reference_) return false;
  const auto model = std::make_unique<mixing::TemporalModel>(reference->model);
  if (!mixing_.Decode(reader.Rest(), header.grid, bits, image,
                      {reference->pixels.data(), model.get()})) {
    return false;
  }
  *left = Remember(*image, header.grid, reference.get());
  (*left)->model = *model;
  return true;
}

template <class Masks, class Coder>
bool RangeDecoder::DecodeByRans(Masks* mask_coder, Coder* coder, const RangeHeader& header,
                                ByteView payload, RangeImage* image) {
  RansDecoder rans(payload, Coder::kMostPieces * header.columns, &padded_);
  if (header.has_gaps && !mask_coder->Decode(alignment_, header.columns, &rans, &mask_))
    return false;
  const BlockShape shape{alignment_, mask_, header.columns};
  return coder->Decode(shape, header.grid, &rans, image) && rans.AtEnd();
}

bool RangeDecoder::DecodeIntegers(const RangeHeader& header, ByteView mask, ByteView payload,
                                  RangeImage* image) {
  if (integers_ == nullptr) return false;
  if (header.has_gaps) {
    RansDecoder rans(mask, header.columns, &padded_);
    if (!mask_coder_.Decode(alignment_, header.columns, &rans, &mask_) || !rans.AtEnd())
      return false;
  }
  const auto returns =
      static_cast<std::uint32_t>(std::count(mask_.begin(), mask_.end(), std::uint8_t{1}));
  lists_.values.resize(returns);
  lists_.levels.resize(image->intensity.empty() ? 0 : returns);
  if (returns == 0) {
    image->ranges.assign(image->size(), 0);
    return payload.empty();
  }
  if (!integers_->Decode(payload, returns, !lists_.levels.empty(), &lists_)) return false;
  if (header.coder == RangeCoder::kResidual &&
      !coder_.FromResiduals({alignment_, mask_, header.columns}, &lists_)) {
    return false;
  }
  if (!header.grid.ToRanges(&lists_.values)) return false;
  Scatter(image);
  return true;
}

void RangeDecoder::Scatter(RangeImage* image) {
  image->ranges.resize(image->size());
  // These extra entries are read, but not used, if the last pixels have no return.
  lists_.values.push_back(0);
  lists_.levels.push_back(0);
  std::size_t next = 0;
  for (std::size_t i = 0; i < image->size(); ++i) {
    image->ranges[i] = static_cast<std::uint32_t>(lists_.values[next]) & (0U - mask_[i]);
    next += mask_[i];
  }
  next = 0;
  for (std::size_t i = 0; i < image->intensity.size(); ++i) {
    image->intensity[i] = static_cast<std::uint8_t>(lists_.levels[next] & (0U - mask_[i]));
    next += mask_[i];
  }
}

}  // namespace lidar::codec
