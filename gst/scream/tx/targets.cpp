// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/targets.h"

#include <gst/video/video.h>

#include <utility>

#include "gst/common/fields.h"

namespace lidar::gst {
namespace {

using namespace std::chrono_literals;

constexpr Duration kKeyUnitInterval = 500ms;

/// Returns true if a key unit is due and the last request is long enough ago. Key frames are large
/// and would cause congestion if they were requested too often.
bool MayAskForKeyUnit(const TxStream& stream, Time now) {
  return stream.key_unit_due &&
         (!stream.last_key_unit || now - *stream.last_key_unit >= kKeyUnitInterval);
}

EventPtr KeyUnitEvent(TxStream& stream, Time now) {
  stream.key_unit_due = false;
  stream.last_key_unit = now;
  return EventPtr(
      gst_video_event_new_upstream_force_key_unit(GST_CLOCK_TIME_NONE, TRUE, ++stream.key_units));
}

EventPtr TargetEvent(const TxStream& stream, const scream::Controller& controller, Time now,
                     const char* reason) {
  const scream::Statistics s = controller.statistics(now);
  GstLidarTargetBitrate target{};
  target.bitrate = ToEncoder(stream, controller.target_bitrate(stream.id));
  target.ssrc = stream.ssrc.value_or(0);
  target.min_bitrate = ToEncoder(stream, stream.config.needed_bitrate);
  target.max_bitrate = ToEncoder(stream, stream.config.max_bitrate);
  target.rtt = Kind<Duration>::Ns(s.s_rtt);
  target.queue_delay = Kind<Duration>::Ns(s.qdelay);
  target.reason = reason != nullptr ? reason : scream::ToString(s.reason);
  return EventPtr(gst_lidar_event_new_target_bitrate(&target));
}

PadPtr Ref(GstPad* pad) { return PadPtr(GST_PAD(gst_object_ref(pad))); }

}  // namespace

bool EvaluateTargets(TxStream& stream, const scream::Controller& controller, bool key_unit_on_loss,
                     Time now) {
  if (stream.has_caps && stream.notifier.ShouldNotify(now, controller.target_bitrate(stream.id)))
    stream.target_due = true;
  if (stream.is_video) {
    const guint64 lost = controller.stream_statistics(now, stream.id).packets_lost;
    if (key_unit_on_loss && lost > stream.lost_seen) stream.key_unit_due = true;
    stream.lost_seen = lost;
  }
  return TargetsAreDue(stream, now);
}

bool TargetsAreDue(const TxStream& stream, Time now) {
  return stream.target_due || !stream.receipts.empty() || MayAskForKeyUnit(stream, now);
}

void TakeTargets(TxStream& stream, const scream::Controller& controller, Time now,
                 std::vector<PadEvent>* events) {
  if (std::exchange(stream.target_due, false))
    events->push_back({Ref(stream.pad), TargetEvent(stream, controller, now, nullptr), true});
  for (EventPtr& receipt : stream.receipts.Take())
    events->push_back({Ref(stream.pad), std::move(receipt), false});
  if (MayAskForKeyUnit(stream, now))
    events->push_back({Ref(stream.pad), KeyUnitEvent(stream, now), false});
}

EventPtr FirstTarget(TxStream& stream, const scream::Controller& controller, Time now) {
  if (stream.has_caps) return nullptr;
  stream.has_caps = true;
  stream.notifier.Reset();
  stream.notifier.ShouldNotify(now, controller.target_bitrate(stream.id));
  return TargetEvent(stream, controller, now, "start");
}

}  // namespace lidar::gst
