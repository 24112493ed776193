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
  PadPtr sink;                                 // a link may push events to it during its removal
  std::vector<GstPad*> srcs;                   // one per link
  std::vector<GstLidarTargetBitrate> targets;  // as the links report them
  std::vector<std::string> reasons;            // of `targets`
  guint told = 0;                              // last target sent to the encoder [bit/s]
  std::optional<Time> key_unit_at;             // last request for a key unit
};

/// A report about packets of link `owner` that came by another link.
struct Misdirected {
  std::size_t owner;
  rtcp::CongestionFeedback report;
};

/// Copied packets, changed targets, and misdirected reports. They are passed on without the lock.
struct BondWork {
  std::vector<std::pair<PadPtr, BufferPtr>> copies;
  std::vector<std::pair<PadPtr, EventPtr>> targets;
  std::vector<Misdirected> reports;
};

/// The links' calls may still run when the element is finalized. Methods that are named
/// `...Locked` expect that the caller holds `mutex`.
struct BondShared {
  BondShared(std::size_t links, bonding::Method method, bonding::TargetRule rule)
      : scheduler(links, method, rule) {}
  ~BondShared() { gst_object_unref(clock); }

  Time Now() const { return Time{Duration{static_cast<std::int64_t>(gst_clock_get_time(clock))}}; }
  /// Keeps the packet while it may be copied. Returns the links that send it.
  bonding::LinkSet Schedule(GstBuffer* buffer, BondStream* stream);
  /// Stores the target of the link behind `src`. Returns an event with the combined target if that
  /// target is new to the encoder.
  EventPtr Combine(BondStream& stream, GstPad* src, const GstLidarTargetBitrate& target);
  /// Returns true for a request for a key unit that follows another request too soon.
  bool IsRepeatedRequest(BondStream& stream, GstEvent* event);
  BondWork TakeWorkLocked(const std::vector<std::unique_ptr<BondStream>>& streams);
  void ForgetPacketsLocked(const BondStream* stream);
  /// Forgets packets, reports and what was sent to the streams' encoders.
  void Clear(const std::vector<std::unique_ptr<BondStream>>& streams);

  std::mutex mutex;
  GstClock* clock = gst_system_clock_obtain();  // the links use the same one
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

/// Returns the interface by which the screamtx of link `index` calls the bond.
std::shared_ptr<TxLink> NewBondLink(std::shared_ptr<BondShared> bond, std::size_t index);

}  // namespace lidar::gst
