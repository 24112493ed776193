// SPDX-License-Identifier: LGPL-2.1-or-later
// What a bond shares with its links: the scheduler, and the packets that may still be copied.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "gst/scream/srtp/layer.h"
#include "gst/scream/tx/link.h"
#include "src/bonding/scheduler.h"

namespace lidar::gst {

struct BondStream {
  // Owned, because a link may push an event to the pad while the pad is removed.
  PadPtr sink;
  std::vector<GstPad*> srcs;                   // one per link
  std::vector<GstLidarTargetBitrate> targets;  // last target of each link
  std::vector<std::string> reasons;            // owned copies of the reasons in `targets`
  guint told = 0;                              // last target sent to the encoder [bit/s]
  std::optional<Time> key_unit_at;             // last request for a key unit
};

/// A report about packets that link `owner` sent, although another link received the report.
struct Misdirected {
  std::size_t owner;
  rtcp::CongestionFeedback report;
};

/// Copied packets, changed targets, and misdirected reports. The bond's thread passes them on
/// without the lock.
struct BondWork {
  std::vector<std::pair<PadPtr, BufferPtr>> copies;
  std::vector<std::pair<PadPtr, EventPtr>> targets;
  std::vector<Misdirected> reports;
};

/// The state that the bond shares with its links. It may outlive the bond, because a link may still
/// call it while the bond is finalized. The caller of a method named `...Locked` must hold `mutex`.
struct BondShared {
  BondShared(std::size_t links, bonding::Method method, bonding::TargetRule rule)
      : scheduler(links, method, rule) {}
  ~BondShared() { gst_object_unref(clock); }

  Time Now() const { return Time{Duration{static_cast<std::int64_t>(gst_clock_get_time(clock))}}; }
  /// Chooses the links that send the packet, and returns them. Keeps the packet for as long as it
  /// may be copied to another link.
  bonding::LinkSet Schedule(GstBuffer* buffer, BondStream* stream);
  /// Stores `target`, which the link behind `src` requested, and combines it with the targets of
  /// the other links. Returns an event with the combined target, or null if the encoder need not be
  /// sent a new target.
  EventPtr Combine(BondStream& stream, GstPad* src, const GstLidarTargetBitrate& target);
  /// Returns true if the event requests a key unit too soon after another request.
  bool IsRepeatedRequest(BondStream& stream, GstEvent* event);
  BondWork TakeWorkLocked(const std::vector<std::unique_ptr<BondStream>>& streams);
  void ForgetPacketsLocked(const BondStream* stream);
  /// Removes all packets and reports, and the record of what was sent to the encoders of `streams`.
  void Clear(const std::vector<std::unique_ptr<BondStream>>& streams);

  std::mutex mutex;
  GstClock* clock = gst_system_clock_obtain();  // the links use the same clock
  std::shared_ptr<SrtpLayer> srtp;              // set below READY
  bonding::Scheduler scheduler;
  std::vector<Misdirected> misdirected;

 private:
  struct Kept {
    BufferPtr buffer;
    BondStream* stream;
  };
  void KeepLocked(Time now, bonding::PacketId id, GstBuffer* buffer, BondStream* stream);
  EventPtr DueTargetLocked(BondStream& stream);

  std::unordered_map<std::uint64_t, Kept> kept_;
  std::deque<std::pair<Time, std::uint64_t>> order_;
};

/// Creates the object through which the screamtx of link `index` calls the bond.
std::shared_ptr<TxLink> NewBondLink(std::shared_ptr<BondShared> bond, std::size_t index);

}  // namespace lidar::gst
