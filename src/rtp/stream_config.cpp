// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/stream_config.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <tuple>
#include <utility>

#include "src/base/byte_writer.h"
#include "src/base/crc.h"
#include "src/cloud/point_fields.h"
#include "src/cloud/sensor_model.h"

namespace lidar::rtp {
namespace {

constexpr std::uint8_t kVersion = 1;
// The numbers of a fraction in GStreamer's caps are of type gint.
constexpr std::uint32_t kMaxFraction = 0x7FFF'FFFF;

constexpr std::uint8_t kNamedCoder = 0xFF;  // replaces the byte with coder and geometry

/// The media types of this project. The first two have coders with a number. The others have no
/// slices.
constexpr std::string_view kOwnTypes[] = {"application/x-draco",       "application/x-lidar-slice",
                                          "application/x-pointcloud2", "application/x-imu",
                                          "application/x-odometry",    "application/x-tf"};

/// Returns true for fields that a decoder can produce.
bool AreDecodable(const std::string& fields) {
  const auto parsed = PointFields::Parse(fields);
  return parsed && parsed->HasPackedXyz() && parsed->ArePacked();
}

std::optional<StreamConfig> ParseNamed(ByteView text) {
  auto caps = ScalarCaps::Parse({reinterpret_cast<const char*>(text.data), text.size});
  if (!caps || std::find(std::begin(kOwnTypes), std::end(kOwnTypes), caps->media_type) !=
                   std::end(kOwnTypes))
    return std::nullopt;
  const auto* alignment = std::get_if<std::string>(caps->Find("alignment"));
  if (alignment == nullptr || *alignment != "slice") return std::nullopt;
  const auto* fields = std::get_if<std::string>(caps->Find("fields"));
  if (fields != nullptr && !AreDecodable(*fields)) return std::nullopt;
  StreamConfig config;
  config.coder = Coder::kNamed;
  config.caps = *std::move(caps);
  return config;
}

bool IsKnown(Coder coder, Geometry geometry) {
  return coder <= Coder::kLidar && geometry <= Geometry::kRange;
}

}  // namespace

std::vector<std::uint8_t> StreamConfig::Serialise() const {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  w.U8(kVersion);
  if (coder == Coder::kNamed) {
    w.U8(kNamedCoder);
    const std::string text = caps.ToText().value_or("");
    w.Bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return bytes;
  }
  w.U8(static_cast<std::uint8_t>(static_cast<unsigned>(coder) << 4 |
                                 static_cast<unsigned>(geometry)));
  w.Be32(framerate_n);
  w.Be32(framerate_d);
  w.Be16(static_cast<std::uint16_t>(fields.size()));
  w.Be16(static_cast<std::uint16_t>(sensor_model.size()));
  w.Bytes({reinterpret_cast<const std::uint8_t*>(fields.data()), fields.size()});
  w.Bytes({sensor_model.data(), sensor_model.size()});
  return bytes;
}

std::optional<StreamConfig> StreamConfig::Parse(ByteView bytes) {
  ByteReader r(bytes);
  StreamConfig c;
  const std::uint8_t version = r.U8();
  const std::uint8_t coder_and_geometry = r.U8();
  if (version == kVersion && coder_and_geometry == kNamedCoder) return ParseNamed(r.Rest());
  c.coder = static_cast<Coder>(coder_and_geometry >> 4);
  c.geometry = static_cast<Geometry>(coder_and_geometry & 15);
  c.framerate_n = r.Be32();
  c.framerate_d = r.Be32();
  const std::uint16_t fields_size = r.Be16();
  const std::uint16_t model_size = r.Be16();
  const ByteView fields = r.Bytes(fields_size);
  const ByteView model = r.Bytes(model_size);
  if (!r.ok() || r.remaining() != 0 || version != kVersion || !IsKnown(c.coder, c.geometry) ||
      c.framerate_n > kMaxFraction || c.framerate_d == 0 || c.framerate_d > kMaxFraction) {
    return std::nullopt;
  }
  c.fields.assign(fields.begin(), fields.end());
  c.sensor_model.assign(model.begin(), model.end());
  if (!AreDecodable(c.fields)) return std::nullopt;
  if (!model.empty() && !SensorModel::Parse(model)) return std::nullopt;
  if (c.geometry == Geometry::kRange && model.empty()) return std::nullopt;
  return c;
}

bool StreamConfig::operator==(const StreamConfig& o) const {
  return std::tie(coder, geometry, framerate_n, framerate_d, fields, sensor_model, caps) ==
         std::tie(o.coder, o.geometry, o.framerate_n, o.framerate_d, o.fields, o.sensor_model,
                  o.caps);
}

std::uint8_t ConfigId(const std::vector<std::uint8_t>& config,
                      std::optional<std::uint8_t> previous) {
  const auto id = static_cast<std::uint8_t>(Crc32({config.data(), config.size()}));
  return previous == id ? static_cast<std::uint8_t>(id + 1) : id;
}

}  // namespace lidar::rtp
