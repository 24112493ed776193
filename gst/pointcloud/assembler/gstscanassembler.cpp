// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-scanassembler
 *
 * Puts the slices of a scan together again. Missing slices are zeros, and the scan is flagged.
 *
 * |[
 * gst-launch-1.0 lidartestsrc num-buffers=80 ! scanassembler ! fakesink silent=false -v
 * ]|
 */
#include <gst/gst.h>

#include <mutex>
#include <utility>

#include "gst/common/element_class.h"
#include "gst/common/latency.h"
#include "gst/common/properties.h"
#include "gst/pointcloud/assembler/assembler_state.h"
#include "gst/pointcloud/assembler/scan_caps.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_scan_assembler_debug);
#define GST_CAT_DEFAULT gst_lidar_scan_assembler_debug

namespace {

using namespace lidar::gst;
using Settings = AssemblerSettings;
using State = AssemblerState;

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarScanAssembler, gst_lidar_scan_assembler, GST, LIDAR_SCAN_ASSEMBLER,
                     GstElement)
struct _GstLidarScanAssembler {
  GstElement parent;
  GstPad* sinkpad;
  GstPad* srcpad;
  State* state;
};

G_DEFINE_TYPE(GstLidarScanAssembler, gst_lidar_scan_assembler, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(scanassembler, "scanassembler", GST_RANK_NONE,
                            gst_lidar_scan_assembler_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_SCAN_ASSEMBLER(self)->state; }

static StructurePtr Stats(GObject* object) { return StateOf(object).Stats(); }

static const std::array<Property<Settings>, 2> kProperties = {{
    {"max-wait",
     "Longest time that a scan of a live pipeline waits for late slices [ns]; added to the latency",
     &Settings::max_wait, 0, static_cast<gdouble>(10 * GST_SECOND), GST_PARAM_MUTABLE_PLAYING},
    {"stats", "Counters: scans, incomplete, late-slices, duplicate-slices, invalid-slices", Stats},
}};

/// Pushes the caps of a scan, which are the caps of its slices with the width of the scan.
static void PushCaps(GstLidarScanAssembler* self, guint width) {
  State& state = *self->state;
  CapsPtr caps;
  EventPtr segment;
  {
    std::lock_guard lock(state.mutex);
    if (state.out_width == width || !state.in_caps) return;
    state.out_width = width;
    state.caps_sent = true;
    segment = std::move(state.early_segment);
    caps = ScanCaps(state.in_caps.get(), *state.info, width);
  }
  gst_pad_push_event(self->srcpad, gst_event_new_caps(caps.get()));
  if (segment) gst_pad_push_event(self->srcpad, segment.release());
}

/// Pushes the segment that was held back for the first scan, because at EOS no scan can follow.
/// Caps must precede the segment, so this pushes caps that describe a full turn.
static void PushEarlySegment(GstLidarScanAssembler* self) {
  State& state = *self->state;
  guint width = 0;
  {
    std::lock_guard lock(state.mutex);
    if (!state.early_segment || !state.info) return;
    const auto& model = state.info->sensor_model;
    width = model ? model->columns_per_scan : state.info->width;
  }
  PushCaps(self, width);
}

/// Pushes the finished scans. The caller holds the stream lock, but not the mutex.
static GstFlowReturn PushScans(GstLidarScanAssembler* self, ScanQueue::Finished* finished) {
  GstFlowReturn flow = GST_FLOW_OK;
  for (auto& scan : *finished) {
    if (flow != GST_FLOW_OK) break;
    if (!scan.complete) GST_DEBUG_OBJECT(self, "scan leaves incomplete");
    PushCaps(self, scan.width);
    flow = gst_pad_push(self->srcpad, scan.buffer.release());
  }
  finished->clear();
  return flow;
}

static GstFlowReturn PushAll(GstLidarScanAssembler* self) {
  ScanQueue::Finished finished;
  {
    std::lock_guard lock(self->state->mutex);
    self->state->queue.FinishAll(&finished);
  }
  return PushScans(self, &finished);
}

/// Computes the latency that scans of `slices` slices need. Posts a latency message if it has
/// changed.
static void UpdateLatency(GstLidarScanAssembler* self, const CloudInfo& info, guint slices) {
  State& state = *self->state;
  const GstClockTime scan = info.ScanDuration();
  const GstClockTime latency = slices > 1 && GST_CLOCK_TIME_IS_VALID(scan) ? scan : 0;
  {
    std::lock_guard lock(state.mutex);
    if (state.scan_latency == latency) return;
    state.scan_latency = latency;
  }
  PostNewLatency(self);
}

static void LearnUpstreamLatency(GstLidarScanAssembler* self) {
  const QueryPtr query(gst_query_new_latency());
  const bool answered = gst_pad_peer_query(self->sinkpad, query.get());
  std::lock_guard lock(self->state->mutex);
  self->state->upstream = answered ? ReadLatency(query.get()) : Latency();
}

/// Pushes a buffer that is a whole scan already.
static GstFlowReturn PassThrough(GstLidarScanAssembler* self, GstBuffer* buffer, guint width) {
  GstFlowReturn flow = PushAll(self);
  if (flow != GST_FLOW_OK) {
    gst_buffer_unref(buffer);
    return flow;
  }
  PushCaps(self, width);
  return gst_pad_push(self->srcpad, buffer);
}

/// Warns if a buffer without meta has fewer columns than a scan of the sensor. The buffer may be a
/// slice that lost its meta.
static void ReportMissingMeta(GstLidarScanAssembler* self, const CloudInfo& info) {
  State& state = *self->state;
  if (!info.sensor_model || info.width >= info.sensor_model->columns_per_scan) return;
  if (std::exchange(state.missing_meta_reported, true)) return;
  GST_ELEMENT_WARNING(self, STREAM, FORMAT,
                      ("Clouds with %u of the sensor's %u columns arrive without LidarSliceMeta: "
                       "each of them is treated as a whole scan.",
                       info.width, info.sensor_model->columns_per_scan),
                      ("gdppay, shmsink and other elements of GStreamer 1.22 drop metas: record "
                       "and send RTP (rtplidarpay), which carries them."));
}

static GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_SCAN_ASSEMBLER(parent);
  State& state = *self->state;
  std::optional<CloudInfo> info;
  {
    std::lock_guard lock(state.mutex);
    info = state.info;
  }
  if (!info) {
    gst_buffer_unref(buffer);
    GST_ELEMENT_ERROR(self, CORE, NEGOTIATION,
                      ("A buffer arrived before the caps of a point cloud."), (nullptr));
    return GST_FLOW_NOT_NEGOTIATED;
  }
  SliceView slice{buffer, &*info, {}};
  if (!gst_lidar_buffer_get_slice(buffer, &slice.meta)) ReportMissingMeta(self, *info);
  UpdateLatency(self, *info, slice.meta.slice_count);
  if (slice.meta.slice_count == 1) return PassThrough(self, buffer, info->width);
  const BufferPtr owner(buffer);
  if (slice.meta.slice_index == 0 || !state.upstream) LearnUpstreamLatency(self);
  ScanQueue::Finished finished;
  {
    std::lock_guard lock(state.mutex);
    const guint64 invalid = state.queue.counters().invalid;
    const GstClockTime deadline =
        state.upstream->live
            ? DeadlineOf(slice, {&state.segment, state.upstream->min, state.settings.max_wait})
            : GST_CLOCK_TIME_NONE;
    state.queue.Add(slice, deadline, &finished);
    if (state.queue.counters().invalid != invalid)
      GST_WARNING_OBJECT(self, "dropping slice %u of %u of scan %u, which does not fit a scan",
                         slice.meta.slice_index, slice.meta.slice_count, slice.meta.scan_id);
    // The timer may be waiting for the deadline of an earlier scan, and timestamps may have
    // restarted.
    state.timer.Update(state.queue.NextDeadline());
  }
  return PushScans(self, &finished);
}

