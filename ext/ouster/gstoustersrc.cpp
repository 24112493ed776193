// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-ouster_src
 *
 * Gives clouds of an Ouster sensor, or of a capture of one. A scan comes as slices, each as soon as
 * its columns have arrived.
 *
 * |[
 * gst-launch-1.0 ouster_src location=drive.pcap metadata=drive.json ! fakesink silent=false -v
 * gst-launch-1.0 ouster_src hostname=os1.local udp-dest=@auto ! fakesink silent=false -v
 * ]|
 */
#include <gst/base/gstpushsrc.h>

#include <memory>
#include <mutex>
#include <utility>

#include "ext/ouster/session.h"
#include "ext/ouster/settings.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/lidar/gstlidar.h"

GST_DEBUG_CATEGORY(gst_lidar_ouster_src_debug);
#define GST_CAT_DEFAULT gst_lidar_ouster_src_debug

namespace {

using namespace lidar::gst;

// The reported latency until the sensor is known: the usual duration of a slice at 10 or 20
// scans/s.
constexpr GstClockTime kUsualSlice = 12'500 * GST_USECOND;

struct State {
  std::mutex mutex;  // guards all members below; not held while the session works
  OusterSettings settings;
  std::shared_ptr<Session> session;  // exists between start and stop
  Counters last;                     // counters of the session that ended last
  guint32 last_seek = GST_SEQNUM_INVALID;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarOusterSrc, gst_lidar_ouster_src, GST, LIDAR_OUSTER_SRC, GstPushSrc)
struct _GstLidarOusterSrc {
  GstPushSrc parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarOusterSrc, gst_lidar_ouster_src, GST_TYPE_PUSH_SRC)
GST_ELEMENT_REGISTER_DEFINE(ouster_src, "ouster_src", GST_RANK_NONE,
                            gst_lidar_ouster_src_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_OUSTER_SRC(self)->state; }

static std::shared_ptr<Session> SessionOf(gpointer self) {
  State& state = StateOf(self);
  std::lock_guard lock(state.mutex);
  return state.session;
}

static gboolean Start(GstBaseSrc* base) {
  State& state = StateOf(base);
  const OusterSettings settings = Snapshot(state);
  const std::shared_ptr<Session> session = Session::Create(base, settings);
  if (!session->Open()) return FALSE;
  const std::lock_guard lock(state.mutex);
  state.session = session;
  return TRUE;
}

static gboolean Stop(GstBaseSrc* base) {
  State& state = StateOf(base);
  const std::shared_ptr<Session> session = SessionOf(base);
  if (!session) return TRUE;
  std::lock_guard lock(state.mutex);
  state.last = session->counters();
  state.last_seek = GST_SEQNUM_INVALID;
  state.session.reset();
  return TRUE;
}

static GstFlowReturn Create(GstPushSrc* push, GstBuffer** out) {
  return SessionOf(push)->Next(out);
}

static gboolean Unlock(GstBaseSrc* base) {
  if (const auto session = SessionOf(base)) session->Unlock();
  return TRUE;
}

static gboolean UnlockStop(GstBaseSrc* base) {
  if (const auto session = SessionOf(base)) session->UnlockStop();
  return TRUE;
}

/// Returns the duration of the capture, or -1 if the source is not seekable.
static gint64 DurationOf(GstBaseSrc* base) {
  const auto session = SessionOf(base);
  const auto duration = session ? session->duration() : std::nullopt;
  return duration ? static_cast<gint64>(*duration) : -1;
}

static gboolean IsSeekable(GstBaseSrc* base) {
  const auto session = SessionOf(base);
  return session && session->seekable();
}

static gboolean Query(GstBaseSrc* base, GstQuery* query) {
  GstFormat format = GST_FORMAT_TIME;
  if (GST_QUERY_TYPE(query) == GST_QUERY_LATENCY && gst_base_src_is_live(base)) {
    const auto session = SessionOf(base);
    const GstClockTime slice = session ? session->slice_duration() : GST_CLOCK_TIME_NONE;
    gst_query_set_latency(query, TRUE, GST_CLOCK_TIME_IS_VALID(slice) ? slice : kUsualSlice,
                          GST_CLOCK_TIME_NONE);
    return TRUE;
  }
  if (GST_QUERY_TYPE(query) == GST_QUERY_DURATION) {
    gst_query_parse_duration(query, &format, nullptr);
    if (format == GST_FORMAT_TIME) {
      const gint64 duration = DurationOf(base);
      if (duration >= 0) gst_query_set_duration(query, format, duration);
      return duration >= 0;
    }
  }
  if (GST_QUERY_TYPE(query) == GST_QUERY_SEEKING) {
    gst_query_parse_seeking(query, &format, nullptr, nullptr, nullptr);
    const bool seekable = format == GST_FORMAT_TIME && IsSeekable(base);
    gst_query_set_seeking(query, format, seekable, 0, seekable ? DurationOf(base) : -1);
    return TRUE;
  }
  return GST_BASE_SRC_CLASS(gst_lidar_ouster_src_parent_class)->query(base, query);
}

static gboolean DoSeek(GstBaseSrc* base, GstSegment* segment) {
  if (const auto session = SessionOf(base)) {
    session->Seek(*segment);
    session->imu().StopFlush();
  }
  return TRUE;
}

/// Seeks on both pads, because the base class flushes only the pad src.
static gboolean SeekAll(GstBaseSrc* base, GstEvent* event, Session* session) {
  gdouble rate = 1;
  GstFormat format = GST_FORMAT_UNDEFINED;
  GstSeekFlags flags = GST_SEEK_FLAG_NONE;
  GstSeekType start = GST_SEEK_TYPE_NONE;
  GstSeekType stop = GST_SEEK_TYPE_NONE;
  gst_event_parse_seek(event, &rate, &format, &flags, &start, nullptr, &stop, nullptr);
  if (rate <= 0 || format != GST_FORMAT_TIME) return FALSE;
  const guint32 seqnum = gst_event_get_seqnum(event);
  {
    State& state = StateOf(base);
    const std::lock_guard lock(state.mutex);
    // Each sink of the pipeline sends the seek, but it is performed only once.
    if (std::exchange(state.last_seek, seqnum) == seqnum) return TRUE;
  }
  if (start == GST_SEEK_TYPE_END || stop == GST_SEEK_TYPE_END) {
    const gint64 duration = DurationOf(base);
    GST_OBJECT_LOCK(base);
    base->segment.duration = static_cast<guint64>(duration);
    GST_OBJECT_UNLOCK(base);
  }
  if ((flags & GST_SEEK_FLAG_FLUSH) != 0) session->imu().StartFlush(seqnum);
  const gboolean done = GST_BASE_SRC_CLASS(gst_lidar_ouster_src_parent_class)->event(base, event);
  session->imu().StopFlush();  // ends the flush if the seek failed
  return done;
}

static gboolean Event(GstBaseSrc* base, GstEvent* event) {
  const auto session = SessionOf(base);
  if (GST_EVENT_TYPE(event) == GST_EVENT_SEEK && session && session->seekable())
    return SeekAll(base, event, session.get());
  return GST_BASE_SRC_CLASS(gst_lidar_ouster_src_parent_class)->event(base, event);
}

/// Sends a seek of the application to the pad. Otherwise the base class would perform the seek
/// without calling Event().
static gboolean SendEvent(GstElement* element, GstEvent* event) {
  const auto session = SessionOf(element);
  if (GST_EVENT_TYPE(event) == GST_EVENT_SEEK && session && session->seekable())
    return gst_pad_send_event(GST_BASE_SRC_PAD(element), event);
  return GST_ELEMENT_CLASS(gst_lidar_ouster_src_parent_class)->send_event(element, event);
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    State& state = StateOf(element);
    std::unique_lock lock(state.mutex);
    const bool live = state.settings.live();
    lock.unlock();
    gst_base_src_set_live(GST_BASE_SRC(element), live);
  }
  if (transition == GST_STATE_CHANGE_PAUSED_TO_PLAYING)
    if (const auto session = SessionOf(element)) session->Resume();
  return GST_ELEMENT_CLASS(gst_lidar_ouster_src_parent_class)->change_state(element, transition);
}

