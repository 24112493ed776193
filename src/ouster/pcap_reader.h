// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads UDP datagrams from a capture file (pcap or pcapng), with libpcap.
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
    Time time;  // capture time, since the Unix epoch
  };
  /// Returns the next datagram, or nothing at the end of the file. Also returns nothing if the file
  /// is damaged; error() then returns the reason.
  std::optional<Captured> Next();
  /// Returns an empty text unless the file is damaged or ends in the middle of a packet.
  const std::string& error() const { return error_; }
  /// Goes back to the first packet. Returns false if the file can no longer be opened.
  bool Rewind();

  /// Returns the offset of the next frame, which GoTo() of any reader of this file accepts. Returns
  /// nothing for pcapng files, because their frames can be read only after the blocks before them.
  std::optional<std::int64_t> Offset() const;
  /// Makes Next() continue at `offset`. If it fails, returns false, and the position is undefined.
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
