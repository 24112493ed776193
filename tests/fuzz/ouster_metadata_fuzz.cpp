// SPDX-License-Identifier: LGPL-2.1-or-later
#include <string>

#include "src/ouster/sensor_stream.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string error;
  auto metadata = lidar::ouster::ParseMetadata(lidar::fuzz::Text(data, size), &error);
  FUZZ_CHECK(metadata.has_value() == error.empty());
  if (!metadata) return 0;
  // Metadata that the parser accepts must be sufficient for a stream. The stream then accepts a
  // packet of zeros.
  const auto bytes = metadata->model.Serialise();
  FUZZ_CHECK(lidar::SensorModel::Parse({bytes.data(), bytes.size()}).has_value());
  const std::size_t packet_size = metadata->format.packet_size();
  FUZZ_CHECK(packet_size <= lidar::ouster::PacketFormat::kMaxPacketSize);
  auto stream = lidar::ouster::SensorStream::Create(*std::move(metadata), {}, &error);
  if (stream == nullptr) return 0;
  const std::vector<std::uint8_t> zeros(packet_size);
  stream->Push({zeros.data(), zeros.size()}, {});
  stream->Flush();
  while (stream->Pop()) continue;
  return 0;
}
