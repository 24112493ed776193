// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/point_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace lidar::ouster {
namespace {

constexpr std::uint32_t kPointAlignment = 4;
constexpr std::size_t kIntensityOffset = 12;
constexpr std::size_t kRangeOffset = 16;
constexpr std::size_t kRange2Offset = 20;
constexpr std::size_t kIntensity2Offset = 24;

/// A channel that is copied from a pixel of the packet. `second` is the corresponding channel of
/// the second return.
struct PixelChannel {
  std::string_view name;
  Channel channel;
  Channel second;
};
constexpr std::array<PixelChannel, 5> kPixelChannels = {{
    {"reflectivity", Channel::kReflectivity, Channel::kReflectivity2},
    {"signal", Channel::kSignal, Channel::kSignal2},
    {"near-ir", Channel::kNearIr, Channel::kNearIr},
    {"flags", Channel::kFlags, Channel::kFlags2},
    {"window", Channel::kWindow, Channel::kWindow},
}};
constexpr std::string_view kRing = "ring";
constexpr std::string_view kTime = "t";
constexpr std::string_view kRange = "range";  // a field of every point

const PixelChannel* FindPixelChannel(std::string_view name) {
  const auto* found = std::find_if(kPixelChannels.begin(), kPixelChannels.end(),
                                   [&](const PixelChannel& c) { return c.name == name; });
  return found == kPixelChannels.end() ? nullptr : found;
}

std::string_view Trim(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<std::string_view> Split(std::string_view text) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    parts.push_back(Trim(text.substr(0, comma)));
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
  return parts;
}

std::optional<double> ParseDegrees(std::string_view text) {
  text = Trim(text);
  double value = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size() || !(value >= 0) ||
      value > 360)
    return std::nullopt;
  return value;
}

std::optional<ChannelReader> ReaderFor(const PacketFormat& format, Channel channel) {
  const ChannelBits* bits = LayoutOf(format.profile).Find(channel);
  return bits == nullptr ? std::nullopt : std::make_optional<ChannelReader>(*bits);
}

std::uint32_t ToMillimetres(double metres) {
  return static_cast<std::uint32_t>(std::clamp(std::round(metres * 1e3), 0.0, 4e9));
}

template <class T>
void Store(std::uint8_t* at, T value) {
  std::memcpy(at, &value, sizeof value);
}

}  // namespace

std::optional<std::vector<std::string>> ParseChannels(std::string_view text, std::string* error) {
  std::vector<std::string> names;
  for (const std::string_view name : Split(text)) {
    if (FindPixelChannel(name) == nullptr && name != kRing && name != kTime && name != kRange) {
      *error =
          "there is no channel \"" + std::string(name) +
          "\"; the channels are range, reflectivity, signal, near-ir, flags, window, ring and t";
      return std::nullopt;
    }
    if (name != kRange && std::find(names.begin(), names.end(), name) == names.end())
      names.emplace_back(name);
  }
  return names;
}

std::optional<std::vector<Sector>> ParseSectors(std::string_view text) {
  std::vector<Sector> sectors;
  for (const std::string_view part : Split(text)) {
    const std::size_t dash = part.find('-');
    if (dash == std::string_view::npos) return std::nullopt;
    const auto first = ParseDegrees(part.substr(0, dash));
    const auto last = ParseDegrees(part.substr(dash + 1));
    if (!first || !last) return std::nullopt;
    sectors.push_back({*first, *last});
  }
  return sectors;
}

std::optional<PointWriter> PointWriter::Create(const Metadata& metadata,
                                               const PointOptions& options, std::string* error) {
  const std::string profile(ToString(metadata.format.profile));
  if (metadata.format.profile == Profile::kOff) {
    *error = "the sensor's lidar stream is switched off (udp_profile_lidar OFF)";
    return std::nullopt;
  }
  if (options.returns != Return::kStrongest && !metadata.format.has_second_return()) {
    *error = "profile " + profile + " has no second return";
    return std::nullopt;
  }
  PointWriter w;
  w.format_ = metadata.format;
  w.pixel_size_ = static_cast<std::uint32_t>(metadata.format.pixel_size());
  w.columns_ = metadata.model.columns_per_scan;
  w.projection_ = std::make_shared<PixelProjection>(metadata);
  if (!w.ChooseFields(options, error) || !w.SetFilters(options, metadata, error))
    return std::nullopt;
  return w;
}

bool PointWriter::ChooseFields(const PointOptions& options, std::string* error) {
  const bool second = options.returns == Return::kSecond;
  range_ = ReaderFor(format_, second ? Channel::kRange2 : Channel::kRange);
  intensity_ = ReaderFor(format_, second ? Channel::kReflectivity2 : Channel::kReflectivity);
  fields_.Add("x", FieldType::kF32).Add("y", FieldType::kF32).Add("z", FieldType::kF32);
  fields_.Add("intensity", FieldType::kF32).Add("range", FieldType::kU32);
  if (options.returns == Return::kBoth) {
    fields_.Add("range2", FieldType::kU32).Add("intensity2", FieldType::kF32);
    range2_ = ReaderFor(format_, Channel::kRange2);
    intensity2_ = ReaderFor(format_, Channel::kReflectivity2);
  }
  for (const std::string& name : options.channels) {
    if (AddExtra(name, second)) continue;
    *error = "profile " + std::string(ToString(format_.profile)) + " has no channel " + name;
    return false;
  }
  point_step_ = (fields_.MinimumStep() + kPointAlignment - 1) / kPointAlignment * kPointAlignment;
  return true;
}

