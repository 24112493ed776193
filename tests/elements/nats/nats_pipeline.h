// SPDX-License-Identifier: LGPL-2.1-or-later
// Pipelines with a natssrc or natssink. They store the buffers that pass.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

#include "gst/common/history_query.h"
#include "tests/elements/mcap/recording.h"
#include "tests/elements/nats/nats_server.h"
#include "tests/support/patience.h"

namespace lidar::test {

inline std::size_t CountWith(const std::string& part, const std::vector<std::string>& texts) {
  return static_cast<std::size_t>(
      std::count_if(texts.begin(), texts.end(),
                    [&](const std::string& text) { return text.find(part) != text.npos; }));
}

/// A pipeline with a natssrc or natssink named `n`. Stores the buffers that arrive at the element
/// `see`.
class NatsPipeline {
 public:
  explicit NatsPipeline(const std::string& description) {
    GError* raw = nullptr;
    pipeline_.reset(gst_parse_launch(description.c_str(), &raw));
    const gst::ErrorPtr error(raw);
    EXPECT_EQ(error ? error->message : std::string(), "") << description;
    bus_.emplace(pipeline_.get());
    nats_.reset(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "n"));
    const gst::ElementPtr see(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "see"));
    const gst::PadPtr pad(gst_element_get_static_pad(see.get(), "sink"));
    gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_BUFFER, OnBuffer, this, nullptr);
  }
  ~NatsPipeline() { Stop(); }

  /// Starts the pipeline. Returns false if it cannot start.
  bool Play() {
    return gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING) != GST_STATE_CHANGE_FAILURE;
  }
  void Stop() {
    Hold(false);
    gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
  }
  /// Hold(true) blocks the next buffer at the sink pad of `see` until Hold(false) is called.
  void Hold(bool on) {
    hold_from_ = SIZE_MAX;
    held_ = on;
  }
  /// Returns true while Hold() blocks a buffer.
  bool holds() const { return holds_; }
  /// Blocks the next buffer, as Hold(true) does, once `count` buffers have passed.
  void HoldFrom(std::size_t count) { hold_from_ = count; }
  /// Sends EOS to a live source.
  void SendEos() { gst_element_send_event(pipeline_.get(), gst_event_new_eos()); }
  /// Waits for EOS or an error. Returns the text of the error, or an empty string at EOS.
  std::string WaitForEnd() {
    const gst::MessagePtr message = bus_->Wait(GST_MESSAGE_EOS | GST_MESSAGE_ERROR);
    if (!message) return "nothing happens";
    if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS) return "";
    return MessageText(message.get());
  }
  /// Returns the text of the next warning that contains `part`. Ignores other warnings, because
  /// they may occur on a busy machine.
  std::string WaitForWarning(const std::string& part) {
    while (const gst::MessagePtr message = bus_->Wait(GST_MESSAGE_WARNING)) {
      const std::string text = MessageText(message.get());
      if (text.find(part) != text.npos) return text;
    }
    return "";
  }

  /// Returns the texts of the warnings since the last call.
  std::vector<std::string> WarningTexts() { return bus_->Texts(GST_MESSAGE_WARNING); }
  /// Returns the number of warnings since the last call whose text contains `part`.
  std::size_t Warnings(const std::string& part) { return CountWith(part, WarningTexts()); }

  std::vector<Kept> buffers() const {
    const std::lock_guard lock(mutex_);
    return buffers_;
  }
  std::size_t count() const {
    const std::lock_guard lock(mutex_);
    return buffers_.size();
  }
  bool WaitForBuffers(std::size_t count_wanted) const {
    return Eventually([&] { return count() >= count_wanted; });
  }
  std::string caps() const {
    const gst::ElementPtr see(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "see"));
    const gst::PadPtr pad(gst_element_get_static_pad(see.get(), "sink"));
    const gst::CapsPtr caps(gst_pad_get_current_caps(pad.get()));
    const gst::StringPtr text(caps ? gst_caps_to_string(caps.get()) : nullptr);
    return text ? text.get() : "";
  }
  /// Returns the value of a counter or a flag in the statistics of `n`.
  guint64 stat(const char* name) const { return StatOf(nats_.get(), name); }
  GstElement* nats() const { return nats_.get(); }

 private:
  static GstPadProbeReturn OnBuffer(GstPad*, GstPadProbeInfo* info, gpointer data) {
    auto* self = static_cast<NatsPipeline*>(data);
    const Kept kept = Keep(GST_PAD_PROBE_INFO_BUFFER(info));
    std::unique_lock lock(self->mutex_);
    self->buffers_.push_back(kept);
    if (self->buffers_.size() > self->hold_from_) self->held_ = true;
    lock.unlock();
    while (self->held_) {
      self->holds_ = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    self->holds_ = false;
    return GST_PAD_PROBE_OK;
  }

  gst::ElementPtr pipeline_;
  gst::ElementPtr nats_;
  std::optional<ElementBus> bus_;
  std::atomic<bool> held_{false};
  std::atomic<bool> holds_{false};
  std::atomic<std::size_t> hold_from_{SIZE_MAX};
  mutable std::mutex mutex_;
  std::vector<Kept> buffers_;
};

inline const std::string kLive = "lidartestsrc is-live=true model=os1-32 mode=512x10 ";
inline const std::string kQuick = "lidartestsrc model=os1-32 mode=512x10 ";
inline const std::string kSee = " ! identity name=see ";
/// The maximum drain-timeout. With it, EOS waits even for a server that is frozen.
inline const std::string kPatientDrain = " drain-timeout=60000000000 ";

/// Publishes `count` coded slices and waits until the server has received them. Returns the slices.
inline std::vector<Kept> PublishSlices(int count, const std::string& where) {
  NatsPipeline sender(kQuick + "num-buffers=" + std::to_string(count) + " ! lidarenc" + kSee +
                      "! natssink name=n sync=false" + kPatientDrain + where);
  sender.Play();
  EXPECT_EQ(sender.WaitForEnd(), "");
  return sender.buffers();
}

/// Sends a history query to the source pad `src` until the server answers.
inline gst::HistoryAnswer AskForPast(GstPad* src, const gst::HistoryQuestion& question) {
  gst::HistoryAnswer answer;
  EXPECT_TRUE(Eventually([&] {
    const gst::QueryPtr query = gst::NewHistoryQuery(question);
    if (!gst_pad_query(src, query.get())) return false;
    answer = gst::ParseHistoryAnswer(query.get());
    return !answer.unanswered;
  }));
  return answer;
}

/// Plays a natssrc and waits until the server has its subscription. The natssrc receives every
/// message that is published later.
inline void Listen(const NatsServer& server, NatsPipeline* receiver) {
  gchar* raw = nullptr;
  g_object_get(receiver->nats(), "subject", &raw, nullptr);
  const gst::StringPtr subject(raw);
  const std::size_t before = server.Subscriptions(raw);
  receiver->Play();
  EXPECT_TRUE(Eventually([&] { return server.Subscriptions(raw) > before; })) << raw;
}

inline void ExpectSameStream(const std::vector<Kept>& got, const std::vector<Kept>& sent) {
  ASSERT_EQ(got.size(), sent.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_TRUE(got[i].SameAs(sent[i])) << i << ": " << ::testing::PrintToString(got[i])
                                        << "; sent " << ::testing::PrintToString(sent[i]);
    EXPECT_EQ(got[i].duration, sent[i].duration) << i;
  }
}

}  // namespace lidar::test
