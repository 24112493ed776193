// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/notices.h"

#include <algorithm>
#include <string>

#include "gst/common/fields.h"

namespace lidar::gst {
namespace {

// A stream that has dropped fewer frames causes no warning, because an outage may be the reason.
constexpr guint64 kFramesUntilWarning = 20;
// A longer interval, added to a time, may exceed the range of the time.
constexpr Duration kLongestInterval = std::chrono::hours(24 * 365);

/// Returns the host and port of the sink behind `src`, or an empty text if they cannot be found.
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

void WarnOfSilence(GstElement* element, GstPad* src, const char* when) {
  const std::string to = Destination(src);
  GST_ELEMENT_WARNING(
      element, RESOURCE, READ,
      ("No feedback%s%s %s: no receiver seems to answer.", to.empty() ? "" : " from ", to.c_str(),
       when),
      ("Check host and port, that screamsrc (or screamrx with its rtcp_src linked) runs there, and "
       "that no firewall blocks the packets. Without feedback only the lowest bitrate is sent. "
       "This warning comes once; messages scream-feedback-state-changed follow."));
}

void WarnOfUnheeded(GstElement* element) {
  GST_ELEMENT_WARNING(element, STREAM, ENCODE,
                      ("Frames are dropped, and no encoder upstream follows target-bitrate."),
                      ("Put bitrateadapter behind the encoder, or give the encoder a lower "
                       "bitrate; this warning comes once, the property stats counts the frames."));
}

}  // namespace

void Notices::Reset(const scream::Controller& controller, Time now) {
  // The property estimated-bitrate keeps its value until the new controller has an estimate.
  Notices fresh;
  fresh.estimated_bps_ = estimated_bps_;
  fresh.estimate_due_ = estimate_due_;
  *this = fresh;
  ecn_ = ecn_posted_ = controller.ecn_state();
  next_stats_ = now;
}

bool Notices::Evaluate(const scream::Controller& controller, Duration stats_interval, Time now) {
  const DataRate total = controller.target_bitrate();
  if (notifier_.ShouldNotify(now, total)) {
    const guint bps = Kind<DataRate>::Bps(total);
    estimate_due_ = estimate_due_ || bps != estimated_bps_;
    estimated_bps_ = bps;
  }
  ecn_ = controller.ecn_state();
  const Time next = now + std::min(stats_interval, kLongestInterval);
  // The next statistics are due earlier if the interval has become shorter.
  if (stats_interval > Duration{0}) next_stats_ = std::min(next_stats_, next);
  if (stats_interval > Duration{0} && now >= next_stats_) {
    next_stats_ = next;
    stats_due_ = true;
  }
  return due();
}

bool Notices::due() const {
  return estimate_due_ || stats_due_ || ecn_ != ecn_posted_ || watch_.silent() != silence_posted_;
}

Notices::Batch Notices::Take(GstObject* element, guint64 most_dropped) {
  Batch batch;
  batch.unheeded = warn_of_unheeded_(unheeded_ && most_dropped >= kFramesUntilWarning);
  if (watch_.silent() != silence_posted_) {
    batch.messages.push_back(FeedbackMessage(element));
    batch.silence = warn_of_silence_(silence_posted_);
  }
  if (ecn_ != ecn_posted_) batch.messages.push_back(EcnMessage(element));
  batch.stats = std::exchange(stats_due_, false);
  batch.estimate = std::exchange(estimate_due_, false);
  return batch;
}

MessagePtr Notices::EcnMessage(GstObject* element) {
  GstStructure* s =
      gst_structure_new("scream-ecn-state-changed", "state", G_TYPE_STRING, scream::ToString(ecn_),
                        "previous", G_TYPE_STRING, scream::ToString(ecn_posted_), nullptr);
  ecn_posted_ = ecn_;
  return MessagePtr(gst_message_new_element(element, s));
}

MessagePtr Notices::FeedbackMessage(GstObject* element) {
  silence_posted_ = watch_.silent();
  GstStructure* s = gst_structure_new("scream-feedback-state-changed", "present", G_TYPE_BOOLEAN,
                                      !silence_posted_, nullptr);
  return MessagePtr(gst_message_new_element(element, s));
}

void Notices::Post(GstElement* element, GstPad* src, Batch batch) {
  if (batch.silence) WarnOfSilence(element, src, "for 2 s");
  if (batch.unheeded) WarnOfUnheeded(element);
  for (MessagePtr& m : batch.messages) gst_element_post_message(element, m.release());
  if (batch.estimate) g_object_notify(G_OBJECT(element), "estimated-bitrate");
}

void Notices::PostUnheard(GstElement* element, GstPad* src) {
  WarnOfSilence(element, src, "until the stream ended");
}

}  // namespace lidar::gst
