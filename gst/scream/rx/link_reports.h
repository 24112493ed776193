// SPDX-License-Identifier: LGPL-2.1-or-later
// Feedback for each link of the peer, and detection of packets that arrive over several links.
#pragma once
#include <gio/gio.h>

#include <bitset>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gst/net/udp_socket.h"
#include "src/base/time.h"
#include "src/rtcp/feedback_generator.h"

namespace lidar::gst {

/// Generates separate reports for each link of the peer. The reports of a link cover the packets
/// that arrived over this link. The first link may have no address.
class LinkReports {
 public:
  /// The greatest number of links. A further link replaces the link that has been silent for
  /// longest.
  static constexpr std::size_t kMaxLinks = 4;

  struct Report {
    rtcp::CongestionFeedback feedback;
    GSocketAddress* to;  // not owned; NULL if unknown
  };

  /// Removes all links and their counters, and sets the configuration.
  void Reset(const rtcp::FeedbackConfig& config);
  void set_config(const rtcp::FeedbackConfig& config);
  void OnPacket(GSocketAddress* from, Time arrival, const rtcp::ReceivedPacket& packet);
  /// Call it when the sender of `ssrc` has restarted. Removes the record of the SSRC's packets.
  void Forget(std::uint32_t ssrc);
  Time NextDue() const;
  std::optional<Report> Take(Time now);

  struct LinkStats {
    std::string address;
    rtcp::FeedbackGenerator::Stats feedback;
  };
  std::vector<LinkStats> stats() const;
  /// Returns the sums over all links, including replaced ones.
  rtcp::FeedbackGenerator::Stats Sum() const;

 private:
  struct Link {
    SocketAddressPtr address;
    rtcp::FeedbackGenerator generator;
    Time last{};
  };
  Link& LinkOf(GSocketAddress* from);

  rtcp::FeedbackConfig config_;
  std::vector<Link> links_;
  rtcp::FeedbackGenerator::Stats replaced_;  // sum over replaced links
};

/// The packets that have arrived over any link. A packet that is kWindow or more numbers behind the
/// newest one counts as new.
class SeenPackets {
 public:
  static constexpr int kWindow = 4096;
  static constexpr std::size_t kMaxSources = 64;

  /// Returns true if the sender has restarted: `seq` has arrived before, but with another RTP
  /// timestamp.
  bool ShowsRestart(std::uint32_t ssrc, std::uint16_t seq, std::uint32_t timestamp) const;
  /// Adds a packet. Returns false if the packet has arrived before. After a restart, the earlier
  /// packets are forgotten.
  bool Add(std::uint32_t ssrc, std::uint16_t seq, std::uint32_t timestamp);

 private:
  struct Source {
    std::uint16_t newest = 0;
    std::bitset<kWindow> seen;
    std::vector<std::uint32_t> timestamps = std::vector<std::uint32_t>(kWindow);
  };
  std::map<std::uint32_t, Source> sources_;
};

}  // namespace lidar::gst
