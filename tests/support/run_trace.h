// SPDX-License-Identifier: LGPL-2.1-or-later
// Records the buffers, events and messages of an element as lines of text, so that two runs can be
// compared.
#pragma once
#include <algorithm>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/crc.h"
#include "tests/support/element_bus.h"
#include "tests/support/element_stats.h"
#include "tests/support/golden_lines.h"
#include "tests/support/harness.h"

namespace lidar::test {

inline bool HasLine(const Lines& lines, const std::string& part) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const auto& line) { return line.find(part) != std::string::npos; });
}

class RunTrace {
 public:
  /// Records the element of `h`, which must outlive this object. If `with_bytes` is true, a
  /// buffer's line has a checksum of its bytes. If an element chooses the number of its stream at
  /// random, the checksum differs between runs.
  explicit RunTrace(GstHarness* h, bool with_bytes = true)
      : h_(h), with_bytes_(with_bytes), bus_(h->element) {
    if (h->sinkpad != nullptr) Watch(h->sinkpad);
  }
  ~RunTrace() {
    if (added_ != 0) g_signal_handler_disconnect(h_->element, added_);
    for (const auto& [pad, probe] : probes_) gst_pad_remove_probe(pad.get(), probe);
  }
  RunTrace(const RunTrace&) = delete;
  RunTrace& operator=(const RunTrace&) = delete;

