// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes UDP datagrams to a capture file, with libpcap.
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

  /// Writes the payload as a UDP datagram in IPv4 in one Ethernet frame, which may be larger than
  /// Ethernet allows. Returns false if the disk is full, or if the payload is too large for UDP.
  bool Write(Time captured, std::uint16_t port, ByteView payload);
  /// Finishes the file; call this at the end. Returns false if the disk is full. A capture that was
  /// not closed successfully is removed.
  bool Close();

 private:
  PcapWriter(std::string path, pcap* handle, pcap_dumper* dumper)
      : path_(std::move(path)), handle_(handle), dumper_(dumper) {}

  const std::string path_;
  pcap* handle_;
  pcap_dumper* dumper_;  // null after Close()
};

}  // namespace lidar::ouster
