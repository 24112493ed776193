// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/gstmcapstream.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <utility>

#include "gst/common/caps_text.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/refused_caps.h"

namespace {

using namespace lidar::gst;

struct StreamSettings {
  std::string topic;
  std::string frame_id;
};

const std::array<Property<StreamSettings>, 2> kProperties = {{
    {"topic", "Where its messages go; NULL: /points, /slices, /imu or /odometry",
     &StreamSettings::topic},
    {"frame-id",
     "The sensor's frame, as messages name it; NULL: as the caps say, else lidar, or imu",
     &StreamSettings::frame_id},
}};

struct State {
  GstLidarMcapSink* sink = nullptr;
  std::atomic<bool> ended{false};
  std::mutex mutex;  // guards the settings
  StreamSettings settings;
  // Only the streaming thread uses the members below.
  std::unique_ptr<BufferWriter> writer;
  RecordedStream stream;
  std::string topic;
  RefusedCaps refused;
};

}  // namespace

struct _GstLidarMcapStream {
  GstBaseSink parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarMcapStream, gst_lidar_mcap_stream, GST_TYPE_BASE_SINK)

static State& StateOf(gpointer self) { return *GST_LIDAR_MCAP_STREAM(self)->state; }

static gboolean SetCaps(GstBaseSink* base, GstCaps* caps) {
  State& state = StateOf(base);
  const StreamSettings settings = Snapshot(state);
  std::string why;
  auto writer = BufferWriter::Make(caps, settings.frame_id, &why);
  const auto scalar = writer ? ToScalarCaps(caps, &why) : std::nullopt;
  if (!scalar) {
    if (state.refused.Note(caps))
      GST_ELEMENT_ERROR(state.sink, STREAM, WRONG_TYPE,
                        ("This stream cannot be recorded: %s.", why.c_str()),
                        ("%" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
    return FALSE;
  }
  state.refused.Reset();
  // The writer is replaced only here, after all checks. If the caps are refused, the writer of the
  // earlier caps stays: buffers with those caps may follow without another call of SetCaps().
  state.writer = std::move(writer);
  if (state.topic.empty()) {
    const std::string usual(TopicOf(state.writer->type()));
    state.topic = settings.topic.empty() ? McapSinkFreeTopic(state.sink, usual) : settings.topic;
  }
  return McapSinkAddChannel(state.sink, *state.writer, state.topic, *scalar, &state.stream);
}

static GstFlowReturn Render(GstBaseSink* base, GstBuffer* buffer) {
  State& state = StateOf(base);
  if (!state.writer) return GST_FLOW_NOT_NEGOTIATED;
  const GstClockTime running_time =
      base->segment.format == GST_FORMAT_TIME && GST_BUFFER_PTS_IS_VALID(buffer)
          ? gst_segment_to_running_time(&base->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer))
          : GST_CLOCK_TIME_NONE;
  return McapSinkTake(state.sink, state.writer.get(), &state.stream, buffer, running_time);
}

static gboolean Event(GstBaseSink* base, GstEvent* event) {
  State& state = StateOf(base);
  if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) {
    state.ended = false;
    McapSinkFlushed(state.sink);
  } else if (GST_EVENT_TYPE(event) == GST_EVENT_EOS) {
    // The stream ends before the base class posts EOS.
    state.ended = true;
    McapSinkStreamEnded(state.sink);
  }
  return GST_BASE_SINK_CLASS(gst_lidar_mcap_stream_parent_class)->event(base, event);
}

/// Resets the stream before a recording. Each recording has channels of its own, even if the
/// element only returned to READY between two recordings.
static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    State& state = StateOf(element);
    state.writer.reset();
    state.stream = {};
    state.topic.clear();
    state.refused.Reset();
    state.ended = false;
  }
  return GST_ELEMENT_CLASS(gst_lidar_mcap_stream_parent_class)->change_state(element, transition);
}

static void gst_lidar_mcap_stream_init(GstLidarMcapStream* self) { self->state = new State; }

static void gst_lidar_mcap_stream_class_init(GstLidarMcapStreamClass* klass) {
  ServeState<GstLidarMcapStream, gst_lidar_mcap_stream_parent_class, kProperties>(klass);
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
  Describe(
      klass,
      {"Stream of an MCAP recording", "Sink/File", "Gives the buffers of one stream to mcapsink"},
      {{"sink", GST_PAD_SINK, "ANY"}});
  auto* base = GST_BASE_SINK_CLASS(klass);
  base->set_caps = SetCaps;
  base->render = Render;
  base->event = Event;
}

GstElement* gst_lidar_mcap_stream_new(GstLidarMcapSink* sink, const gchar* name) {
  // The stream does not preroll (async), because a sparse stream would delay all other streams. It
  // does not wait for the clock (sync), because a disk does not need that.
  auto* stream = static_cast<GstElement*>(g_object_new(GST_TYPE_LIDAR_MCAP_STREAM, "name", name,
                                                       "async", FALSE, "sync", FALSE, nullptr));
  StateOf(stream).sink = sink;
  return stream;
}

gboolean gst_lidar_mcap_stream_ended(GstLidarMcapStream* stream) { return StateOf(stream).ended; }
