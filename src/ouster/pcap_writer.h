// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes UDP datagrams to a capture file, through libpcap.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "src/base/byte_reader.h"
#include "src/base/time.h"

struct pcap;
struct pcap_dumper;

namespace lidar::ouster {

class PcapWriter {
 public:
  /// Returns null and sets `error` if the file cannot be written.
  static std::unique_ptr<PcapWriter> Open(const std::string& path, std::string* error);
  ~PcapWriter();
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  /// Writes an Ethernet frame with IPv4 of any size. Returns false if the disk is full, or if the
  /// payload is too large for UDP.
  bool Write(Time captured, std::uint16_t port, ByteView payload);
  /// Call this at the end. Returns false if the disk is full. A capture that is not closed
  /// successfully is removed.
  bool Close();

 private:
  PcapWriter(std::string path, pcap* handle, pcap_dumper* dumper)
      : path_(std::move(path)), handle_(handle), dumper_(dumper) {}

  const std::string path_;
  pcap* handle_;
  pcap_dumper* dumper_;  // null once it is closed
};

}  // namespace lidar::ouster
