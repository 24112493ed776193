// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-eval to-pcap: writes clouds of any sensor as an Ouster capture.
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "src/ouster/metadata_writer.h"
#include "src/tools/common/output_file.h"
#include "src/tools/lab/codec_lab/packet_recording.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/lidar_eval/commands.h"

namespace lidar::tools {
namespace {

struct PcapOptions {
  std::string source;
  SourceOptions scans;
  std::string output;
  std::string metadata;  // empty: beside the output
  std::string beams = "hdl64";
  std::uint32_t columns = 1024;
  double rate = 10;
};

std::string MetadataPath(const PcapOptions& o) {
  if (!o.metadata.empty()) return o.metadata;
  const std::size_t dot = o.output.find_last_of("./");
  const bool has_extension = dot != std::string::npos && o.output[dot] == '.';
  return (has_extension ? o.output.substr(0, dot) : o.output) + ".json";
}

void RunPcap(const PcapOptions& o) {
  ScanSet set = LoadScans(o.source, o.scans);
  if (set.scans.empty()) throw std::runtime_error(o.source + " holds no scans");
  std::size_t points = 0;
  std::size_t kept = 0;
  if (!set.organised()) {
    set.scans_per_second = o.rate;
    const auto geometry =
        std::make_shared<const ScanGeometry>(ModelOfCloud(ParseBeams(o.beams), o.columns));
    for (Scan& scan : set.scans) {
      points += scan.xyz.size() / 3;
      scan = ToRangeImage(scan, geometry);
    }
  }
  for (const Scan& scan : set.scans)
    for (const std::uint32_t range : scan.ranges) kept += range != 0 ? 1 : 0;
  const ouster::Metadata metadata = MetadataOf(set);
  WriteCapture(set, metadata, o.output);
  try {
    WriteFile(MetadataPath(o), ouster::WriteMetadata(metadata));
  } catch (const std::runtime_error&) {
    RemoveFile(o.output);  // the capture cannot be read without its metadata
    throw;
  }
  std::printf("%s: %zu scans of %zu beams x %u columns, %zu returns", o.output.c_str(),
              set.scans.size(), metadata.model.beams.size(), metadata.model.columns_per_scan, kept);
  if (points > 0)
    std::printf(" (%.1f %% of %zu points; the others share a pixel with a nearer one)",
                100.0 * static_cast<double>(kept) / static_cast<double>(points), points);
  std::printf("\n");
}

}  // namespace

void AddToPcapCommand(CLI::App* app) {
  auto o = std::make_shared<PcapOptions>();
  CLI::App* command = app->add_subcommand(
      "to-pcap", "Packs scans into an Ouster capture for ouster_src and ouster-replay");
  command->option_defaults()->always_capture_default();
  command->add_option("SOURCE", o->source, kSourceHelp)->required();
  command->add_option("-o,--output", o->output, "Capture to write")->required();
  command->add_option("--metadata", o->metadata, "Metadata to write; empty: beside the capture");
  command->add_option("--beams", o->beams,
                      "Beams of clouds without order: hdl64 (KITTI), or N:TOP:BOTTOM [degrees]");
  command->add_option("--columns", o->columns, "Columns of a turn, for clouds without order")
      ->check(CLI::IsMember({512U, 1024U, 2048U, 4096U}));
  command->add_option("--rate", o->rate, "Scans/s of clouds without order")
      ->check(CLI::Range(1.0, 100.0));
  command->add_option("--scans", o->scans.max_scans, "Scans to read");
  command->callback([o] { RunPcap(*o); });
}

}  // namespace lidar::tools
