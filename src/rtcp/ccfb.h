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

/// The meaning of num_reports, the 16 bits after begin_seq.
enum class NumReports {
  kCount,          ///< the number of metric blocks (RFC 8888 with erratum 8166)
  kCountMinusOne,  ///< that number minus one (Ericsson's reference)
};

/// A packet in a report. `ecn` and `arrival_offset` are meaningless if the packet was not received.
struct PacketMetric {
  bool received = false;
  Ecn ecn = Ecn::kNotEct;
  /// The time from the packet's arrival to the report timestamp. It is unset if it is unknown, or
  /// too long for the field.
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
  /// The time of the report in units of 1/65536 s. Its epoch is the receiver's, so that only
  /// differences mod 2^32 are meaningful.
  std::uint32_t report_timestamp = 0;
};

/// Returns true if an RTCP packet has the type of RFC 8888 feedback, even if the packet is invalid.
bool IsCcfb(ByteView rtcp_packet);

/// Splits a compound or reduced-size RTCP datagram into its packets, without copying them. Returns
/// nothing if the lengths are inconsistent. The caller then treats the datagram as a single opaque
/// packet.
std::vector<ByteView> SplitRtcp(ByteView datagram);

/// Parses a peer's feedback, and detects which meaning of num_reports the peer uses. If the length
/// of a packet is correct under only one meaning, the peer uses this one. If both are possible, as
/// for odd counts, a padding half-word that is not zero shows kCountMinusOne. Otherwise the peer's
/// last meaning is kept, which is kCount at first.
class CcfbParser {
 public:
  /// Parses a whole RTCP packet. Returns nothing if the packet has another type or version, or a
  /// wrong length.
  std::optional<CongestionFeedback> Parse(ByteView rtcp_packet);
  NumReports num_reports() const { return reading_; }

 private:
  NumReports reading_ = NumReports::kCount;
};

/// Serialises feedback. Blocks without metrics are left out.
std::vector<std::uint8_t> BuildCcfb(const CongestionFeedback& feedback,
                                    NumReports reading = NumReports::kCount);

}  // namespace lidar::rtcp
