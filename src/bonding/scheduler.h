// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends one stream over several links: which packet goes where, and what goes twice.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <vector>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/bonding/link_ledger.h"
#include "src/bonding/packet_id.h"

namespace lidar::bonding {

enum class Method {
  /// Copies what waits, and while links are not settled all that has room; with summed targets only
  /// what waits.
  kAdaptive,
  kBroadcast,  ///< a copy on every link
  kBackup,     ///< copies of what waits only
};
/// What the encoder is asked for.
enum class TargetRule {
  /// The rate of the better working link, without links whose packets take much longer than the
  /// nearest one's.
  kBetter,
  kSum,
};

/// The path as a link's congestion control measures it.
struct PathView {
  DataRate rate;   // of the packets that it lets out
  Duration rtt{};  // smoothed; 0: not known yet
};

struct LinkCounters {
  std::uint64_t packets = 0;  // that were assigned to it first
  std::uint64_t copies = 0;
  std::uint64_t cancelled = 0;  // that were not sent, as another link had brought them
  std::uint64_t saved = 0;      // that arrived by it only, or first, though they left by another
  std::uint64_t gaps = 0;
};

/// Distributes the packets of a stream over links, each with a congestion control and a FIFO at the
/// caller. Packets stay there in the order in which OnPacket() and TakeCopies() assign them; before
/// a packet leaves, the caller asks Wants(). Events with their time in, decisions out: no clock, no
/// lock.
///
///  - A slice goes where it will be whole first: queue and size over rate, and half a round trip.
///  - A link is in a gap if reports of what left are overdue. What was assigned to it and has not
///    arrived is copied to the best other link at once, or to all others if each is in a gap; so
///    are lost packets, and packets that take longer than was foreseen.
///  - While a link is not settled (it started, or was in a gap, within kUnsettled), every slice is
///    copied to each link that has room. Otherwise one slice in kProbeEvery is, so that all links
///    stay measured.
///  - A link is unproven until its first report after it was first used, or became usable: the
///    receiver finds a link by its copies only. For kProving it gets a copy of every packet, and no
///    packet of its own if another link has reported.
///  - A packet that arrived on one link is not sent on another, nor is a copy older than kMaxAge:
///    the newest slices are the first behind a gap.
class Scheduler {
 public:
  static constexpr Duration kMaxAge = std::chrono::milliseconds(200);
  static constexpr Duration kUnsettled = std::chrono::seconds(3);
  static constexpr Duration kProving = std::chrono::seconds(1);
  static constexpr int kProbeEvery = 8;
  static constexpr std::size_t kMaxPackets = 8192;

  Scheduler(std::size_t links, Method method, TargetRule rule = TargetRule::kBetter);

  struct Packet {
    PacketId id;
    DataSize size;
    std::uint32_t slice = 0;  // packets of one access unit share it, as their RTP timestamp
    bool ends_slice = true;   // the last of them
  };
  /// Chooses the links of a new packet; the best link is always one of them.
  LinkSet OnPacket(Time now, const Packet& packet);
  struct Copy {
    PacketId id;
    std::size_t link;
  };
  /// Returns what is to be queued once more; call it at least each kTick while packets are under
  /// way.
  std::vector<Copy> TakeCopies(Time now);
  static constexpr Duration kTick = std::chrono::milliseconds(10);

  // Returns true if the packet at the head of the link's FIFO is still of use there.
  bool Wants(Time now, std::size_t link, PacketId id) const;
  /// Notes that the packet leaves; returns its number for the link's congestion control.
  std::uint16_t OnSent(Time now, std::size_t link, PacketId id);
  /// Notes that the caller dropped the packet: it is late, or Wants() was false.
  void OnDropped(Time now, std::size_t link, PacketId id);

  /// Converts a report of the link's receiver into the link's numbers; nothing if that is
  /// impossible.
  std::optional<scream::CongestionFeedback> OnFeedback(Time now, std::size_t link,
                                                       const scream::CongestionFeedback& feedback);
  void OnPath(std::size_t link, const PathView& path) { links_[link].path = path; }
  /// Packets cannot leave by the link at all, or can again.
  void SetUsable(Time now, std::size_t link, bool usable);

  bool InGap(Time now, std::size_t link) const;
  /// Returns true if a packet that has not arrived still may.
  bool AwaitsArrivals(Time now) const;
  /// The bitrate for the encoder, from what each link may send.
  DataRate Target(Time now, const std::vector<DataRate>& targets) const;
  std::size_t links() const { return links_.size(); }
  bool usable(std::size_t link) const { return links_[link].usable; }
  bool has_reported(std::size_t link) const { return links_[link].has_reported; }
  const LinkCounters& counters(std::size_t link) const { return links_[link].counters; }

 private:
  struct Link {
    LinkLedger ledger;
    PathView path;
    DataSize queued;  // assigned, and neither sent nor dropped
    bool usable = true;
    bool was_in_gap = false;
    bool has_reported = false;            // since it is usable
    std::optional<Time> usable_since;     // with the first packet, and with each return
    std::optional<Time> unsettled_since;  // with the first packet, and with each gap
    LinkCounters counters;
  };
  struct Entry {
    DataSize size;
    Time made{};
    Time expected{};  // when its acknowledgement is due
    std::size_t first = 0;
    LinkSet assigned, waits;  // waits: in the FIFO
    bool ends_slice = true;
    bool arrived = false;
    bool missing = false;
  };

  Entry* Find(PacketId id);
  const Entry* Find(PacketId id) const;
  void Forget(Time now);
  void Assign(std::size_t link, Entry* entry);
  void LookAtGaps(Time now);
  bool Overdue(Time now, const Entry& entry) const;
  LinkSet OthersFor(Time now, const Entry& entry) const;
  Duration WholeIn(std::size_t link, Time now, DataSize size) const;
  std::size_t Best(Time now, DataSize size, LinkSet among) const;
  LinkSet CopiesOf(Time now, DataSize slice) const;
  bool Settled(Time now) const;
  static bool Proves(Time now, const Link& link);
  static Duration Rtt(const Link& link);
  static bool IsDead(Time now, const Link& link);

  const Method method_;
  const TargetRule rule_;
  std::vector<Link> links_;
  std::deque<PacketId> order_;
  std::unordered_map<std::uint64_t, Entry> packets_;
  // The slice that comes now.
  std::optional<std::uint32_t> slice_;
  DataSize slice_size_, last_slice_size_;
  LinkSet slice_links_;
  std::size_t slice_first_ = 0;
  int since_probe_ = 0;
};

}  // namespace lidar::bonding
