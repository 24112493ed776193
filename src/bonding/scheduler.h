// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends one stream over several links: decides over which links each packet is sent.
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
#include "src/bonding/shared_queues.h"

namespace lidar::bonding {

enum class Method {
  /// Copies overdue packets. While links are unsettled, also copies all other packets to each link
  /// that has room. With TargetRule::kSum, copies overdue packets only.
  kAdaptive,
  kBroadcast,  ///< copies each packet to each link
  kBackup,     ///< copies overdue packets only
};
/// The rule by which the encoder's target is computed from the targets of the links.
enum class TargetRule {
  /// The highest target of a working link. A link does not count if its round trip is much longer
  /// than the shortest one.
  kBetter,
  kSum,
};

/// The path as the link's congestion control measures it.
struct PathView {
  DataRate rate;   // at which the congestion control sends packets
  Duration rtt{};  // smoothed; 0: not known yet
  Duration min_rtt{};
};

struct LinkCounters {
  std::uint64_t packets = 0;  // assigned to this link first
  std::uint64_t copies = 0;
  std::uint64_t cancelled = 0;  // not sent, because another link delivered them
  // Assigned to another link, but delivered first or only by this link.
  std::uint64_t saved = 0;
  std::uint64_t gaps = 0;
};

/// Distributes the packets of a stream over links. Each link has its own congestion control. It
/// also has a FIFO, which the caller keeps in the order in which OnPacket() and TakeCopies() assign
/// packets to the link. Before the caller sends a packet, it calls Wants(). Events come with their
/// time; the class has no clock and no lock.
///
///  - A slice goes to the link that will deliver it first. The time of the delivery is the size of
///    the link's queue and the slice, divided by the link's rate, plus half a round trip.
///  - A link is in a gap if reports about its packets are overdue. Its packets that have not
///    arrived are then copied at once to the best other link, or to all other links if all of them
///    are in a gap. Packets that are lost, or that take longer than expected, are copied, too.
///  - A link is unsettled for kUnsettled after its start and after each gap. While a link is
///    unsettled, each slice is copied to every link that has room. Otherwise one slice in
///    kProbeEvery is copied, so that all links are still measured.
///  - A link is unproven from its first use, or from its return, until its first report. The
///    receiver recognises only by copies that the link belongs to the sender. The link therefore
///    gets a copy of each packet for kProving, and no packets of its own if another link has
///    reported.
///  - Links that share a queue count as one link. The nearest of them carries all packets until its
///    reports are overdue by kLongestGap. Each of the others carries one packet in kProbeSpareEvery
///    slices. Only broadcast copies go to all of them.
///  - A packet that has arrived over one link is not sent over another. A copy that would arrive
///    older than kMaxAge is not sent, so that after a gap the newest slices are sent first.
class Scheduler {
 public:
  static constexpr Duration kMaxAge = std::chrono::milliseconds(200);
  static constexpr Duration kUnsettled = std::chrono::seconds(3);
  static constexpr Duration kProving = std::chrono::seconds(1);
  static constexpr unsigned kProbeEvery = 8;
  static constexpr unsigned kProbeSpareEvery = 32;
  static constexpr std::size_t kMaxPackets = 8192;

  Scheduler(std::size_t links, Method method, TargetRule rule = TargetRule::kBetter);

  /// Forgets everything except which links are usable.
  void Restart();

  struct Packet {
    PacketId id;
    DataSize size;
    // The same for all packets of an access unit, as is their RTP timestamp.
    std::uint32_t slice = 0;
    bool ends_slice = true;  // the last packet of its access unit
  };
  /// Chooses the links over which a new packet is sent. The best link is always one of them.
  LinkSet OnPacket(Time now, const Packet& packet);
  struct Copy {
    PacketId id;
    std::size_t link;
  };
  /// Forgets the packets of an SSRC that was flushed or removed. Call it when the FIFOs have none
  /// of these packets.
  void Abandon(std::uint32_t ssrc);
  /// Returns the copies that must be queued now. Call it at least every kTick while packets are in
  /// flight.
  std::vector<Copy> TakeCopies(Time now);
  static constexpr Duration kTick = std::chrono::milliseconds(10);

