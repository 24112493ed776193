// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/packet_recording.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "src/ouster/packet_writer.h"
#include "src/ouster/pcap_writer.h"

namespace lidar::tools {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegreesPerRadian = 180 / kPi;
constexpr std::uint32_t kColumnsPerPacket = 16;
constexpr std::uint32_t kMaxRangeMm = (1U << 19) - 1;
constexpr std::uint16_t kLidarPort = 7502;

/// Returns the beams of a Velodyne HDL-64E. They are two blocks of 32 beams, each evenly spaced.
std::vector<Beam> Hdl64Beams() {
  std::vector<Beam> beams;
  for (int i = 0; i < 32; ++i) beams.push_back({0, 2.0 - i * 10.33 / 31, 0});
  for (int i = 0; i < 32; ++i) beams.push_back({0, -8.83 - i * 15.5 / 31, 0});
  return beams;
}

/// Returns the beam whose altitude is nearest. Returns -1 if even this beam is further away than
/// the spacing between beams.
int NearestBeam(const std::vector<Beam>& beams, double altitude_deg) {
  const auto below = std::lower_bound(beams.begin(), beams.end(), altitude_deg,
                                      [](const Beam& b, double a) { return b.altitude_deg > a; });
  const auto distance = [&](std::size_t i) {
    return std::abs(beams[i].altitude_deg - altitude_deg);
  };
  auto i = static_cast<std::size_t>(below - beams.begin());
  if (i == beams.size() || (i > 0 && distance(i - 1) < distance(i))) --i;
  const std::size_t next = i > 0 ? i - 1 : i + 1;
  const double spacing = std::abs(beams[i].altitude_deg - beams[next].altitude_deg);
  return distance(i) <= spacing ? static_cast<int>(i) : -1;
}

std::uint32_t ReflectivityOf(const Scan& scan, std::size_t i, float scale) {
  if (i >= scan.intensity.size()) return 0;
  return static_cast<std::uint32_t>(std::clamp(scan.intensity[i] * scale + 0.5F, 0.0F, 255.0F));
}

}  // namespace

std::vector<Beam> ParseBeams(const std::string& text) {
  if (text == "hdl64") return Hdl64Beams();
  unsigned n = 0;
  double top = 0;
  double bottom = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%u:%lf:%lf%c", &n, &top, &bottom, &rest) != 3 || n < 2 ||
      n > 256 || !(top > bottom) || top > 90 || bottom < -90)
    throw std::runtime_error("beams \"" + text + "\" must be hdl64 or like 64:2:-24.8");
  std::vector<Beam> beams;
  for (unsigned i = 0; i < n; ++i) beams.push_back({0, top - (top - bottom) * i / (n - 1), 0});
  return beams;
}

SensorModel ModelOfCloud(const std::vector<Beam>& beams, std::uint32_t columns) {
  SensorModel model;
  model.columns_per_scan = columns;
  model.lidar_to_sensor = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  model.beams = beams;
  return model;
}

Scan ToRangeImage(const Scan& scan, const std::shared_ptr<const ScanGeometry>& geometry) {
  if (scan.organised()) return scan;
  const SensorModel& model = geometry->model;
  const std::uint32_t columns = model.columns_per_scan;
  Scan image;
  image.geometry = geometry;
  image.ranges.assign(model.beams.size() * columns, 0);
  image.intensity.assign(image.ranges.size(), 0);
  for (std::size_t i = 0; i * 3 < scan.xyz.size(); ++i) {
    const auto x = static_cast<double>(scan.xyz[i * 3]);
    const auto y = static_cast<double>(scan.xyz[i * 3 + 1]);
    const auto z = static_cast<double>(scan.xyz[i * 3 + 2]);
    const double range_mm = std::round(1e3 * std::sqrt(x * x + y * y + z * z));
    const int beam = NearestBeam(model.beams, std::atan2(z, std::hypot(x, y)) * kDegreesPerRadian);
    if (beam < 0 || range_mm < 1 || range_mm > kMaxRangeMm) continue;
    // The azimuth decreases from one column to the next. Column 0 is at -x.
    const double turn = 0.5 - std::atan2(y, x) / (2 * kPi);
    const auto column = static_cast<std::uint32_t>(std::lround(turn * columns)) % columns;
    const std::size_t at = static_cast<std::size_t>(beam) * columns + column;
    const auto range = static_cast<std::uint32_t>(range_mm);
    if (image.ranges[at] != 0 && image.ranges[at] <= range) continue;
    image.ranges[at] = range;
    if (i < scan.intensity.size()) image.intensity[at] = scan.intensity[i];
  }
  return image;
}

