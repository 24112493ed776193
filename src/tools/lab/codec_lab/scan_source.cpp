// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/scan_source.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "src/ouster/metadata.h"
#include "src/ouster/pcap_reader.h"
#include "src/ouster/scan_batcher.h"
#include "src/synth/scanner.h"
#include "src/tools/common/output_file.h"
#include "src/tools/lab/codec_lab/cloud_file.h"
#include "src/tools/lab/codec_lab/cloud_recording.h"
#include "src/tools/lab/codec_lab/kitti_sequence.h"
#include "src/tools/lab/codec_lab/message_reader.h"

namespace lidar::tools {

const char* const kSourceHelp =
    "What to read: drive.pcap (with drive.json beside it), drive.pcap,sensor.json, cloud.bin, "
    "cloud.pcd, cloud.ply, a folder of these, drive.mcap or drive.mcap,/topic, drive.db3, a bag's "
    "folder, kitti:FOLDER, or synth:MODEL:SCENE[:COLUMNS] such as synth:os1-64:street";

ColumnWindow WindowOf(const Scan& scan, SliceOf slice) {
  const std::uint32_t columns = scan.geometry->model.columns_per_scan;
  const std::uint32_t first = columns * slice.index / slice.count;
  return {first, columns * (slice.index + 1) / slice.count - first};
}

namespace {

constexpr std::string_view kKitti = "kitti:";

ouster::Metadata ReadMetadata(const std::string& path) {
  std::string error;
  const auto metadata = ouster::ParseMetadata(ReadFile(path), &error);
  if (!metadata) throw std::runtime_error(path + ": " + error);
  if (!metadata->pixel_angles.empty())
    throw std::runtime_error(path + ": sensors with an angle for each pixel are not supported");
  return *metadata;
}

/// Converts a slice to ranges and intensities. The slice must be a whole scan that `writer` wrote.
Scan FromPoints(const ouster::Slice& slice, const ouster::PointWriter& writer,
                const std::shared_ptr<const ScanGeometry>& geometry) {
  Scan scan;
  scan.geometry = geometry;
  const std::uint32_t range = writer.fields().Find("range")->offset;
  const std::uint32_t intensity = writer.fields().Find("intensity")->offset;
  for (std::size_t at = 0; at < slice.points.size(); at += writer.point_step()) {
    std::uint32_t mm = 0;
    float level = 0;
    std::memcpy(&mm, &slice.points[at + range], sizeof mm);
    std::memcpy(&level, &slice.points[at + intensity], sizeof level);
    scan.ranges.push_back(mm);
    scan.intensity.push_back(level);
  }
  return scan;
}

class Capture final : public ScanStream {
 public:
  Capture(const std::string& pcap, ouster::Metadata metadata, ouster::PointWriter writer,
          std::unique_ptr<ouster::PcapReader> reader)
      : ScanStream(metadata.scans_per_second),
        pcap_(pcap),
        metadata_(std::move(metadata)),
        writer_(std::move(writer)),
        reader_(std::move(reader)),
        geometry_(std::make_shared<const ScanGeometry>(metadata_.model)),
        batcher_(metadata_, writer_, {}) {}

  std::optional<TimedScan> Next() override {
    for (;;) {
      if (const auto slice = batcher_.Pop()) {
        TimedScan timed;
        timed.scan = FromPoints(*slice, writer_, geometry_);
        timed.start = Time{} + Duration{static_cast<std::int64_t>(slice->start)};
        timed.duration = period();
        any_ = true;
        return timed;
      }
      if (ended_ && !any_)
        throw std::runtime_error(pcap_ + ": has no scan of the sensor in the metadata");
      if (ended_) return std::nullopt;
      const auto captured = reader_->Next();
      ended_ = !captured;
      if (ended_) batcher_.Flush();
      if (!captured) continue;
      const auto packet = ouster::LidarPacket::Parse(captured->datagram.view(), metadata_.format);
      if (packet) batcher_.Push(*packet);
    }
  }