StructurePtr lidar::gst::OusterStats(GObject* source) {
  State& state = StateOf(source);
  std::unique_lock lock(state.mutex);
  const auto session = state.session;
  const Counters counters = session ? session->counters() : state.last;
  lock.unlock();
  return ToStructure("application/x-ouster-src-stats", kOusterStats, counters);
}

static void gst_lidar_ouster_src_init(GstLidarOusterSrc* self) {
  self->state = new State;
  gst_base_src_set_format(GST_BASE_SRC(self), GST_FORMAT_TIME);
}

static void InstallVmethods(GstLidarOusterSrcClass* klass) {
  auto* src = GST_BASE_SRC_CLASS(klass);
  src->start = Start;
  src->stop = Stop;
  src->unlock = Unlock;
  src->unlock_stop = UnlockStop;
  src->query = Query;
  src->event = Event;
  src->is_seekable = IsSeekable;
  src->do_seek = DoSeek;
  // The caps are set when the first slice is sent, because they depend on the sensor.
  src->negotiate = [](GstBaseSrc*) -> gboolean { return TRUE; };
  GST_PUSH_SRC_CLASS(klass)->create = Create;
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
  GST_ELEMENT_CLASS(klass)->send_event = SendEvent;
}

static void gst_lidar_ouster_src_class_init(GstLidarOusterSrcClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_ouster_src_debug, "ouster_src", 0, "Ouster sensors");
  ServeState<GstLidarOusterSrc, gst_lidar_ouster_src_parent_class, kOusterProperties>(klass);
  Describe(klass,
           {"Ouster LiDAR source", "Source/Network",
            "Receives an Ouster sensor, or reads a capture of one"},
           {{"src", GST_PAD_SRC, GST_LIDAR_CLOUD_MEDIA_TYPE},
            {"imu", GST_PAD_SRC, GST_LIDAR_IMU_MEDIA_TYPE, GST_PAD_SOMETIMES}});
  InstallVmethods(klass);
}