static void FinishDue(GstLidarScanAssembler* self, ScanQueue::Finished* finished) {
  State& state = *self->state;
  std::lock_guard lock(state.mutex);
  GstClock* clock = gst_element_get_clock(GST_ELEMENT(self));
  if (clock == nullptr) return;
  const GstClockTime base = gst_element_get_base_time(GST_ELEMENT(self));
  if (!state.timer.flushing()) state.queue.FinishDue(gst_clock_get_time(clock) - base, finished);
  gst_object_unref(clock);
}

/// The task of the source pad. It pushes scans whose deadline has passed.
static void TimerLoop(gpointer data) {
  auto* self = GST_LIDAR_SCAN_ASSEMBLER(data);
  State& state = *self->state;
  std::unique_lock lock(state.mutex);
  const bool passed =
      state.timer.Wait(&lock, GST_ELEMENT(self), [&] { return state.queue.NextDeadline(); });
  lock.unlock();
  if (passed) {
    GST_PAD_STREAM_LOCK(self->sinkpad);
    ScanQueue::Finished finished;
    FinishDue(self, &finished);
    // The result is ignored, because this task has no caller. The chain function returns errors of
    // downstream.
    PushScans(self, &finished);
    GST_PAD_STREAM_UNLOCK(self->sinkpad);
  }
  lock.lock();
  if (state.timer.flushing()) gst_pad_pause_task(self->srcpad);
}

