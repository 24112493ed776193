// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions that read the captures in tests/data/ouster.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "src/ouster/metadata.h"
#include "src/ouster/pcap_reader.h"
#include "tests/support/files.h"

namespace lidar::test {

inline std::string DataPath(const std::string& name) {
  return std::string(LIDAR_TEST_DATA) + "/ouster/" + name;
}

inline ouster::Metadata LoadMetadata(const std::string& name) {
  std::string error;
  auto metadata = ouster::ParseMetadata(ReadFile(DataPath(name)), &error);
  EXPECT_TRUE(metadata) << name << ": " << error;
  return metadata.value_or(ouster::Metadata{});
}

/// Returns the payloads whose size is that of a lidar packet of `metadata`.
inline std::vector<std::vector<std::uint8_t>> LoadPackets(const std::string& name,
                                                          const ouster::Metadata& metadata) {
  std::string error;
  auto reader = ouster::PcapReader::Open(DataPath(name), &error);
  EXPECT_TRUE(reader) << name << ": " << error;
  std::vector<std::vector<std::uint8_t>> packets;
  while (auto captured = reader->Next())
    if (captured->datagram.payload.size() == metadata.format.packet_size())
      packets.push_back(std::move(captured->datagram.payload));
  EXPECT_EQ(reader->error(), "");
  return packets;
}

/// Marks a column of the packet as invalid and sets its time to 0. The packet must not have the
/// profile LEGACY.
inline void Invalidate(const ouster::PacketFormat& format, std::uint32_t column,
                       std::vector<std::uint8_t>* packet) {
  std::uint8_t* at = packet->data() + format.packet_header_size() + column * format.column_size();
  std::fill_n(at, 8, std::uint8_t{0});
  std::fill_n(at + 10, 2, std::uint8_t{0});
}

}  // namespace lidar::test
