// SPDX-License-Identifier: LGPL-2.1-or-later
// An encoder and its decoder, and the messages that they post on the bus.
#pragma once
#include <deque>
#include <string>

#include "tests/elements/coders/coder_harness.h"
#include "tests/support/element_bus.h"

namespace lidar::gst {

/// A codec, and the messages that it posts on its bus.
class CheckedCodec {
 public:
  explicit CheckedCodec(const CoderCase& coder, const std::string& properties = "")
      : harness_(Codec(coder, properties)) {}

  void SetCaps(const CloudInfo& info) { gst::SetCaps(harness_.get(), info); }
  GstHarness* harness() const { return harness_.get(); }
  /// Pushes `buffer` and returns the decoded cloud.
  BufferPtr Push(GstBuffer* buffer) {
    EXPECT_EQ(gst_harness_push(harness_.get(), buffer), GST_FLOW_OK);
    return BufferPtr(gst_harness_try_pull(harness_.get()));
  }
  /// Removes the oldest error check from the queue and returns it, or returns null if the queue is
  /// empty.
  StructurePtr PopCheck() {
    Drain();
    if (checks_.empty()) return nullptr;
    StructurePtr check = std::move(checks_.front());
    checks_.pop_front();
    return check;
  }
  /// Returns the number of warnings that were posted so far.
  unsigned Warnings() {
    Drain();
    return warnings_;
  }
  unsigned Errors() {
    Drain();
    return errors_;
  }
  StructurePtr Stats() const {
    const ElementPtr enc(gst_bin_get_by_name(GST_BIN(harness_->element), "enc"));
    return StatsOf(enc.get());
  }

 private:
  void Drain() {
    while (const MessagePtr message = bus_.Pop()) {
      const GstStructure* s = gst_message_get_structure(message.get());
      if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_WARNING) ++warnings_;
      if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ERROR) ++errors_;
      if (s != nullptr && gst_structure_has_name(s, "lidar-error-check"))
        checks_.emplace_back(gst_structure_copy(s));
    }
  }

  Harness harness_;
  const test::ElementBus bus_{harness_->element};
  std::deque<StructurePtr> checks_;
  unsigned warnings_ = 0;
  unsigned errors_ = 0;
};

/// Returns the field `holds` of the message lidar-error-check: true if the bound held.
inline bool Holds(const GstStructure* s) {
  gboolean holds = FALSE;
  EXPECT_TRUE(gst_structure_get_boolean(s, "holds", &holds));
  return holds != FALSE;
}

}  // namespace lidar::gst
