// SPDX-License-Identifier: LGPL-2.1-or-later
// A pad of mcapsrc, which plays the messages of a topic.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <string>
#include <utility>

#include "ext/mcap/message_reader.h"

namespace lidar::gst {

/// The state that all pads of a source share.
struct PlaybackGroup {
  guint group_id = 0;
  GstSegment segment{};
  guint32 seqnum = GST_SEQNUM_INVALID;
};

/// A pad and its stream. Another thread may use it only while the streaming thread is paused.
class PlayedStream {
 public:
  /// `pad` is inactive. Prepare() adds it to `element` when the caps are known.
  PlayedStream(GstElement* element, GstPad* pad, std::string topic)
      : element_(element), pad_(pad), topic_(std::move(topic)) {}

  GstPad* pad() const { return pad_; }
  const std::string& topic() const { return topic_; }
  bool is_added() const { return added_; }

  /// Makes Read() read messages of `channel` from now on. Returns false if their type is unknown.
  bool Follow(const mcap::Schema& schema, const mcap::Channel& channel);
  /// Adds the pad if it is not yet added. Pushes the caps and the segment if they are new. Returns
  /// false if the caps are unknown.
  bool Prepare(const PlaybackGroup& group);
  /// Converts a message to a buffer. Returns null if the message is damaged.
  BufferPtr Read(ByteView message, GstClockTime pts);
  GstFlowReturn Push(BufferPtr buffer);
  /// Pushes a gap event up to `time` if the stream has been silent for too long.
  void FillUpTo(GstClockTime time, const PlaybackGroup& group);
  /// Begins a new segment at `position` after a seek.
  void Restart(GstClockTime position) {
    needs_segment_ = true;
    discont_ = true;
    last_ = position;
  }
  void End(const PlaybackGroup& group, GstEvent* event);

 private:
  void PushStreamStart(const PlaybackGroup& group);

  GstElement* const element_;
  GstPad* const pad_;  // a pad of `element_` after it is added
  const std::string topic_;
  std::unique_ptr<MessageReader> reader_;
  std::string schema_;       // schema of the channel that is read
  mcap::Metadata metadata_;  // metadata of the channel that is read
  CapsPtr pushed_caps_;
  bool added_ = false;
  bool needs_segment_ = true;
  bool discont_ = true;
  GstClockTime last_ = 0;  // end of the last buffer or gap
};

}  // namespace lidar::gst