 private:
  std::string pcap_;
  ouster::Metadata metadata_;
  ouster::PointWriter writer_;
  std::unique_ptr<ouster::PcapReader> reader_;
  std::shared_ptr<const ScanGeometry> geometry_;
  ouster::ScanBatcher batcher_;
  bool ended_ = false;
  bool any_ = false;
};

std::unique_ptr<ScanStream> OpenCapture(const std::string& pcap, const std::string& json) {
  ouster::Metadata metadata = ReadMetadata(json);
  std::string error;
  auto writer = ouster::PointWriter::Create(metadata, {}, &error);
  if (!writer) throw std::runtime_error(json + ": " + error);
  auto reader = ouster::PcapReader::Open(pcap, &error);
  if (!reader) throw std::runtime_error(pcap + ": " + error);
  return std::make_unique<Capture>(pcap, std::move(metadata), *std::move(writer),
                                   std::move(reader));
}

/// The scans of a synthetic sensor with a firing table. They are clouds in the order of firing.
class SyntheticFirings final : public ScanStream {
 public:
  explicit SyntheticFirings(const synth::ScannerConfig& config)
      : ScanStream(1 / Seconds(config.period)),
        columns_(config.sensor.model.columns_per_scan),
        scanner_(config) {}

  std::optional<TimedScan> Next() override {
    synth::Returns returns;
    scanner_.Cast(next_, {0, columns_}, &returns);
    TimedScan timed;
    timed.start = Time{} + scanner_.ColumnTime(next_, 0);
    timed.duration = period();
    const synth::Rays& rays = scanner_.rays();
    for (std::uint32_t column = 0; column < columns_; ++column)
      for (std::uint32_t beam = 0; beam < rays.beams(); ++beam) {
        const std::uint32_t range = returns.range_mm[std::size_t{beam} * columns_ + column];
        if (range == 0) continue;
        const float range_m = 1e-3F * static_cast<float>(range);
        const synth::Vec3 direction = rays.Direction(next_, beam, column);
        timed.scan.xyz.insert(timed.scan.xyz.end(), {range_m * direction.x, range_m * direction.y,
                                                     range_m * direction.z});
        timed.scan.rings.push_back(static_cast<std::uint16_t>(beam));
        const auto firing = static_cast<float>(column * rays.beams() + beam);
        timed.scan.phases.push_back(firing / static_cast<float>(columns_ * rays.beams()));
      }
    ++next_;
    return timed;
  }

 private:
  std::uint32_t columns_;
  synth::Scanner scanner_;
  std::uint64_t next_ = 0;
};

class SyntheticDrive final : public ScanStream {
 public:
  explicit SyntheticDrive(const synth::ScannerConfig& config)
      : ScanStream(1 / Seconds(config.period)),
        columns_(config.sensor.model.columns_per_scan),
        scanner_(config),
        geometry_(std::make_shared<const ScanGeometry>(config.sensor.model)) {}

  std::optional<TimedScan> Next() override {
    synth::Returns returns;
    scanner_.Cast(next_, {0, columns_}, &returns);
    const Duration start = scanner_.ColumnTime(next_++, 0);
    TimedScan timed;
    timed.start = Time{} + start;
    timed.duration = period();
    timed.truth = scanner_.trajectory().At(start + timed.duration / 2);
    timed.scan.geometry = geometry_;
    timed.scan.ranges = std::move(returns.range_mm);
    timed.scan.intensity.assign(returns.reflectivity.begin(), returns.reflectivity.end());
    return timed;
  }
  const synth::Trajectory* trajectory() const override { return &scanner_.trajectory(); }

 private:
  std::uint32_t columns_;
  synth::Scanner scanner_;
  std::shared_ptr<const ScanGeometry> geometry_;
  std::uint64_t next_ = 0;
};

std::unique_ptr<ScanStream> OpenSynthetic(const std::string& text, const SourceOptions& options) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ':');) parts.push_back(part);
  if (parts.size() < 3 || parts.size() > 4)
    throw std::runtime_error(text + ": not synth:MODEL:SCENE[:COLUMNS]");
  synth::ScannerConfig config;
  const unsigned long columns =
      parts.size() == 4 ? std::strtoul(parts[3].c_str(), nullptr, 10) : 1024;
  const synth::Firing* firing = synth::FindFiring(parts[1]);
  const auto sensor = firing != nullptr
                          ? synth::MakeSensor(*firing)
                          : synth::MakeSensor(parts[1], static_cast<std::uint32_t>(columns));
  if (!sensor)
    throw std::runtime_error(
        text + ": no such sensor; there are os0-32 to os2-128, vlp-16, xt32, at128 and mid-360");
  config.sensor = *sensor;
  if (parts[2] == "street")
    config.scene = synth::SceneKind::kStreet;
  else if (parts[2] == "tunnel")
    config.scene = synth::SceneKind::kTunnel;
  else if (parts[2] == "field")
    config.scene = synth::SceneKind::kField;
  else if (parts[2] == "town")
    config.scene = synth::SceneKind::kTown;
  else
    throw std::runtime_error(text + ": no such scene; there are street, tunnel, field and town");
  if (options.max_scans == 0)
    throw std::runtime_error(text + ": a synthetic drive has no end; set the number of scans");
  config.speed_mps = options.speed_mps;
  config.roughness = options.roughness;
  config.seed = options.seed;
  config.noise_m = options.noise_m;
  config.mixed_pixels = options.mixed_pixels;
  if (firing != nullptr) return std::make_unique<SyntheticFirings>(config);
  return std::make_unique<SyntheticDrive>(config);
}

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Clouds in files. Their times are as if there were ten scans per second, which is usual.
class CloudFiles final : public ScanStream {
 public:
  explicit CloudFiles(std::vector<std::string> files) : ScanStream(10), files_(std::move(files)) {}

