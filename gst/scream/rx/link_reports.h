// SPDX-License-Identifier: LGPL-2.1-or-later
// Feedback for each link of the peer, and detection of packets that came by several links.
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

/// Reports of a link cover the packets that came by it. The first link may have no address.
class LinkReports {
 public:
  /// A new link replaces the link that has been silent for longest.
  static constexpr std::size_t kMaxLinks = 4;

  struct Report {
    rtcp::CongestionFeedback feedback;
    GSocketAddress* to;  // not owned; NULL if unknown
  };

  /// Forgets everything.
  void Reset(const rtcp::FeedbackConfig& config);
  void set_config(const rtcp::FeedbackConfig& config);
  void OnPacket(GSocketAddress* from, Time arrival, const rtcp::ReceivedPacket& packet);
  /// Forgets the packets of an SSRC whose sender has restarted.
  void Forget(std::uint32_t ssrc);
  Time NextDue() const;
  std::optional<Report> Take(Time now);

  struct LinkStats {
    std::string address;
    rtcp::FeedbackGenerator::Stats feedback;
  };
  std::vector<LinkStats> stats() const;
  /// Sums over all links, including replaced ones.
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

/// Packets that have arrived by any link. A packet that is too old to be found counts as new.
class SeenPackets {
 public:
  static constexpr int kWindow = 4096;
  static constexpr std::size_t kMaxSources = 64;

  /// Returns true if the number arrived before with another RTP timestamp: the sender has
  /// restarted.
  bool ShowsRestart(std::uint32_t ssrc, std::uint16_t seq, std::uint32_t timestamp) const;
  /// Returns false for a repeated packet. After a restart, earlier packets are forgotten.
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
