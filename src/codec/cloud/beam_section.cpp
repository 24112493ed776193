// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_section.h"

#include <algorithm>
#include <cmath>

#include "src/codec/block_store.h"
#include "src/codec/cloud/beam_part.h"
#include "src/codec/cloud/pixel_part.h"
#include "src/codec/effort_control.h"
#include "src/codec/mixing/binary_coder.h"
#include "src/codec/varint.h"

namespace lidar::codec::cloud {
namespace {

/// Makes a sensor model with the beams and columns of the table. The range coder needs one.
SensorModel ModelOf(const BeamTable& table) {
  SensorModel model;
  model.columns_per_scan = table.columns();
  model.beams.resize(table.rows());
  return model;
}

std::vector<std::int32_t> BinsOf(const RangeImage& image, const RangeGrid& grid) {
  const RangeGrid::BinFinder finder(grid);
  std::vector<std::int32_t> bins(image.size());
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const std::uint32_t range = image.ranges[i];
    bins[i] = range == 0 ? -1 : static_cast<std::int32_t>(finder.Of(range));
  }
  return bins;
}

/// The sum of the logarithms of many factors. For speed, factors are multiplied, and the logarithm
/// of their product is computed only now and then.
class LogSum {
 public:
  /// Adds the logarithm of `factor`, which is from 1 to 2^23.
  void Add(double factor) {
    constexpr double kLarge = 0x1p900;
    product_ *= factor;
    if (product_ < kLarge) return;
    bits_ += std::log2(product_);
    product_ = 1;
  }
  double bits() const { return bits_ + std::log2(product_); }

 private:
  double product_ = 1;
  double bits_ = 0;
};

/// Returns the guess with which the residuals need the fewest bits.
ResidualGuess BestGuess(const RangeImage& image, std::uint32_t tangent_um,
                        const std::vector<std::int32_t>& residuals) {
  std::array<LogSum, kResidualGuesses> costs{};
  std::vector<std::int32_t> of_column(image.columns, 0);
  for (std::uint32_t beam = 0; beam < image.beams; ++beam) {
    std::array<std::int32_t, 2> last{};
    for (std::uint32_t column = 0; column < image.columns; ++column) {
      const std::size_t pixel = std::size_t{beam} * image.columns + column;
      if (image.ranges[pixel] == 0) continue;
      const double per_width = 1.0 / ResidualWidth(tangent_um, image.ranges[pixel]);
      const std::array<std::int32_t, kResidualGuesses> guesses = {0, of_column[column], last[0],
                                                                  last[1]};
      for (unsigned k = 0; k < kResidualGuesses; ++k)
        costs[k].Add(1 + std::abs(residuals[pixel] - guesses[k]) * per_width);
      last = {residuals[pixel], last[0]};
      of_column[column] = residuals[pixel];
    }
  }
  const auto best =
      std::min_element(costs.begin(), costs.end(),
                       [](const LogSum& a, const LogSum& b) { return a.bits() < b.bits(); }) -
      costs.begin();
  return static_cast<ResidualGuess>(best);
}

RangeSettings SettingsOf(const PixelErrors& errors, const PointLevels& levels, const RangeWay& way,
                         const RangeImage& image) {
  RangeSettings settings;
  settings.coder = way.coder;
  settings.effort = way.effort;
  settings.refined = true;
  settings.grid = RangeGrid::ForError(errors.range_m, CommonUnit(image.ranges, 1));
  if (levels.levels != nullptr) settings.intensity = levels.scale;
  return settings;
}

std::vector<ExtraBin> ExtraBins(const PixelList& list, const std::vector<std::int32_t>& bins,
                                const RangeGrid& grid, const PointLevels& levels) {
  std::vector<ExtraBin> extras;
  for (const ExtraReturn& e : list.extras) {
    const auto bin = static_cast<std::int32_t>(grid.BinOf(e.range_mm));
    std::uint8_t level = 0;
    if (levels.levels != nullptr) level = levels.scale.Coarsen((*levels.levels)[e.point]);
    extras.push_back({e.pixel, bin - bins[e.pixel], level});
  }
  return extras;
}

/// Sets `decoded` to the ranges that a decoder gets for `image`, and `grid` to the grid of these
/// ranges.
bool ComeBack(const RangeImage& image, const RangeSettings& settings,
              const std::vector<std::uint8_t>& block, const BeamTable& table, RangeImage* decoded,
              RangeGrid* grid) {
  if (settings.effort < EffortControl::kHighest) {
    *grid = settings.grid;
    const RangeGrid::BinFinder bins(*grid);
    decoded->beams = image.beams;
    decoded->columns = image.columns;
    decoded->ranges.resize(image.size());
    for (std::size_t i = 0; i < image.size(); ++i) {
      const std::uint32_t range = image.ranges[i];
      decoded->ranges[i] = range == 0 ? 0 : grid->RangeOf(bins.Of(range));
    }
    return true;
  }
  // The encoder may have chosen bins other than the nearest ones, so `block` is decoded.
  RangeDecoder decoder(ModelOf(table));
  IntensityScale scale;
  ByteReader reader(block.data(), block.size());
  if (!decoder.Decode(&reader, kMostPixels, decoded, &scale)) return false;
  *grid = decoder.header().grid;
  return true;
}

/// Codes residuals with errors of up to `settings->tangent_um`. If that is 0, codes nothing.
void EncodeResiduals(const RangeImage& image, ResidualSettings* settings,
                     std::vector<std::int32_t>* residuals, mixing::BinaryEncoder* bits) {
  if (settings->tangent_um == 0) return;
  settings->guess = BestGuess(image, settings->tangent_um, *residuals);
  CodeResiduals(image, *settings, residuals, bits);
}

/// A flag in the byte with the guess of the azimuths. It says that further returns are coded in the
/// context of four neighbours.
constexpr unsigned kByFourFlag = 4;

void WriteSettings(const ResidualSettings& settings, unsigned flag, ByteWriter* writer) {
  WriteVarint(settings.tangent_um, writer);
  writer->U8(static_cast<std::uint8_t>(static_cast<unsigned>(settings.guess) | flag));
}

}  // namespace