  /// Records the buffers and events that pass `pad`, in addition to the pads that are already
  /// watched. Any thread may call this function.
  void Watch(GstPad* pad) {
    // A probe for buffer lists is not needed: the watched pads accept no lists, so GStreamer passes
    // the buffers of a list one by one.
    constexpr auto kAll = static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER |
                                                       GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM);
    const std::lock_guard lock(mutex_);
    probes_.emplace_back(GST_PAD(gst_object_ref(pad)),
                         gst_pad_add_probe(pad, kAll, OnData, this, nullptr));
  }
  /// Links each source pad that the element adds from now on, and records what passes it. The lines
  /// have the name of the pad.
  void TakeAddedPads() {
    added_ = g_signal_connect(h_->element, "pad-added", G_CALLBACK(OnAdded), this);
  }
  /// Returns the number of lines since the last Take() that begin with `begin`.
  std::size_t Count(const std::string& begin) {
    while (const gst::MessagePtr message = bus_.Pop()) AddMessage(message.get(), &messages_);
    const auto begins_so = [&](const auto& line) { return line.rfind(begin, 0) == 0; };
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::count_if(lines_.begin(), lines_.end(), begins_so) +
                                    std::count_if(messages_.begin(), messages_.end(), begins_so));
  }
  /// Records the events that the element sends upstream to `pad`, which belongs to the harness.
  void WatchUpstream(GstPad* pad) {
    const std::lock_guard lock(mutex_);
    probes_.emplace_back(
        GST_PAD(gst_object_ref(pad)),
        gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_EVENT_UPSTREAM, OnUpstream, this, nullptr));
  }
  /// Starts the element, and pushes the events that precede the first buffer: stream-start, caps
  /// and segment.
  void Begin(const std::string& caps) {
    gst_harness_play(h_);
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("run"));
    PushCaps(caps);
    PushSegment();
  }
  void PushCaps(const std::string& text) {
    const gst::CapsPtr caps(gst_caps_from_string(text.c_str()));
    gst_pad_push_event(h_->srcpad, gst_event_new_caps(caps.get()));
  }
  void PushSegment() { gst_pad_push_event(h_->srcpad, NewSegment()); }
  void Flush() {
    gst_pad_push_event(h_->srcpad, gst_event_new_flush_start());
    gst_pad_push_event(h_->srcpad, gst_event_new_flush_stop(TRUE));
    PushSegment();
  }
  void Stop() { gst_element_set_state(h_->element, GST_STATE_NULL); }

  /// Returns the lines since the last call: first buffers and events, then messages, and last the
  /// statistics.
  Lines Take() {
    Lines taken;
    {
      const std::lock_guard lock(mutex_);
      taken.swap(lines_);
      first_capture_ = GST_CLOCK_TIME_NONE;
    }
    taken.insert(taken.end(), messages_.begin(), messages_.end());
    messages_.clear();
    while (const gst::MessagePtr message = bus_.Pop()) AddMessage(message.get(), &taken);
    while (GstBuffer* buffer = gst_harness_try_pull(h_)) gst_buffer_unref(buffer);
    if (g_object_class_find_property(G_OBJECT_GET_CLASS(h_->element), "stats") == nullptr)
      return taken;
    const gst::StringPtr text(gst_structure_to_string(StatsOf(h_->element).get()));
    taken.push_back(std::string("stats ") + text.get());
    return taken;
  }
  Lines TakeBuffers() {
    Lines taken = Take();
    taken.erase(std::remove_if(taken.begin(), taken.end(),
                               [](const auto& line) { return line.rfind("buffer", 0) != 0; }),
                taken.end());
    return taken;
  }

 private:
  static std::string Text(GstClockTime time) {
    return GST_CLOCK_TIME_IS_VALID(time) ? std::to_string(time) : "none";
  }
  static void OnAdded(GstElement*, GstPad* pad, gpointer data) {
    auto* self = static_cast<RunTrace*>(data);
    if (!GST_PAD_IS_SRC(pad)) return;
    const gst::StringPtr name(gst_pad_get_name(pad));
    static GstStaticPadTemplate any =
        GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS_ANY);
    GstPad* sink = gst_pad_new_from_static_template(&any, name.get());
    gst_object_ref_sink(sink);
    gst_pad_set_chain_function(sink, [](GstPad*, GstObject*, GstBuffer* buffer) -> GstFlowReturn {
      gst_buffer_unref(buffer);
      return GST_FLOW_OK;
    });
    self->Watch(sink);
    gst_pad_set_active(sink, TRUE);
    gst_pad_link(pad, sink);
    gst_object_unref(sink);
  }
  /// Returns " on NAME" for an added pad with this name, and an empty text for the sink pad of the
  /// harness.
  std::string PlaceOf(GstPad* pad) const {
    const gst::PadPtr peer(pad == h_->sinkpad ? nullptr : gst_pad_get_peer(pad));
    return peer ? std::string(" on ") + GST_PAD_NAME(peer.get()) : "";
  }
  static GstPadProbeReturn OnData(GstPad* pad, GstPadProbeInfo* info, gpointer data) {
    auto* self = static_cast<RunTrace*>(data);
    const std::lock_guard lock(self->mutex_);
    if (info->type & GST_PAD_PROBE_TYPE_BUFFER)
      self->Add(GST_PAD_PROBE_INFO_BUFFER(info), self->PlaceOf(pad));
    if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM)
      self->lines_.push_back(TextOf(GST_PAD_PROBE_INFO_EVENT(info)) + self->PlaceOf(pad));
    return GST_PAD_PROBE_OK;
  }
  static GstPadProbeReturn OnUpstream(GstPad*, GstPadProbeInfo* info, gpointer data) {
    auto* self = static_cast<RunTrace*>(data);
    const std::lock_guard lock(self->mutex_);
    self->lines_.push_back("upstream " + TextOf(GST_PAD_PROBE_INFO_EVENT(info)));
    return GST_PAD_PROBE_OK;
  }
  void Add(GstBuffer* buffer, const std::string& place) {
    constexpr guint kFlags = GST_BUFFER_FLAG_DISCONT | GST_BUFFER_FLAG_CORRUPTED |
                             GST_BUFFER_FLAG_MARKER | GST_BUFFER_FLAG_GAP |
                             GST_BUFFER_FLAG_DELTA_UNIT | GST_BUFFER_FLAG_DROPPABLE;
    std::string line = "buffer at " + Text(GST_BUFFER_PTS(buffer)) + " for " +
                       Text(GST_BUFFER_DURATION(buffer)) + " offset " +
                       std::to_string(GST_BUFFER_OFFSET(buffer)) + " flags " +
                       std::to_string(GST_BUFFER_FLAGS(buffer) & kFlags) + " size " +
                       std::to_string(gst_buffer_get_size(buffer));
    if (GST_BUFFER_DTS_IS_VALID(buffer)) line += " decoded at " + Text(GST_BUFFER_DTS(buffer));
    const gst::BufferMap map(buffer, GST_MAP_READ);
    if (with_bytes_ && map) line += " crc " + std::to_string(Crc32(map.view()));
    GstLidarSlice s{};
    if (gst_lidar_buffer_get_slice(buffer, &s))
      line += " slice " + std::to_string(s.scan_id) + " " + std::to_string(s.slice_index) + " of " +
              std::to_string(s.slice_count) + " from " + std::to_string(s.first_column);
    GstLidarPose pose{};
    if (gst_lidar_buffer_get_pose(buffer, &pose))
      line += " pose " + std::to_string(pose.position[0]);
    const GstClockTime capture = gst_lidar_buffer_get_capture_time(buffer);
    // Some elements use the current time of day as the capture time of the first buffer. Such a
    // time is written relative to the first one.
    constexpr GstClockTime kYear2020 = 1'577'836'800 * GST_SECOND;
    const bool is_today = GST_CLOCK_TIME_IS_VALID(capture) && capture > kYear2020;
    if (is_today && !GST_CLOCK_TIME_IS_VALID(first_capture_)) first_capture_ = capture;
    if (is_today)
      line += " captured " + std::to_string(GST_CLOCK_DIFF(first_capture_, capture));
    else if (GST_CLOCK_TIME_IS_VALID(capture))
      line += " captured at " + std::to_string(capture);
    lines_.push_back(line + place);
  }
  static std::string TextOf(GstEvent* event) {
    std::string line = std::string("event ") + GST_EVENT_TYPE_NAME(event);
    GstCaps* caps = nullptr;
    const GstSegment* s = nullptr;
    GstClockTime at = 0;
    GstClockTime lasts = 0;
    switch (GST_EVENT_TYPE(event)) {
      case GST_EVENT_CAPS: {
        gst_event_parse_caps(event, &caps);
        const gst::StringPtr text(gst_caps_to_string(caps));
        return line + " " + text.get();
      }
      case GST_EVENT_SEGMENT:
        gst_event_parse_segment(event, &s);
        return line + " " + gst_format_get_name(s->format) + " from " + Text(s->start) + " base " +
               Text(s->base) + " time " + Text(s->time) + " to " + Text(s->stop);
      case GST_EVENT_GAP:
        gst_event_parse_gap(event, &at, &lasts);
        return line + " at " + Text(at) + " for " + Text(lasts);
      case GST_EVENT_CUSTOM_UPSTREAM:
      case GST_EVENT_CUSTOM_DOWNSTREAM:
      case GST_EVENT_CUSTOM_DOWNSTREAM_STICKY: {
        const gst::StringPtr text(gst_structure_to_string(gst_event_get_structure(event)));
        return line + " " + text.get();
      }
      default:
        return line;
    }
  }
  static void AddMessage(GstMessage* message, Lines* lines) {
    GError* raw = nullptr;
    switch (GST_MESSAGE_TYPE(message)) {
      case GST_MESSAGE_ERROR:
        gst_message_parse_error(message, &raw, nullptr);
        break;
      case GST_MESSAGE_WARNING:
        gst_message_parse_warning(message, &raw, nullptr);
        break;
      case GST_MESSAGE_LATENCY:
        break;
      case GST_MESSAGE_ELEMENT: {
        const gst::StringPtr text(gst_structure_to_string(gst_message_get_structure(message)));
        lines->push_back(std::string("message ") + text.get());
        return;
      }
      default:
        // Messages of other types are those of GStreamer itself.
        return;
    }
    const gst::ErrorPtr error(raw);
    lines->push_back(std::string("message ") + GST_MESSAGE_TYPE_NAME(message) + " " +
                     (raw != nullptr ? raw->message : ""));
  }

  GstHarness* const h_;
  const bool with_bytes_;
  const ElementBus bus_;
  gulong added_ = 0;
  Lines messages_;    // the messages that Count() has read since the last Take()
  std::mutex mutex_;  // guards the members below
  std::vector<std::pair<gst::PadPtr, gulong>> probes_;
  Lines lines_;
  GstClockTime first_capture_ = GST_CLOCK_TIME_NONE;
};

}  // namespace lidar::test
