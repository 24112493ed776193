// SPDX-License-Identifier: LGPL-2.1-or-later
// A pad of mcapsrc: the messages of a topic.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <string>
#include <utility>

#include "ext/mcap/message_reader.h"

namespace lidar::gst {

/// The common state of a source's pads.
struct PlaybackGroup {
  guint group_id = 0;
  GstSegment segment{};
  guint32 seqnum = GST_SEQNUM_INVALID;
};

/// Used by the streaming thread, or while that thread is paused.
class PlayedStream {
 public:
  /// `pad` is inactive; Prepare() adds it to `element` once its caps are known.
  PlayedStream(GstElement* element, GstPad* pad, std::string topic)
      : element_(element), pad_(pad), topic_(std::move(topic)) {}

  GstPad* pad() const { return pad_; }
  const std::string& topic() const { return topic_; }
  bool is_added() const { return added_; }

  /// Reads messages of that channel from now on. Returns false if their type is unknown.
  bool Follow(const mcap::Schema& schema, const mcap::Channel& channel);
  /// Pushes caps and segment if they are due, and adds the pad. Returns false if caps are not
  /// known.
  bool Prepare(const PlaybackGroup& group);
  /// Null if the message is damaged.
  BufferPtr Read(ByteView message, GstClockTime pts);
  GstFlowReturn Push(BufferPtr buffer);
  /// Pushes a gap up to `time` if the stream is far behind it.
  void FillUpTo(GstClockTime time, const PlaybackGroup& group);
  /// Begins a new segment at `position`, after a seek.
  void Restart(GstClockTime position) {
    needs_segment_ = true;
    discont_ = true;
    last_ = position;
  }
  void End(const PlaybackGroup& group, GstEvent* event);

 private:
  void PushStreamStart(const PlaybackGroup& group);

  GstElement* const element_;
  GstPad* const pad_;  // of the element, once it is added
  const std::string topic_;
  std::unique_ptr<MessageReader> reader_;
  std::string schema_;       // of the channel that is read
  mcap::Metadata metadata_;  // of the same channel
  CapsPtr pushed_caps_;
  bool added_ = false;
  bool needs_segment_ = true;
  bool discont_ = true;
  GstClockTime last_ = 0;  // end of what was pushed
};

}  // namespace lidar::gst