RangeEncoder* BeamSectionEncoder::CoderOf(const BeamTable& table) {
  if (coder_ == nullptr || table.rows() != rows_ || table.columns() != columns_) {
    coder_ = std::make_unique<RangeEncoder>(ModelOf(table));
    rows_ = table.rows();
    columns_ = table.columns();
  }
  return coder_.get();
}

bool BeamSectionEncoder::Encode(BeamTable table, const PixelErrors& errors,
                                const PointLevels& levels, const RangeWay& way, PixelList* list,
                                std::vector<std::uint8_t>* out) {
  RangeImage& image = list->image;
  table.bends = errors.bend_um > 0;
  if (levels.levels != nullptr) {
    image.intensity.assign(image.size(), 0);
    for (std::size_t i = 0; i < image.size(); ++i)
      if (image.ranges[i] != 0) image.intensity[i] = (*levels.levels)[list->points[i]];
  }
  std::vector<std::uint8_t> block;
  const RangeSettings settings = SettingsOf(errors, levels, way, image);
  if (!CoderOf(table)->Encode(image, settings, &block)) return false;
  // Residuals are coded by the decoded ranges, further returns only by the decoded bins. Below the
  // highest effort, the decoded bins are those of `image`.
  RangeImage decoded;
  RangeGrid grid = settings.grid;
  const bool has_extras = !list->extras.empty();
  const bool has_residuals = errors.tangent_um > 0 || errors.bend_um > 0;
  const bool bins_suffice = !has_residuals && settings.effort < EffortControl::kHighest;
  if ((has_extras || has_residuals) && !bins_suffice &&
      !ComeBack(image, settings, block, table, &decoded, &grid)) {
    return false;
  }
  std::vector<std::int32_t> bins;
  if (has_extras) bins = BinsOf(bins_suffice ? image : decoded, grid);
  auto extras = ExtraBins(*list, bins, grid, levels);

  ResidualSettings azimuths{errors.tangent_um, ResidualGuess::kNone};
  ResidualSettings elevations{errors.bend_um, ResidualGuess::kNone};
  std::vector<std::uint8_t> stream;
  mixing::BinaryEncoder bits(&stream);
  if (!table.has_path() && !CodeBeams(&table, &bits)) return false;
  if (table.grains > 0) CodePlaces(&table, &bits);
  if (table.has_path()) CodePath(&table.path, &bits);
  EncodeResiduals(decoded, &azimuths, &list->residuals, &bits);
  EncodeResiduals(decoded, &elevations, &list->bends, &bits);
  if (!extras.empty())
    CodeExtras(bins, image.columns, {settings.intensity.bits(), true, extras.size()}, &extras,
               &bits);
  bits.Finish();

  ByteWriter writer(out);
  table.Write(&writer);
  WriteSettings(azimuths, extras.empty() ? 0 : kByFourFlag, &writer);
  if (table.bends) WriteSettings(elevations, 0, &writer);
  writer.Bytes({block.data(), block.size()});
  WriteVarint(static_cast<std::uint32_t>(extras.size()), &writer);
  WriteVarint(static_cast<std::uint32_t>(stream.size()), &writer);
  writer.Bytes({stream.data(), stream.size()});
  return true;
}

