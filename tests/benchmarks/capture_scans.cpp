// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/benchmarks/capture_scans.h"

#include <fstream>
#include <sstream>

#include "src/ouster/pcap_reader.h"
#include "src/ouster/sensor_stream.h"

namespace lidar::bench {

std::optional<Capture> ReadCapture(const std::string& pcap, const std::string& metadata,
                                   std::uint32_t slices_per_scan) {
  std::stringstream json;
  json << std::ifstream(metadata).rdbuf();
  std::string error;
  auto parsed = ouster::ParseMetadata(json.str(), &error);
  const auto reader = ouster::PcapReader::Open(pcap, &error);
  if (!parsed || !reader) return std::nullopt;
  ouster::StreamOptions options;
  options.slices_per_scan = slices_per_scan;
  const auto stream = ouster::SensorStream::Create(*parsed, options, &error);
  if (!stream) return std::nullopt;
  Capture capture;
  capture.format.layout = {stream->writer().fields(), stream->writer().point_step()};
  capture.format.height = parsed->format.beams;
  capture.format.sensor_model = parsed->model;
  while (const auto packet = reader->Next()) {
    const auto& payload = packet->datagram.payload;
    stream->Push({payload.data(), payload.size()}, {packet->time, packet->time});
  }
  stream->Flush();
  while (auto timed = stream->Pop()) {
    if (timed->slice.missing_columns > 0) continue;
    capture.slices.push_back(
        {timed->slice.first_column, timed->slice.width, std::move(timed->slice.points)});
  }
  return capture;
}

}  // namespace lidar::bench
