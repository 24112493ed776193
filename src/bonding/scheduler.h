// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends one stream over several links: decides by which links each packet leaves.
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
  /// Copies overdue packets. While links are unsettled, copies all packets for which there is room.
  /// With TargetRule::kSum copies overdue packets only.
  kAdaptive,
  kBroadcast,  ///< copies each packet to each link
  kBackup,     ///< copies overdue packets only
};
/// How the targets of the links make the encoder's target.
enum class TargetRule {
  /// The highest rate of a working link. A link does not count if its packets take much longer than
  /// those of the nearest link.
  kBetter,
  kSum,
};

/// The path as the link's congestion control measures it.
struct PathView {
  DataRate rate;   // at which the congestion control lets packets out
  Duration rtt{};  // smoothed; 0: not known yet
  Duration min_rtt{};
};

struct LinkCounters {
  std::uint64_t packets = 0;  // assigned to this link first
  std::uint64_t copies = 0;
  std::uint64_t cancelled = 0;  // not sent, because another link delivered them
  std::uint64_t saved = 0;      // assigned to another link, but delivered here first or here only
  std::uint64_t gaps = 0;
};

/// Distributes the packets of a stream over links. Each link has a congestion control, and a FIFO
/// that the caller keeps in the order in which OnPacket() and TakeCopies() assign packets. Before a
/// packet leaves, the caller asks Wants(). Events come with their time; the class has no clock and
/// no lock.
///
///  - A slice goes to the link that will deliver it first: its delay is the size of queue and slice
///    over the rate, plus half a round trip.
///  - A link is in a gap if reports of its packets are overdue. Its packets that have not arrived
///    are copied at once to the best other link, or to all others if each is in a gap. Lost
///    packets are copied, too, and packets that take longer than expected.
///  - A link is unsettled for kUnsettled after its start and after each gap. While a link is
///    unsettled, each slice is copied to each link that has room. Otherwise one slice in
///    kProbeEvery is copied, so that all links stay measured.
///  - A link is unproven from its first use, or from its return, to its first report: only copies
///    show the receiver that it belongs to the sender. For kProving it gets a copy of each packet,
///    and no packet of its own if another link has reported.
///  - Links that pass one queue count as one: the nearest of them carries all packets until its
///    reports are overdue by kLongestGap, and each of the others carries one packet in
///    kProbeSpareEvery slices. Only broadcast copies go to all.
///  - A packet that arrived on one link is not sent on another. Copies that would arrive older than
///    kMaxAge are not sent: after a gap the newest slices come first.
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
    std::uint32_t slice = 0;  // shared by the packets of an access unit, as is their RTP timestamp
    bool ends_slice = true;   // the last packet of its access unit
  };
  /// Chooses the links of a new packet. The best link is always one of them.
  LinkSet OnPacket(Time now, const Packet& packet);
  struct Copy {
    PacketId id;
    std::size_t link;
  };
  /// Forgets the packets of a source that was flushed or removed: its FIFOs are empty.
  void Abandon(std::uint32_t ssrc);
  /// Returns the copies to queue now. Call it at least each kTick while packets are under way.
  std::vector<Copy> TakeCopies(Time now);
  static constexpr Duration kTick = std::chrono::milliseconds(10);

  // Returns true if the packet at the head of the link's FIFO is still useful there.
  bool Wants(Time now, std::size_t link, PacketId id) const;
  /// Notes that the packet leaves. Returns its number for the link's congestion control.
  std::uint16_t OnSent(Time now, std::size_t link, PacketId id);
  /// Notes that the caller dropped the packet, because it is late or Wants() was false. Returns
  /// true if another link delivered it.
  bool OnDropped(Time now, std::size_t link, PacketId id);

  /// Converts a report of the link's receiver to the link's numbers. Returns nothing if the report
  /// is impossible.
  std::optional<rtcp::CongestionFeedback> OnFeedback(Time now, std::size_t link,
                                                     const rtcp::CongestionFeedback& feedback);
  /// Returns the link that sent the packets of a report. It may differ from the link that the
  /// report came by: something between the ends may swap feedback.
  std::optional<std::size_t> OwnerOf(const rtcp::CongestionFeedback& feedback) const;
  void OnPath(std::size_t link, const PathView& path) { links_[link].path = path; }
  /// Sets whether packets can leave by the link at all.
  void SetUsable(Time now, std::size_t link, bool usable);

  bool InGap(Time now, std::size_t link) const;
  /// Returns true if packets may still arrive.
  bool AwaitsArrivals(Time now) const;
  /// Returns the bitrate for the encoder. `targets` has what each link may send.
  DataRate Target(Time now, const std::vector<DataRate>& targets) const;
  std::size_t links() const { return links_.size(); }
  bool usable(std::size_t link) const { return links_[link].usable; }
  bool has_reported(std::size_t link) const { return links_[link].has_reported; }
  /// Returns the first of the links that pass the same queue, which may be the link itself.
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
    std::optional<Time> usable_since;     // first packet, or the return of the link
    std::optional<Time> unsettled_since;  // first packet, or the last gap
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
  // The present slice.
  std::optional<std::uint32_t> slice_;
  DataSize slice_size_, last_slice_size_;
  LinkSet slice_links_, spare_;
  std::size_t slice_first_ = 0;
  unsigned slices_ = 0;
};

}  // namespace lidar::bonding