bool PointWriter::SetFilters(const PointOptions& options, const Metadata& metadata,
                             std::string* error) {
  min_range_mm_ = ToMillimetres(options.min_range_m);
  max_range_mm_ = options.max_range_m > 0 ? ToMillimetres(options.max_range_m)
                                          : std::numeric_limits<std::uint32_t>::max();
  invalid_ = options.invalid;
  if (!options.mask_image.empty()) {
    auto mask =
        ParseMaskImage({options.mask_image.data(), options.mask_image.size()}, metadata, error);
    if (!mask) return false;
    mask_ = *std::move(mask);
  }
  if (options.destagger)
    for (const Beam& beam : metadata.model.beams)
      shifts_.push_back(static_cast<std::uint32_t>(beam.pixel_shift + static_cast<int>(columns_)));
  if (!options.sectors.empty()) MaskSectors(options.sectors);
  return true;
}

bool PointWriter::AddExtra(const std::string& name, bool second) {
  const std::uint32_t offset = fields_.MinimumStep();
  if (name == kTime) {
    fields_.Add(name, FieldType::kU32);
    extras_.push_back({Extra::Kind::kTime, std::nullopt, offset});
    return true;
  }
  fields_.Add(name, FieldType::kU16);
  if (name == kRing) {
    extras_.push_back({Extra::Kind::kRing, std::nullopt, offset});
    return true;
  }
  const PixelChannel* channel = FindPixelChannel(name);
  if (channel == nullptr) return false;
  auto reader = ReaderFor(format_, second ? channel->second : channel->channel);
  extras_.push_back({Extra::Kind::kPixel, reader, offset});
  return reader.has_value();
}

void PointWriter::MaskSectors(const std::vector<Sector>& sectors) {
  constexpr double kDegreesPerRadian = 180 / 3.14159265358979323846;
  if (mask_.empty()) mask_.assign(std::size_t{format_.beams} * columns_, 1);
  for (std::uint32_t beam = 0; beam < format_.beams; ++beam) {
    for (std::uint32_t column = 0; column < columns_; ++column) {
      const auto d = projection_->Direction(beam, column);
      double azimuth =
          std::atan2(static_cast<double>(d[1]), static_cast<double>(d[0])) * kDegreesPerRadian;
      if (azimuth < 0) azimuth += 360;
      const bool inside = std::any_of(sectors.begin(), sectors.end(), [&](const Sector& s) {
        return s.first_deg <= s.last_deg ? azimuth >= s.first_deg && azimuth <= s.last_deg
                                         : azimuth >= s.first_deg || azimuth <= s.last_deg;
      });
      if (!inside) mask_[std::size_t{beam} * columns_ + column] = 0;
    }
  }
}

bool PointWriter::Keeps(std::uint32_t beam, std::uint32_t column, std::uint32_t range_mm) const {
  return range_mm != 0 && range_mm >= min_range_mm_ && range_mm <= max_range_mm_ &&
         (mask_.empty() || mask_[std::size_t{beam} * columns_ + column] != 0);
}

void PointWriter::WriteExtras(const PacketColumn& column, const Target& target, std::uint32_t beam,
                              std::uint8_t* point) const {
  const std::uint8_t* pixel = column.pixels + std::size_t{beam} * pixel_size_;
  for (const Extra& extra : extras_) {
    switch (extra.kind) {
      case Extra::Kind::kPixel:
        Store(point + extra.offset, static_cast<std::uint16_t>(extra.reader->Read(pixel)));
        break;
      case Extra::Kind::kRing:
        Store(point + extra.offset, static_cast<std::uint16_t>(beam));
        break;
      case Extra::Kind::kTime:
        Store(point + extra.offset,
              static_cast<std::uint32_t>(column.timestamp -
                                         std::min(column.timestamp, target.start)));
        break;
    }
  }
}

void PointWriter::WriteColumn(const PacketColumn& column, const Target& target) const {
  const std::uint32_t m = column.measurement_id;
  const std::size_t row = std::size_t{target.width} * point_step_;
  const std::uint32_t at = m - target.first_column;
  for (std::uint32_t beam = 0; beam < format_.beams; ++beam) {
    const std::uint32_t to = shifts_.empty() ? at : (at + shifts_[beam]) % target.width;
    WritePixel(column, target, beam, target.points + beam * row + std::size_t{to} * point_step_);
  }
}

void PointWriter::WritePixel(const PacketColumn& column, const Target& target, std::uint32_t beam,
                             std::uint8_t* point) const {
  const std::uint32_t m = column.measurement_id;
  const std::uint8_t* pixel = column.pixels + std::size_t{beam} * pixel_size_;
  const std::uint32_t range = range_->Read(pixel);
  if (Keeps(beam, m, range)) {
    const std::array<float, 3> xyz = projection_->Point(beam, m, range);
    std::memcpy(point, xyz.data(), sizeof xyz);
    Store(point + kIntensityOffset, static_cast<float>(intensity_->Read(pixel)));
    Store(point + kRangeOffset, range);
  }
  if (range2_) {
    const std::uint32_t second = range2_->Read(pixel);
    if (Keeps(beam, m, second)) {
      Store(point + kRange2Offset, second);
      Store(point + kIntensity2Offset, static_cast<float>(intensity2_->Read(pixel)));
    }
  }
  if (!extras_.empty()) WriteExtras(column, target, beam, point);
}

void PointWriter::FillMissing(std::vector<std::uint8_t>* points) const {
  std::fill(points->begin(), points->end(), std::uint8_t{0});
  if (invalid_ == Invalid::kZero) return;
  const std::array<float, 3> nan = {NAN, NAN, NAN};
  for (std::size_t at = 0; at + point_step_ <= points->size(); at += point_step_)
    std::memcpy(points->data() + at, nan.data(), sizeof nan);
}

}  // namespace lidar::ouster