ouster::Metadata MetadataOf(const ScanSet& set) {
  ouster::Metadata m;
  m.model = set.scans.front().geometry->model;
  m.product_line = "OS-1-" + std::to_string(m.model.beams.size());
  m.serial_text = "100000000001";
  m.serial = 100000000001;
  m.firmware = "v2.3.0";
  m.init_id = 1;
  m.scans_per_second = set.scans_per_second;
  m.lidar_mode = std::to_string(m.model.columns_per_scan) + "x" +
                 std::to_string(std::lround(set.scans_per_second));
  m.timestamp_mode = "TIME_FROM_INTERNAL_OSC";
  m.format = {ouster::Profile::kRng19Rfl8Sig16Nir16, ouster::HeaderType::kStandard,
              static_cast<std::uint32_t>(m.model.beams.size()), kColumnsPerPacket};
  m.model.range_unit_mm = 1;
  m.window = {0, m.model.columns_per_scan};
  m.lidar_port = kLidarPort;
  return m;
}

void WriteCapture(const ScanSet& set, const ouster::Metadata& m, const std::string& path) {
  std::string error;
  const auto file = ouster::PcapWriter::Open(path, &error);
  if (!file) throw std::runtime_error("cannot write " + path + ": " + error);
  ouster::PacketWriter writer(m.format, {m.init_id, m.serial});
  const std::uint32_t columns = m.model.columns_per_scan;
  const auto time_of = [&](std::size_t scan, std::uint32_t column) {
    return m.scan_period() * static_cast<std::int64_t>(scan) + m.scan_period() * column / columns;
  };
  for (std::size_t s = 0; s < set.scans.size(); ++s) {
    const Scan& scan = set.scans[s];
    // The greatest intensity is 1 in KITTI's files, and 255 in Ouster's packets.
    const float brightest = scan.intensity.empty()
                                ? 0
                                : *std::max_element(scan.intensity.begin(), scan.intensity.end());
    const float scale = brightest <= 1 ? 255.0F : 1.0F;
    for (std::uint32_t first = 0; first < columns; first += kColumnsPerPacket) {
      writer.Begin(static_cast<std::uint32_t>(s));
      for (std::uint32_t i = 0; i < kColumnsPerPacket; ++i) {
        const auto column = first + i;
        const auto t = static_cast<std::uint64_t>(time_of(s, column).count()) + 1'000'000'000;
        writer.SetColumn(i, {t, static_cast<std::uint16_t>(column), true});
        for (std::uint32_t beam = 0; beam < m.format.beams; ++beam) {
          const std::size_t at = std::size_t{beam} * columns + column;
          writer.SetPixel({i, beam}, ouster::Channel::kRange,
                          std::min(scan.ranges[at], kMaxRangeMm));
          writer.SetPixel({i, beam}, ouster::Channel::kReflectivity,
                          ReflectivityOf(scan, at, scale));
        }
      }
      const auto& bytes = writer.Finish();
      const Time sent(time_of(s, first + kColumnsPerPacket) + std::chrono::hours(24 * 365 * 54));
      if (!file->Write(sent, kLidarPort, {bytes.data(), bytes.size()}))
        throw std::runtime_error("cannot write " + path);
    }
  }
  if (!file->Close()) throw std::runtime_error("cannot write " + path);
}

}  // namespace lidar::tools