static void SetFlushing(GstLidarScanAssembler* self, bool flushing) {
  State& state = *self->state;
  std::lock_guard lock(state.mutex);
  state.timer.SetFlushing(flushing);
}

static void TakeCaps(GstLidarScanAssembler* self, GstCaps* caps, CloudInfo&& info) {
  State& state = *self->state;
  std::lock_guard lock(state.mutex);
  // If clouds are not organised, their slices differ in width. The width of a slice does not change
  // the caps of the scan.
  if (!state.in_caps || !SameButForWidth(caps, state.in_caps.get())) state.out_width = 0;
  state.in_caps.reset(gst_caps_ref(caps));
  state.info = std::move(info);
}

static gboolean HandleCaps(GstLidarScanAssembler* self, GstEvent* event) {
  const EventPtr owner(event);
  GstCaps* caps = nullptr;
  gst_event_parse_caps(event, &caps);
  State& state = *self->state;
  std::string why;
  auto info = CloudInfo::FromFrameCaps(caps, &why);
  if (!info) {
    if (state.refused.Note(caps))
      GST_ELEMENT_ERROR(self, STREAM, FORMAT,
                        ("The caps do not describe a cloud: %s.", why.c_str()),
                        ("%" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
    return FALSE;
  }
  state.refused.Reset();
  bool scan_changes = false;
  {
    std::lock_guard lock(state.mutex);
    scan_changes = state.info && CannotMix(*state.info, *info);
  }
  // The slices of unfinished scans have the old caps, so these scans are pushed before the caps
  // change.
  if (scan_changes) PushAll(self);
  TakeCaps(self, caps, *std::move(info));
  return TRUE;
}

/// Keeps the segment until caps have been sent. Returns true if it took ownership of the event.
static bool HoldSegment(GstLidarScanAssembler* self, GstEvent* event) {
  State& state = *self->state;
  const GstSegment* segment = nullptr;
  gst_event_parse_segment(event, &segment);
  // Unfinished scans belong to the segment in which they began, so they are pushed before it
  // changes.
  if (!gst_segment_is_equal(segment, &state.segment)) PushAll(self);
  std::lock_guard lock(state.mutex);
  gst_segment_copy_into(segment, &state.segment);
  if (!state.caps_sent) state.early_segment.reset(event);
  return !state.caps_sent;
}

static void ForgetAll(GstLidarScanAssembler* self) {
  State& state = *self->state;
  {
    std::lock_guard lock(state.mutex);
    state.queue.Clear();
    state.early_segment.reset();
    gst_segment_init(&state.segment, GST_FORMAT_TIME);
  }
  SetFlushing(self, false);
}

static gboolean SinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_SCAN_ASSEMBLER(parent);
  State& state = *self->state;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_CAPS:
      return HandleCaps(self, event);
    case GST_EVENT_SEGMENT:
      if (HoldSegment(self, event)) return TRUE;
      break;
    case GST_EVENT_EOS:
      PushAll(self);
      PushEarlySegment(self);
      break;
    case GST_EVENT_GAP: {
      // A gap within a scan needs no event, because the incomplete scan is flagged. A GAP event
      // before the first scan is dropped, because neither caps nor a segment have been sent yet.
      std::unique_lock lock(state.mutex);
      if (state.queue.empty() && state.caps_sent) break;
      lock.unlock();
      gst_event_unref(event);
      return TRUE;
    }
    case GST_EVENT_FLUSH_START: {
      const gboolean result = gst_pad_event_default(pad, parent, event);
      SetFlushing(self, true);
      gst_pad_pause_task(self->srcpad);
      return result;
    }
    case GST_EVENT_FLUSH_STOP: {
      ForgetAll(self);
      const gboolean result = gst_pad_event_default(pad, parent, event);
      gst_pad_start_task(self->srcpad, TimerLoop, self, nullptr);
      return result;
    }
    default:
      break;
  }
  return gst_pad_event_default(pad, parent, event);
}