namespace {

struct DecodedSection {
  BeamTable table;
  ResidualSettings azimuths;
  ResidualSettings elevations;
  RangeGrid grid;
  IntensityScale scale;
  RangeImage image;
  std::vector<std::int32_t> residuals;
  std::vector<std::int32_t> bends;
  std::vector<BeamTable::Slope> slopes;   // one for each beam
  std::vector<PathDirection> directions;  // one for each pixel, on a path
  std::vector<ExtraBin> extras;
  bool by_four = false;  // further returns are coded in the context of four neighbours
  std::size_t returns = 0;
};

/// Reads the settings of residuals. `flag` is a bit of the guess's byte, but not of the guess. If
/// `is_set` is not null, sets it to whether this bit is 1.
bool ReadSettings(ByteReader* reader, ResidualSettings* settings, unsigned flag, bool* is_set) {
  bool ok = true;
  settings->tangent_um = ReadVarint(reader, &ok);
  const unsigned byte = reader->U8();
  const unsigned guess = byte & ~flag;
  if (is_set != nullptr) *is_set = (byte & flag) != 0;
  settings->guess = static_cast<ResidualGuess>(guess);
  return ok && reader->ok() && guess < kResidualGuesses;
}

/// Decodes `residuals`. Leaves it empty if there are no residuals in the stream.
bool DecodeResiduals(const RangeImage& image, const ResidualSettings& settings,
                     std::vector<std::int32_t>* residuals, mixing::BinaryDecoder* bits) {
  if (settings.tangent_um == 0) return true;
  residuals->assign(image.size(), 0);
  return CodeResiduals(image, settings, residuals, bits);
}

bool DecodeTable(ByteReader* reader, DecodedSection* section) {
  auto table = BeamTable::Read(reader);
  if (!table || !ReadSettings(reader, &section->azimuths, kByFourFlag, &section->by_four) ||
      (table->bends && !ReadSettings(reader, &section->elevations, 0, nullptr))) {
    return false;
  }
  section->table = *std::move(table);
  return true;
}

bool DecodeImage(ByteReader* reader, RangeDecoder* decoder, DecodedSection* section) {
  BlockStore nothing;
  RangeImage& image = section->image;
  if (!decoder->Decode(reader, kMostPixels, &image, &section->scale, &nothing) ||
      image.first_column + image.columns > section->table.columns()) {
    return false;
  }
  section->grid = decoder->header().grid;
  section->returns = image.size() - static_cast<std::size_t>(
                                        std::count(image.ranges.begin(), image.ranges.end(), 0U));
  return true;
}

bool DecodeRest(ByteReader* reader, std::size_t max_points, DecodedSection* section) {
  bool ok = true;
  const std::size_t extras = ReadVarint(reader, &ok);
  const ByteView stream = reader->Bytes(ReadVarint(reader, &ok));
  if (!ok || !reader->ok() || section->returns + extras > max_points) return false;
  mixing::BinaryDecoder bits(stream);
  if (section->table.beams_follow && !section->table.has_path() &&
      !CodeBeams(&section->table, &bits)) {
    return false;
  }
  if (section->table.grains > 0 && !CodePlaces(&section->table, &bits)) return false;
  if (section->table.has_path() && !CodePath(&section->table.path, &bits)) return false;
  if (!DecodeResiduals(section->image, section->azimuths, &section->residuals, &bits) ||
      !DecodeResiduals(section->image, section->elevations, &section->bends, &bits)) {
    return false;
  }
  const ExtraSettings settings{section->scale.bits(), section->by_four, extras};
  if (extras > 0 && !CodeExtras(BinsOf(section->image, section->grid), section->image.columns,
                                settings, &section->extras, &bits)) {
    return false;
  }
  return section->extras.size() == extras && bits.AtEnd();
}

/// Computes the points of pixels and appends them to a cloud.
class PixelWriter {
 public:
  /// Makes room for all points of the section after the points that `cloud` already has.
  PixelWriter(const DecodedSection& section, XyzCloud* cloud, PointPlaces* places)
      : section_(section), angles_(section.table), cloud_(*cloud), places_(places) {
    const std::size_t before = cloud->xyz.size();
    cloud->xyz.resize(before + 3 * (section.returns + section.extras.size()));
    next_ = cloud->xyz.data() + before;
  }
  void Write(std::uint32_t beam, std::uint32_t column, std::size_t pixel, std::uint32_t range_mm,
             std::uint8_t level) {
    const BeamTable& table = section_.table;
    const bool has_path = table.has_path();
    const PathDirection direction =
        has_path ? section_.directions[pixel]
                 : PathDirection{table.beams[beam].offset + angles_.Of(beam, column),
                                 table.beams[beam].elevation};
    const BeamTable::Slope slope = table.bends || has_path
                                       ? BeamTable::Slope(direction.elevation + BendOf(pixel))
                                       : section_.slopes[beam];
    const std::int32_t residual = section_.residuals.empty() ? 0 : section_.residuals[pixel];
    for (const float v : table.At(beam, direction.azimuth + residual, slope, range_mm))
      *next_++ = v;
    if (places_ != nullptr) places_->points.push_back({beam, column});
    if (section_.scale.bits() > 0) cloud_.intensity.push_back(section_.scale.ValueOf(level));
  }

