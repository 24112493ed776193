// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/upstream_reporter.h"

#include <gst/video/video.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "gst/scream/tx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_tx_debug

namespace lidar::gst {
namespace {

using namespace std::chrono_literals;

constexpr Duration kPulse = 200ms;  // of target-bitrate
constexpr Duration kKeyUnitInterval = 500ms;
// One may fall to an outage.
constexpr guint64 kFramesUntilWarning = 20;
// The wire share moves the encoder's bounds only where it changed by more than this.
constexpr double kShareThreshold = 0.02;

/// Key frames are large: asked for too often they are the congestion.
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

/// Host and port of the sink behind `src`, where they are to be found.
std::string Destination(GstPad* src) {
  PadPtr pad(GST_PAD(gst_object_ref(src)));
  for (int hops = 0; hops < 8 && pad; ++hops) {
    const PadPtr peer(gst_pad_get_peer(pad.get()));
    const ElementPtr next(peer ? gst_pad_get_parent_element(peer.get()) : nullptr);
    if (!next) return "";
    auto* klass = G_OBJECT_GET_CLASS(next.get());
    if (g_object_class_find_property(klass, "host") != nullptr &&
        g_object_class_find_property(klass, "port") != nullptr) {
      gchar* host = nullptr;
      gint port = 0;
      g_object_get(next.get(), "host", &host, "port", &port, nullptr);
      const StringPtr owner(host);
      return std::string(host != nullptr ? host : "?") + ":" + std::to_string(port);
    }
    GST_OBJECT_LOCK(next.get());
    GList* pads = next->srcpads;
    pad.reset(pads != nullptr ? GST_PAD(gst_object_ref(pads->data)) : nullptr);
    GST_OBJECT_UNLOCK(next.get());
  }
  return "";
}

PadPtr Ref(GstPad* pad) { return PadPtr(GST_PAD(gst_object_ref(pad))); }

}  // namespace

TxState& UpstreamReporter::state() const { return *self_->state; }

bool UpstreamReporter::Start() {
  stop_ = false;
  GError* error = nullptr;
  thread_ = g_thread_try_new(
      "screamtx:upstream",
      [](gpointer self) -> gpointer {
        static_cast<UpstreamReporter*>(self)->Run();
        return nullptr;
      },
      this, &error);
  if (thread_ != nullptr) return true;
  const ErrorPtr owner(error);
  GST_ELEMENT_ERROR(self_, RESOURCE, FAILED, ("No thread can be made: %s", error->message),
                    ("screamtx needs one to tell the encoders their bitrate"));
  return false;
}

void UpstreamReporter::Stop() {
  if (thread_ == nullptr) return;
  {
    const TxLock lock(state().mutex);
    stop_ = true;
    due_.notify_one();
  }
  g_thread_join(thread_);
  thread_ = nullptr;
}

void UpstreamReporter::Reset(Time now) {
  notifier_.Reset();
  ecn_announced_ = ecn_state_ = state().controller->ecn_state();
  next_stats_ = now;
  watch_ = {};
  silence_announced_ = warned_of_silence_ = warned_of_unheeded_ = unheeded_ = false;
}

bool UpstreamReporter::EvaluateStream(TxStream& stream, Time now) {
  TxState& s = state();
  const double share = stream.overhead.payload_share();
  if (stream.bounds && std::abs(share / stream.configured_share - 1) > kShareThreshold)
    Configure(s, stream);
  if (stream.has_caps && stream.notifier.ShouldNotify(now, s.controller->target_bitrate(stream.id)))
    stream.target_due = true;
  if (s.settings.key_unit_on_loss && stream.is_video) {
    const guint64 lost = s.controller->stream_statistics(now, stream.id).packets_lost;
    stream.key_unit_due = stream.key_unit_due || lost > stream.lost_seen;
    stream.lost_seen = lost;
  }
  return stream.target_due || !stream.receipts.empty() || MayAskForKeyUnit(stream, now);
}

bool UpstreamReporter::EvaluateEstimate(Time now) {
  const DataRate total = state().controller->target_bitrate();
  if (!notifier_.ShouldNotify(now, total)) return estimate_due_;
  const guint bps = Kind<DataRate>::Bps(total);
  estimate_due_ = estimate_due_ || bps != estimated_bps_;
  estimated_bps_ = bps;
  return estimate_due_;
}

void UpstreamReporter::Evaluate(Time now) {
  TxState& s = state();
  bool due = EvaluateEstimate(now);
  due = due || watch_.silent() != silence_announced_;
  for (auto& stream : s.streams) due = EvaluateStream(*stream, now) || due;
  ecn_state_ = s.controller->ecn_state();
  if (s.settings.stats_interval > 0ns && now >= next_stats_) {
    next_stats_ = now + s.settings.stats_interval;
    stats_due_ = true;
  }
  if (due || stats_due_ || ecn_state_ != ecn_announced_) due_.notify_one();
}

Time UpstreamReporter::NextLook(Time now) const {
  const bool stats = state().settings.stats_interval > 0ns;
  return stats ? std::min(now + kPulse, next_stats_) : now + kPulse;
}

EventPtr UpstreamReporter::FirstTarget(TxStream& stream, Time now) {
  if (stream.has_caps || !state().controller) return nullptr;
  stream.has_caps = true;
  stream.notifier.Reset();
  stream.notifier.ShouldNotify(now, state().controller->target_bitrate(stream.id));
  return TargetEvent(stream, now, "start");
}

EventPtr UpstreamReporter::TargetEvent(const TxStream& stream, Time now, const char* reason) const {
  const scream::Controller& controller = *state().controller;
  const scream::Statistics s = state().controller->statistics(now);
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

MessagePtr UpstreamReporter::EcnMessage() {
  GstStructure* s = gst_structure_new("scream-ecn-state-changed", "state", G_TYPE_STRING,
                                      scream::ToString(ecn_state_), "previous", G_TYPE_STRING,
                                      scream::ToString(ecn_announced_), nullptr);
  ecn_announced_ = ecn_state_;
  return MessagePtr(gst_message_new_element(GST_OBJECT(self_), s));
}

bool UpstreamReporter::HasWork() const {
  const auto& streams = state().streams;
  const Time now = TxNow(state());
  return stop_ || stats_due_ || estimate_due_ || ecn_state_ != ecn_announced_ ||
         watch_.silent() != silence_announced_ ||
         std::any_of(streams.begin(), streams.end(), [now](const auto& s) {
           return s->target_due || MayAskForKeyUnit(*s, now) || !s->receipts.empty();
         });
}

MessagePtr UpstreamReporter::FeedbackMessage() {
  silence_announced_ = watch_.silent();
  GstStructure* s = gst_structure_new("scream-feedback-state-changed", "present", G_TYPE_BOOLEAN,
                                      !silence_announced_, nullptr);
  return MessagePtr(gst_message_new_element(GST_OBJECT(self_), s));
}

/// Takes what is due out of the state.
UpstreamReporter::Work UpstreamReporter::TakeWork(Time now) {
  TxState& s = state();
  Work work;
  for (auto& stream : s.streams) {
    if (stream->target_due)
      work.events.push_back({Ref(stream->pad), TargetEvent(*stream, now, nullptr), true});
    stream->target_due = false;
    for (EventPtr& receipt : stream->receipts.Take())
      work.events.push_back({Ref(stream->pad), std::move(receipt), false});
    if (MayAskForKeyUnit(*stream, now))
      work.events.push_back({Ref(stream->pad), KeyUnitEvent(*stream, now), false});
    work.warn_of_unheeded = work.warn_of_unheeded ||
                            (unheeded_ && stream->counters.frames_dropped >= kFramesUntilWarning);
  }
  if (std::exchange(warned_of_unheeded_, warned_of_unheeded_ || work.warn_of_unheeded))
    work.warn_of_unheeded = false;
  if (watch_.silent() != silence_announced_) {
    work.messages.push_back(FeedbackMessage());
    work.warn_of_silence = silence_announced_ && !std::exchange(warned_of_silence_, true);
  }
  if (ecn_state_ != ecn_announced_) work.messages.push_back(EcnMessage());
  if (stats_due_)
    work.messages.emplace_back(gst_message_new_element(GST_OBJECT(self_), StatsOf(s).release()));
  work.notify = estimate_due_;
  stats_due_ = estimate_due_ = false;
  return work;
}

void UpstreamReporter::Run() {
  TxLock lock(state().mutex);
  for (;;) {
    // A key unit that must wait for its interval is looked at with the next target.
    due_.wait_for(lock, kPulse, [&] { return HasWork(); });
    if (stop_) return;
    Work work = TakeWork(TxNow(state()));
    lock.unlock();
    Send(std::move(work));
    lock.lock();
  }
}

void UpstreamReporter::Send(Work work) {
  bool unheeded = false;
  for (PadEvent& e : work.events) {
    GST_LOG_OBJECT(e.pad.get(), "sending %" GST_PTR_FORMAT, static_cast<void*>(e.event.get()));
    const bool taken = gst_pad_push_event(e.pad.get(), e.event.release()) != FALSE;
    unheeded = unheeded || (e.is_target && !taken);
  }
  if (unheeded) {
    const TxLock lock(state().mutex);
    unheeded_ = true;
  }
  if (work.warn_of_silence) WarnOfSilence();
  if (work.warn_of_unheeded) WarnOfUnheeded();
  for (MessagePtr& m : work.messages) gst_element_post_message(GST_ELEMENT(self_), m.release());
  if (work.notify) g_object_notify(G_OBJECT(self_), "estimated-bitrate");
}

void UpstreamReporter::WarnOfSilence() {
  const std::string to = Destination(self_->src);
  GST_ELEMENT_WARNING(
      self_, RESOURCE, READ,
      ("No feedback%s%s for 2 s, as if nobody listened there.", to.empty() ? "" : " from ",
       to.c_str()),
      ("Check host and port; that screamsrc, or screamrx with its rtcp_src linked, runs there; and "
       "that no firewall is between. Without feedback only the lowest bitrate is sent. This is "
       "said "
       "once; messages scream-feedback-state-changed follow."));
}

void UpstreamReporter::WarnOfUnheeded() {
  GST_ELEMENT_WARNING(
      self_, STREAM, ENCODE,
      ("Frames are dropped, and no encoder upstream follows target-bitrate."),
      ("Put bitrateadapter behind the encoder, or give the encoder a lower bitrate; this is said "
       "once, the property stats counts the frames."));
}

}  // namespace lidar::gst