  // Returns true if the link should still send the packet, which is at the head of the link's FIFO.
  bool Wants(Time now, std::size_t link, PacketId id) const;
  /// Call it when the link sends the packet. Returns the packet's number for the link's congestion
  /// control.
  std::uint16_t OnSent(Time now, std::size_t link, PacketId id);
  /// Call it when the caller drops the packet, because the packet is late or Wants() was false.
  /// Returns true if another link has delivered the packet.
  bool OnDropped(Time now, std::size_t link, PacketId id);

  /// Converts a report of the link's receiver to the numbers of this link. Returns nothing if the
  /// report names packets that this link never sent.
  std::optional<rtcp::CongestionFeedback> OnFeedback(Time now, std::size_t link,
                                                     const rtcp::CongestionFeedback& feedback);
  /// Returns the link that sent the packets of a report. This may be another link than the link
  /// over which the report came, because something between the two ends may swap feedback.
  std::optional<std::size_t> OwnerOf(const rtcp::CongestionFeedback& feedback) const;
  void OnPath(std::size_t link, const PathView& path) { links_[link].path = path; }
  /// Sets whether the link can send packets at all.
  void SetUsable(Time now, std::size_t link, bool usable);

  bool InGap(Time now, std::size_t link) const;
  /// Returns true if packets that have not arrived may still arrive.
  bool AwaitsArrivals(Time now) const;
  /// Returns the target bitrate for the encoder. `targets` has the bitrate that each link may send.
  DataRate Target(Time now, const std::vector<DataRate>& targets) const;
  std::size_t links() const { return links_.size(); }
  bool usable(std::size_t link) const { return links_[link].usable; }
  bool has_reported(std::size_t link) const { return links_[link].has_reported; }
  /// Returns the first of the links that share a queue with `link`, or `link` itself.
  std::size_t Bottleneck(std::size_t link) const;
  const LinkCounters& counters(std::size_t link) const { return links_[link].counters; }

 private:
  struct Link {
    LinkLedger ledger;
    PathView path;
    DataSize queued;  // assigned, not yet sent or dropped
    bool usable = true;
    bool was_in_gap = false;
    bool has_reported = false;            // since the link became usable
    std::optional<Time> usable_since;     // time of the first packet, or of the link's return
    std::optional<Time> unsettled_since;  // time of the first packet, or of the last gap
    LinkCounters counters;
  };
  struct Entry {
    DataSize size;
    Time made{};
    Time expected{};  // when its acknowledgement is due
    std::size_t first = 0;
    LinkSet assigned, waits;  // `waits`: in these links' FIFOs
    bool ends_slice = true;
    bool arrived = false;
    bool missing = false;
  };

  Entry* Find(PacketId id);
  const Entry* Find(PacketId id) const;
  void Forget(Time now);
  void Erase(PacketId id);
  void Assign(std::size_t link, Entry* entry);
  void LookAtGaps(Time now);
  bool Overdue(Time now, const Entry& entry) const;
  LinkSet OthersFor(Time now, const Entry& entry) const;
  LinkSet Spare(Time now) const;
  Duration WholeIn(std::size_t link, Time now, DataSize size) const;
  std::size_t Best(Time now, DataSize size, LinkSet among) const;
  LinkSet CopiesOf(Time now, DataSize slice) const;
  bool Settled(Time now) const;
  static bool Proves(Time now, const Link& link);
  static Duration Rtt(const Link& link);
  static Duration LeastTravel(const Link& link);
  static bool IsDead(Time now, const Link& link);

  Method method_;
  TargetRule rule_;
  std::vector<Link> links_;
  SharedQueues shared_;
  std::deque<PacketId> order_;
  std::unordered_map<std::uint64_t, Entry> packets_;
  // The current slice.
  std::optional<std::uint32_t> slice_;
  DataSize slice_size_, last_slice_size_;
  LinkSet slice_links_, spare_;
  std::size_t slice_first_ = 0;
  unsigned slices_ = 0;
};

}  // namespace lidar::bonding
