// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the packets of a capture file with their due times. The file may be looped.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "src/ouster/metadata.h"
#include "src/ouster/pcap_reader.h"
#include "src/ouster/sensor_stream.h"

namespace lidar::gst {

class PcapFeed {
 public:
  /// Returns null and sets `error` if the file is missing or is not a capture.
  static std::unique_ptr<PcapFeed> Open(const std::string& path, const ouster::Metadata& metadata,
                                        bool loop, std::string* error);

  struct Packet {
    std::vector<std::uint8_t> payload;
    Duration due{};  // since the first packet of the first round
    Time captured;   // since the Unix epoch
    ouster::Sender sender{};
    bool starts_over = false;  // true for the first packet of a later round
  };
  /// Returns the next packet, or nothing at the end of the file. Also returns nothing if the file
  /// is damaged; error() then returns the reason.
  std::optional<Packet> Next();
  /// Makes Next() continue at `offset` in the file, or at the front if there is no offset. Due
  /// times are then relative to `first`. Returns false if the file cannot be opened. Must not be
  /// used with `loop`.
  bool Reposition(Time first, std::optional<std::int64_t> offset);
  const std::string& error() const { return error_; }
  bool found_lidar_packets() const { return found_; }
  /// Describes the file's packets in a text for the user, for files without packets of this sensor.
  std::string DescribeContents() const;

 private:
  PcapFeed() = default;
  bool StartOver();

  std::unique_ptr<ouster::PcapReader> reader_;
  std::size_t packet_size_ = 0;
  Duration packet_interval_{};
  bool loop_ = false;
  std::optional<Time> first_;  // capture time of the first packet in this round
  Time last_{};
  Duration round_start_{};
  bool starts_over_ = false;
  bool found_ = false;
  std::map<std::size_t, std::uint64_t> sizes_;  // number of packets by payload size [bytes]
  std::string error_;
};

}  // namespace lidar::gst