static gboolean SrcQuery(GstPad* pad, GstObject* parent, GstQuery* query) {
  if (!gst_pad_query_default(pad, parent, query)) return FALSE;
  if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY) return TRUE;
  State& state = StateOf(parent);
  std::lock_guard lock(state.mutex);
  if (ReadLatency(query).live && state.scan_latency > 0)
    AddLatency(query, state.scan_latency + state.settings.max_wait);
  return TRUE;
}

static gboolean ActivateSource(GstPad* pad, GstObject* parent, GstPadMode, gboolean active) {
  auto* self = GST_LIDAR_SCAN_ASSEMBLER(parent);
  SetFlushing(self, active == FALSE);
  return active ? gst_pad_start_task(pad, TimerLoop, self, nullptr) : gst_pad_stop_task(pad);
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  State& state = StateOf(element);
  const auto result =
      GST_ELEMENT_CLASS(gst_lidar_scan_assembler_parent_class)->change_state(element, transition);
  std::lock_guard lock(state.mutex);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_PLAYING)
    state.timer.Update(state.queue.NextDeadline());
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    state.Reset();
  }
  return result;
}

static void PostLatency(GObject* object, GParamSpec*) { PostNewLatency(object); }

static void gst_lidar_scan_assembler_init(GstLidarScanAssembler* self) {
  self->state = new State;
  self->sinkpad = AddPad(self, "sink");
  gst_pad_set_chain_function(self->sinkpad, Chain);
  gst_pad_set_event_function(self->sinkpad, SinkEvent);
  self->srcpad = AddPad(self, "src");
  gst_pad_set_query_function(self->srcpad, SrcQuery);
  gst_pad_set_activatemode_function(self->srcpad, ActivateSource);
}

static void gst_lidar_scan_assembler_class_init(GstLidarScanAssemblerClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_scan_assembler_debug, "scanassembler", 0, "Scan assembler");
  ServeState<GstLidarScanAssembler, gst_lidar_scan_assembler_parent_class, kProperties,
             PostLatency>(klass);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  Describe(
      klass,
      {"Scan assembler", "Filter/PointCloud", "Puts the slices of a LiDAR scan together again"},
      {{"sink", GST_PAD_SINK, GST_LIDAR_CLOUD_MEDIA_TYPE},
       {"src", GST_PAD_SRC, GST_LIDAR_CLOUD_MEDIA_TYPE}});
}
