// SPDX-License-Identifier: LGPL-2.1-or-later
// RFC 8888 congestion control feedback (RTCP PT 205, FMT 11): parses and builds it.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/ecn.h"
#include "src/base/time.h"

namespace lidar::rtcp {

/// Meaning of the 16 bits after begin_seq.
enum class NumReports {
  kCount,          ///< the number of metric blocks (RFC 8888 with erratum 8166)
  kCountMinusOne,  ///< that number minus one (Ericsson's reference)
};

/// A packet in a report. `ecn` and `arrival_offset` are meaningless if it was not received.
struct PacketMetric {
  bool received = false;
  Ecn ecn = Ecn::kNotEct;
  /// Time from the packet's arrival to the report timestamp. Unset if unknown or too long for the
  /// field.
  std::optional<Duration> arrival_offset;
};

struct SsrcReport {
  std::uint32_t ssrc = 0;
  std::uint16_t begin_seq = 0;
  std::vector<PacketMetric> metrics;  ///< for begin_seq, begin_seq + 1, ...
};

struct CongestionFeedback {
  std::uint32_t sender_ssrc = 0;
  std::vector<SsrcReport> blocks;
  /// Counts 1/65536 s. The epoch is the receiver's, so only differences mod 2^32 are meaningful.
  std::uint32_t report_timestamp = 0;
};

/// Returns true for an RTCP packet with the type of RFC 8888 feedback, valid or not.
bool IsCcfb(ByteView rtcp_packet);

/// Splits a compound or reduced-size RTCP datagram into its packets, without a copy. Returns
/// nothing if the lengths do not add up: then the datagram is to be treated as one opaque packet.
std::vector<ByteView> SplitRtcp(ByteView datagram);

/// Parses a peer's feedback and detects its reading of num_reports. A length that fits only one
/// reading decides. If both fit (odd counts), a padding half-word that is not zero shows
/// kCountMinusOne; otherwise the last reading holds, at first kCount.
class CcfbParser {
 public:
  /// Parses one whole RTCP packet. Returns nothing for other types and versions, and for wrong
  /// lengths.
  std::optional<CongestionFeedback> Parse(ByteView rtcp_packet);
  NumReports num_reports() const { return reading_; }

 private:
  NumReports reading_ = NumReports::kCount;
};

/// Serialises feedback. Blocks without metrics are left out.
std::vector<std::uint8_t> BuildCcfb(const CongestionFeedback& feedback,
                                    NumReports reading = NumReports::kCount);

}  // namespace lidar::rtcp