  std::optional<TimedScan> Next() override {
    if (next_ == files_.size()) return std::nullopt;
    const std::string& file = files_[next_];
    TimedScan timed;
    timed.scan = ReadCloud(file);
    timed.start = Time{} + period() * static_cast<std::int64_t>(next_++);
    timed.duration = period();
    return timed;
  }

 private:
  std::vector<std::string> files_;
  std::size_t next_ = 0;
};

std::unique_ptr<ScanStream> OpenFolder(const std::string& folder, const std::string& topic) {
  std::vector<std::string> files;
  std::string recording;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (IsCloudFile(entry.path().string())) files.push_back(entry.path().string());
    if (IsRecordingFile(entry.path().string())) recording = entry.path().string();
  }
  if (!recording.empty() && files.empty()) return OpenRecording(folder, topic);
  std::sort(files.begin(), files.end());
  if (!recording.empty())
    throw std::runtime_error(folder + ": holds recordings and clouds; name one, such as " +
                             recording + " or " + files.front());
  if (files.empty())
    throw std::runtime_error(folder + ": no .bin, .pcd, .ply, .mcap or .db3 file in it");
  return std::make_unique<CloudFiles>(std::move(files));
}

}  // namespace

std::optional<std::string> KittiFolderOf(const std::string& text) {
  if (text.rfind(kKitti, 0) != 0) return std::nullopt;
  return text.substr(kKitti.size());
}

std::unique_ptr<ScanStream> OpenScans(const std::string& text, const SourceOptions& options) {
  if (text.rfind("synth:", 0) == 0) return OpenSynthetic(text, options);
  if (const auto folder = KittiFolderOf(text)) return OpenKittiSequence(*folder);
  const std::size_t comma = text.find(',');
  const std::string path = text.substr(0, comma);
  const std::string part = comma == std::string::npos ? "" : text.substr(comma + 1);
  if (std::filesystem::is_directory(path)) return OpenFolder(path, part);
  if (IsCloudFile(path)) return std::make_unique<CloudFiles>(std::vector<std::string>{path});
  if (IsRecordingFile(path)) return OpenRecording(path, part);
  if (EndsWith(path, ".pcap") || EndsWith(path, ".pcapng"))
    return OpenCapture(path, part.empty()
                                 ? std::filesystem::path(path).replace_extension(".json").string()
                                 : part);
  throw std::runtime_error(
      text + ": not a .pcap, .pcapng, .mcap, .db3, .bin, .pcd, .ply, kitti: or synth: source");
}

ScanSet LoadScans(const std::string& text, const SourceOptions& options) {
  const auto stream = OpenScans(text, options);
  ScanSet set;
  set.scans_per_second = stream->scans_per_second();
  const bool synthetic = text.rfind("synth:", 0) == 0;
  set.name =
      synthetic ? text : std::filesystem::path(text.substr(0, text.find(','))).stem().string();
  while (options.max_scans == 0 || set.scans.size() < options.max_scans) {
    auto timed = stream->Next();
    if (!timed) break;
    set.scans.push_back(std::move(timed->scan));
  }
  return set;
}

std::vector<ScanSet> LoadAllScans(const std::vector<std::string>& texts,
                                  const SourceOptions& options) {
  std::vector<ScanSet> sets;
  for (const std::string& text : texts) sets.push_back(LoadScans(text, options));
  return sets;
}

}  // namespace lidar::tools
