// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/codec_lab/scan_source.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "src/ouster/metadata.h"
#include "src/ouster/pcap_reader.h"
#include "src/ouster/scan_batcher.h"
#include "src/synth/scanner.h"
#include "src/tools/codec_lab/cloud_file.h"

namespace lidar::tools {

const char* const kSourceHelp =
    "What to read: drive.pcap (with drive.json beside it), drive.pcap,sensor.json, cloud.bin, "
    "cloud.pcd, a folder of these, or synth:MODEL:SCENE[:COLUMNS] such as synth:os1-64:street";

ColumnWindow WindowOf(const Scan& scan, SliceOf slice) {
  const std::uint32_t width = scan.geometry->model.columns_per_scan / slice.count;
  return {slice.index * width, width};
}

namespace {

std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot open " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

ouster::Metadata ReadMetadata(const std::string& path) {
  std::string error;
  const auto metadata = ouster::ParseMetadata(ReadText(path), &error);
  if (!metadata) throw std::runtime_error(path + ": " + error);
  if (!metadata->pixel_angles.empty())
    throw std::runtime_error(path + ": sensors with an angle for each pixel have no beams");
  return *metadata;
}

/// A slice of one whole scan, as PointWriter lays it out, to ranges and intensities.
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

ScanSet LoadCapture(const std::string& pcap, const std::string& json, std::size_t max_scans) {
  const ouster::Metadata metadata = ReadMetadata(json);
  std::string error;
  const auto writer = ouster::PointWriter::Create(metadata, {}, &error);
  if (!writer) throw std::runtime_error(json + ": " + error);
  const auto reader = ouster::PcapReader::Open(pcap, &error);
  if (!reader) throw std::runtime_error(pcap + ": " + error);

  ScanSet set;
  set.scans_per_second = metadata.scans_per_second;
  const auto geometry = std::make_shared<const ScanGeometry>(metadata.model);
  ouster::ScanBatcher batcher(metadata, *writer, {});
  const auto take = [&] {
    while (const auto slice = batcher.Pop())
      if (set.scans.size() < max_scans) set.scans.push_back(FromPoints(*slice, *writer, geometry));
  };
  while (const auto captured = reader->Next()) {
    const auto packet = ouster::LidarPacket::Parse(captured->datagram.view(), metadata.format);
    if (!packet) continue;
    batcher.Push(*packet);
    take();
  }
  batcher.Flush();
  take();
  if (set.scans.empty()) throw std::runtime_error(pcap + ": no scan of that sensor");
  return set;
}

ScanSet LoadSynthetic(const std::string& text, const SourceOptions& options) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ':');) parts.push_back(part);
  if (parts.size() < 3 || parts.size() > 4)
    throw std::runtime_error(text + ": not synth:MODEL:SCENE[:COLUMNS]");
  synth::ScannerConfig config;
  const unsigned long columns =
      parts.size() == 4 ? std::strtoul(parts[3].c_str(), nullptr, 10) : 1024;
  const auto sensor = synth::MakeSensor(parts[1], static_cast<std::uint32_t>(columns));
  if (!sensor) throw std::runtime_error(text + ": no such sensor, os0-32 to os2-128 are");
  config.sensor = *sensor;
  if (parts[2] == "street")
    config.scene = synth::SceneKind::kStreet;
  else if (parts[2] == "tunnel")
    config.scene = synth::SceneKind::kTunnel;
  else if (parts[2] == "field")
    config.scene = synth::SceneKind::kField;
  else
    throw std::runtime_error(text + ": no such scene, street, tunnel and field are");
  config.speed_mps = options.speed_mps;
  config.seed = options.seed;
  synth::Scanner scanner(config);
  const auto geometry = std::make_shared<const ScanGeometry>(sensor->model);
  ScanSet set;
  for (std::uint64_t i = 0; i < options.max_scans; ++i) {
    synth::Returns returns;
    scanner.Cast(i, {0, sensor->model.columns_per_scan}, &returns);
    Scan scan;
    scan.geometry = geometry;
    scan.ranges = std::move(returns.range_mm);
    scan.intensity.assign(returns.reflectivity.begin(), returns.reflectivity.end());
    set.scans.push_back(std::move(scan));
  }
  return set;
}

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

ScanSet LoadFolder(const std::string& folder, std::size_t max_scans) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".bin" || entry.path().extension() == ".pcd")
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  files.resize(std::min(files.size(), max_scans));
  if (files.empty()) throw std::runtime_error(folder + ": no .bin or .pcd file in it");
  ScanSet set;
  for (const std::string& file : files)
    set.scans.push_back(EndsWith(file, ".bin") ? ReadBin(file) : ReadPcd(file));
  return set;
}

}  // namespace

ScanSet LoadScans(const std::string& text, const SourceOptions& options) {
  ScanSet set;
  if (text.rfind("synth:", 0) == 0) {
    set = LoadSynthetic(text, options);
    set.name = text;
    return set;
  }
  const std::size_t comma = text.find(',');
  const std::string path = text.substr(0, comma);
  if (std::filesystem::is_directory(path)) {
    set = LoadFolder(path, options.max_scans);
  } else if (EndsWith(path, ".bin")) {
    set.scans.push_back(ReadBin(path));
  } else if (EndsWith(path, ".pcd")) {
    set.scans.push_back(ReadPcd(path));
  } else if (EndsWith(path, ".pcap") || EndsWith(path, ".pcapng")) {
    const std::string json = comma == std::string::npos
                                 ? std::filesystem::path(path).replace_extension(".json").string()
                                 : text.substr(comma + 1);
    set = LoadCapture(path, json, options.max_scans);
  } else {
    throw std::runtime_error(text + ": not a .pcap, .pcapng, .bin, .pcd or synth: source");
  }
  set.name = std::filesystem::path(path).stem().string();
  return set;
}

std::vector<ScanSet> LoadAllScans(const std::vector<std::string>& texts,
                                  const SourceOptions& options) {
  std::vector<ScanSet> sets;
  for (const std::string& text : texts) sets.push_back(LoadScans(text, options));
  return sets;
}

}  // namespace lidar::tools
