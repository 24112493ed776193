// SPDX-License-Identifier: LGPL-2.1-or-later
// RFC 8888 congestion control feedback (RTCP PT 205, FMT 11): parse and build.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/time.h"
#include "src/scream/ecn.h"

namespace lidar::scream {

/// What the 16 bits after begin_seq hold.
enum class NumReports {
  kCount,          ///< the number of metric blocks (RFC 8888 with erratum 8166)
  kCountMinusOne,  ///< one less (Ericsson's reference)
};

/// One packet of a report. `ecn` and `arrival_offset` mean nothing where it was not received.
struct PacketMetric {
  bool received = false;
  Ecn ecn = Ecn::kNotEct;
  /// Time from the packet's arrival to the report timestamp; absent: not available, or so long
  /// that the field saturated.
  std::optional<Duration> arrival_offset;
};

struct SsrcReport {
  std::uint32_t ssrc = 0;
  std::uint16_t begin_seq = 0;
  std::vector<PacketMetric> metrics;  ///< of begin_seq, begin_seq + 1, ...
};

struct CongestionFeedback {
  std::uint32_t sender_ssrc = 0;
  std::vector<SsrcReport> blocks;
  /// In 1/65536 s; the epoch is the receiver's own, only differences mod 2^32 mean something.
  std::uint32_t report_timestamp = 0;
};

/// True for one RTCP packet that claims to be RFC 8888 feedback (it may still not parse).
bool IsCcfb(ByteView rtcp_packet);

/// Splits a compound (or reduced-size) RTCP datagram into its packets, without copying. Empty
/// where the lengths do not add up: the datagram is then to be treated as one opaque packet.
std::vector<ByteView> SplitRtcp(ByteView datagram);

/// Parses feedback of a peer and learns which reading of num_reports it uses. A packet whose length
/// fits one reading only decides. Where both fit (odd counts), a padding half-word that is not zero
/// is a block; otherwise the reading learnt last holds, kCount at first.
class CcfbParser {
 public:
  /// One RTCP packet, whole. Nothing for other packet types, versions, lengths that do not fit.
  std::optional<CongestionFeedback> Parse(ByteView rtcp_packet);
  NumReports num_reports() const { return reading_; }

 private:
  NumReports reading_ = NumReports::kCount;
};

/// Serialises; blocks without metrics are left out.
std::vector<std::uint8_t> BuildCcfb(const CongestionFeedback& feedback,
                                    NumReports reading = NumReports::kCount);

}  // namespace lidar::scream
