// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/upstream_reporter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gst/scream/tx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_tx_debug

namespace lidar::gst {
namespace {

using namespace std::chrono_literals;

constexpr Duration kPulse = 200ms;  // interval of target-bitrate events
// If the payload's share changes by more than this fraction, the encoder's bounds are converted
// anew.
constexpr double kShareThreshold = 0.02;

bool ShareHasChanged(const TxStream& stream) {
  const double share = stream.overhead.payload_share();
  return stream.bounds && std::abs(share / stream.configured_share - 1) > kShareThreshold;
}

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
  GST_ELEMENT_ERROR(self_, RESOURCE, FAILED, ("Cannot start a thread: %s.", error->message),
                    ("screamtx needs one to send the encoders their bitrate"));
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

void UpstreamReporter::Evaluate(Time now) {
  TxState& s = state();
  bool due = notices_.Evaluate(*s.controller, s.settings.stats_interval, now);
  for (auto& stream : s.streams) {
    if (ShareHasChanged(*stream)) Configure(s, *stream);
    due = EvaluateTargets(*stream, *s.controller, s.settings.key_unit_on_loss, now) || due;
  }
  if (due) due_.notify_one();
}

Time UpstreamReporter::NextLook(Time now) const {
  const bool stats = state().settings.stats_interval > 0ns;
  return stats ? std::min(now + kPulse, notices_.next_stats()) : now + kPulse;
}

bool UpstreamReporter::HasWork() const {
  const auto& streams = state().streams;
  const Time now = TxNow(state());
  return stop_ || notices_.due() ||
         std::any_of(streams.begin(), streams.end(),
                     [now](const auto& stream) { return TargetsAreDue(*stream, now); });
}

/// Removes the events and messages that are due from the state, and returns them.
UpstreamReporter::Work UpstreamReporter::TakeWork(Time now) {
  TxState& s = state();
  Work work;
  guint64 most_dropped = 0;
  for (auto& stream : s.streams) {
    TakeTargets(*stream, *s.controller, now, &work.events);
    most_dropped = std::max(most_dropped, stream->counters.frames_dropped);
  }
  work.notices = notices_.Take(GST_OBJECT(self_), most_dropped);
  if (work.notices.stats)
    work.notices.messages.emplace_back(
        gst_message_new_element(GST_OBJECT(self_), StatsOf(s).release()));
  return work;
}

void UpstreamReporter::Run() {
  TxLock lock(state().mutex);
  for (;;) {
    // The wait ends after kPulse at the latest. A request for a key unit that was too early is then
    // checked again.
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
    notices_.OnUnheeded();
  }
  Notices::Post(GST_ELEMENT(self_), self_->src, std::move(work.notices));
}

}  // namespace lidar::gst
