// SPDX-License-Identifier: LGPL-2.1-or-later
// The UDP datagrams of a capture file (pcap or pcapng), through libpcap.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "src/base/time.h"
#include "src/ouster/udp_datagram.h"

struct pcap;

namespace lidar::ouster {

class PcapReader {
 public:
  /// Returns null and sets `error` if the file is missing or is not a capture.
  static std::unique_ptr<PcapReader> Open(const std::string& path, std::string* error);

  struct Captured {
    UdpDatagram datagram;
    Time time;  // of the capture, since the Unix epoch
  };
  /// Returns nothing at the end of the file, or if it is damaged; error() then has the reason.
  std::optional<Captured> Next();
  /// Empty unless the file ended in the middle of a packet or is damaged.
  const std::string& error() const { return error_; }
  /// Goes back to the first packet. Returns false if the file is gone.
  bool Rewind();

  /// Returns the offset of the next frame, for GoTo() of any reader of this file. Returns nothing
  /// for pcapng, whose frames need the blocks before them.
  std::optional<std::int64_t> Offset() const;
  /// Makes Next() continue at `offset`. Returns false on failure; the position is then undefined.
  bool GoTo(std::int64_t offset);

 private:
  struct Close {
    void operator()(pcap* p) const;
  };
  using Handle = std::unique_ptr<pcap, Close>;

  PcapReader(std::string path, Handle handle);

  std::string path_;
  Handle handle_;
  LinkType link_;
  UdpExtractor extractor_;
  std::string error_;
};

}  // namespace lidar::ouster