 private:
  std::int32_t BendOf(std::size_t pixel) const {
    return section_.bends.empty() ? 0 : section_.bends[pixel];
  }

  const DecodedSection& section_;
  ColumnAngles angles_;
  XyzCloud& cloud_;
  PointPlaces* places_;
  float* next_;
};

}  // namespace

bool BeamSectionDecoder::Decode(ByteReader* reader, std::size_t max_points,
                                const IntensityScale& scale, XyzCloud* cloud, PointPlaces* places) {
  DecodedSection section;
  if (!DecodeTable(reader, &section)) return false;
  const BeamTable& table = section.table;
  if (decoder_ == nullptr || table.rows() != rows_ || table.columns() != columns_) {
    decoder_ = std::make_unique<RangeDecoder>(ModelOf(table));
    rows_ = table.rows();
    columns_ = table.columns();
  }
  if (!DecodeImage(reader, decoder_.get(), &section) || section.scale.bits() != scale.bits() ||
      section.scale.full() != scale.full() || !DecodeRest(reader, max_points, &section)) {
    return false;
  }
  for (const BeamTable::Beam& beam : section.table.beams)
    section.slopes.emplace_back(beam.elevation);
  if (section.table.has_path())
    section.directions =
        BeamPath(section.table.rate, section.table.columns())
            .Trace(section.table.path, section.image.first_column, section.image.columns);
  if (places != nullptr) *places = {section.table.rows(), section.table.columns(), {}};
  PixelWriter writer(section, cloud, places);
  const RangeImage& image = section.image;
  auto extra = section.extras.begin();
  const auto is_valid = [](std::uint32_t range_mm) {
    return range_mm > 0 && range_mm <= RangeGrid::kMaxRangeMm;
  };
  const auto last_bin = static_cast<std::int64_t>(section.grid.BinOf(RangeGrid::kMaxRangeMm));
  std::size_t pixel = 0;
  for (std::uint32_t beam = 0; beam < image.beams; ++beam)
    for (std::uint32_t i = 0; i < image.columns; ++i, ++pixel) {
      if (image.ranges[pixel] == 0) continue;
      const std::uint32_t column = image.first_column + i;
      const std::uint8_t level = image.intensity.empty() ? std::uint8_t{0} : image.intensity[pixel];
      if (!is_valid(image.ranges[pixel])) return false;
      writer.Write(beam, column, pixel, image.ranges[pixel], level);
      for (; extra != section.extras.end() && extra->pixel == pixel; ++extra) {
        const std::int64_t bin = std::int64_t{section.grid.BinOf(image.ranges[pixel])} + extra->bin;
        if (bin < 0 || bin > last_bin) return false;
        const std::uint32_t range = section.grid.RangeOf(static_cast<std::uint32_t>(bin));
        if (!is_valid(range)) return false;
        writer.Write(beam, column, pixel, range, extra->level);
      }
    }
  return true;
}

}  // namespace lidar::codec::cloud
