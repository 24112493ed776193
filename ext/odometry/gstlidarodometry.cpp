// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-lidarodometry
 *
 * Finds where the sensor is from its clouds, and puts its pose on each of them.
 *
 * |[
 * gst-launch-1.0 lidartestsrc speed=10 slices-per-scan=1 num-buffers=50 \
 *   ! lidarodometry trajectory=drive.tum ! fakesink
 * ]|
 */
#include <gst/base/gstbasetransform.h>

#include <memory>
#include <mutex>
#include <optional>

#include "ext/odometry/imu_input.h"
#include "ext/odometry/loop_thread.h"
#include "ext/odometry/pose_output.h"
#include "ext/odometry/scan_collector.h"
#include "ext/odometry/side_pads.h"
#include "gst/common/buffer_map.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/common/refused_caps.h"
#include "gst/common/stats.h"
#include "src/base/row_file.h"
#include "src/odometry/trajectory.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_odometry_debug);
#define GST_CAT_DEFAULT gst_lidar_odometry_debug

namespace {

using namespace lidar::gst;
using lidar::Duration;
using lidar::Time;
using lidar::odometry::Estimate;
using lidar::odometry::Odometry;
using lidar::odometry::OdometrySettings;
using lidar::odometry::Pose;
using lidar::odometry::Tracking;

struct Settings {
  OdometrySettings odometry;
  std::string initial_pose;
  std::string initial_velocity;
  std::string trajectory;
  guint local_maps = 0;
  bool post_messages = true;
};

struct Counters {
  guint64 scans = 0;
  guint64 scans_lost = 0;
  guint64 scans_degenerate = 0;
  guint64 scans_with_imu = 0;
  guint64 maps = 0;
  guint64 loops = 0;
  guint64 local_maps = 0;
  guint64 scans_not_in_local_maps = 0;
  guint64 scan_time = 0;  // of the last scan
  guint64 longest_scan_time = 0;
  guint map_voxels = 0;
  gdouble inlier_share = 0;
  gdouble position_deviation = 0;
  gdouble orientation_deviation = 0;
  Covariance covariance{};
};

const std::array<Stat<Counters>, 14> kStats = {{
    {"scans", &Counters::scans},
    {"scans-lost", &Counters::scans_lost},
    {"scans-degenerate", &Counters::scans_degenerate},
    {"scans-with-imu", &Counters::scans_with_imu},
    {"maps", &Counters::maps},
    {"loops", &Counters::loops},
    {"local-maps", &Counters::local_maps},
    {"scans-not-in-local-maps", &Counters::scans_not_in_local_maps},
    {"scan-time", &Counters::scan_time},
    {"longest-scan-time", &Counters::longest_scan_time},
    {"map-voxels", &Counters::map_voxels},
    {"inlier-share", &Counters::inlier_share},
    {"position-deviation", &Counters::position_deviation},
    {"orientation-deviation", &Counters::orientation_deviation},
}};

/// The state of a stream. It is used by the streaming thread only.
struct Stream {
  std::optional<CloudInfo> info;
  RefusedCaps refused;
  ScanCollector collector;
  GstClockTime newest_pts = GST_CLOCK_TIME_NONE;  // PTS of the newest buffer in the collector
  std::unique_ptr<Odometry> odometry;
  std::unique_ptr<LoopThread> loops;  // null if loops are not closed
  std::size_t loops_taken = 0;
  Pose map_from_odometry;
  Estimate last;
  lidar::RowFile trajectory;
  bool posted_lost = false;
  bool posted_full = false;
};

struct State {
  std::mutex mutex;  // guards settings and counters; never held while pushing or posting
  Settings settings;
  Counters counters;
  Stream stream;
  ImuInput imu;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarOdometry, gst_lidar_odometry, GST, LIDAR_ODOMETRY, GstBaseTransform)
struct _GstLidarOdometry {
  GstBaseTransform parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarOdometry, gst_lidar_odometry, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE(lidarodometry, "lidarodometry", GST_RANK_NONE,
                            gst_lidar_odometry_get_type())

static StructurePtr ReadStats(GObject* object) {
  State& state = *GST_LIDAR_ODOMETRY(object)->state;
  std::lock_guard lock(state.mutex);
  StructurePtr stats = ToStructure("application/x-lidar-odometry-stats", kStats, state.counters);
  SetCovariance(state.counters.covariance.data(), stats.get());
  return stats;
}

static const std::array<Property<Settings>, 10> kProperties = {{
    {"max-range", "Points farther away are left out; also the radius of the map [m]",
     At<&Settings::odometry, &OdometrySettings::max_range_m>, 1, 1000},
    {"min-range", "Points nearer than this are left out, because they belong to the vehicle [m]",
     At<&Settings::odometry, &OdometrySettings::min_range_m>, 0, 100},
    {"voxel-size", "Edge of the map's cubes [m]",
     At<&Settings::odometry, &OdometrySettings::voxel_size_m>, 0.05, 20},
    {"deskew", "Correct points for the motion during the scan",
     At<&Settings::odometry, &OdometrySettings::deskew>},
    {"initial-pose",
     "Pose of the first scan, for example the last pose of an earlier run: \"x y z qx qy qz qw\" "
     "[m]; NULL: the origin",
     &Settings::initial_pose},
    {"initial-velocity",
     "Velocity at the first scan, in the sensor's frame: \"vx vy vz wx wy wz\" [m/s, rad/s]; NULL: "
     "estimated from the first two scans",
     &Settings::initial_velocity},
    {"trajectory", "File to write the poses to, in TUM's format; NULL: none",
     &Settings::trajectory},
    {"local-maps",
     "Most local maps, each of 40 m of the route, in which loops are searched; 0: loops are not "
     "closed",
     &Settings::local_maps, 0, 10000},
    {"post-messages", "Post an element message \"odometry\" for each scan",
     &Settings::post_messages, 0, 0, GST_PARAM_MUTABLE_PLAYING},
    {"stats",
     "scans, scans-lost, scans-degenerate, scans-with-imu, maps, loops, local-maps, "
     "scans-not-in-local-maps, scan-time [ns], longest-scan-time [ns], map-voxels, inlier-share, "
     "position-deviation [m], orientation-deviation [rad], covariance [m^2, rad^2]",
     ReadStats},
}};

/// Returns the time at which the first column of `buffer` was sampled: the buffer's capture time,
/// or else its timestamp.
static std::optional<Time> SampledAt(GstBuffer* buffer) {
  const GstClockTime captured = gst_lidar_buffer_get_capture_time(buffer);
  const GstClockTime at = GST_CLOCK_TIME_IS_VALID(captured) ? captured : GST_BUFFER_PTS(buffer);
  if (!GST_CLOCK_TIME_IS_VALID(at)) return std::nullopt;
  // Up to this limit, sums and differences of times do not overflow.
  return Time{} + Duration{static_cast<std::int64_t>(MIN(at, GstClockTime{G_MAXINT64 / 2}))};
}

static void CountScan(State* state, const Estimate& estimate, GstClockTime time) {
  std::lock_guard lock(state->mutex);
  Counters& c = state->counters;
  ++c.scans;
  if (estimate.tracking == Tracking::kLost) ++c.scans_lost;
  if (estimate.tracking == Tracking::kDegenerate) ++c.scans_degenerate;
  if (estimate.turn_measured) ++c.scans_with_imu;
  if (estimate.map_restarted || estimate.tracking == Tracking::kStarted) ++c.maps;
  c.scan_time = time;
  c.longest_scan_time = MAX(c.longest_scan_time, time);
  c.map_voxels = static_cast<guint>(state->stream.odometry->map().voxels());
  c.inlier_share = estimate.inlier_share;
  c.position_deviation = lidar::gst::PositionDeviation(estimate);
  c.orientation_deviation = lidar::gst::OrientationDeviation(estimate);
  c.covariance = lidar::gst::CovarianceOf(estimate);
}

/// Posts a warning if tracking has failed, but only once until tracking works again.
static void WarnIfLost(GstLidarOdometry* self, const Estimate& estimate) {
  Stream& stream = self->state->stream;
  const bool lost = estimate.tracking == Tracking::kLost;
  if (lost && !stream.posted_lost) {
    GST_ELEMENT_WARNING(
        self, STREAM, FAILED,
        ("The position was lost: a scan does not fit the map. Poses are predictions until a scan "
         "fits again."),
        ("%.0f %% of the points have a neighbour in the map", 100 * estimate.inlier_share));
  }
  stream.posted_lost = lost;
}

static void Post(GstLidarOdometry* self, GstStructure* told) {
  gst_element_post_message(GST_ELEMENT(self), gst_message_new_element(GST_OBJECT(self), told));
}

static void WriteTrajectory(GstLidarOdometry* self, const Estimate& estimate) {
  Stream& stream = self->state->stream;
  if (!stream.trajectory.is_open() || stream.posted_full) return;
  lidar::odometry::WriteTumLine(stream.trajectory.stream(), {estimate.time, estimate.pose});
  if (stream.trajectory.Flush()) return;
  stream.posted_full = true;
  GST_ELEMENT_WARNING(self, RESOURCE, NO_SPACE_LEFT,
                      ("The trajectory can no longer be written; the stream goes on."), (nullptr));
}

/// Takes the results of the loop search: the correction of the drift, and counters.
static void TakeLoops(GstLidarOdometry* self) {
  State& state = *self->state;
  const LoopThread::Progress progress = state.stream.loops->progress();
  bool post = false;
  {
    const std::lock_guard lock(state.mutex);
    post = state.settings.post_messages && progress.solved > state.stream.loops_taken;
    state.counters.loops = progress.loops;
    state.counters.local_maps = progress.local_maps;
    state.counters.scans_not_in_local_maps = progress.scans_dropped;
  }
  state.stream.loops_taken = progress.solved;
  state.stream.map_from_odometry = progress.map_from_odometry;
  if (post) Post(self, LoopMessage(progress.map_from_odometry, progress.loops));
}

static void SearchLoops(GstLidarOdometry* self, const Estimate& estimate) {
  Stream& stream = self->state->stream;
  if (!stream.loops) return;
  if (estimate.tracking != Tracking::kLost)
    stream.loops->AddScan({estimate.time, estimate.pose}, stream.odometry->last_scan());
  TakeLoops(self);
}

/// Aligns the open scan, if there is one, and pushes its pose. The pose has the timestamp of the
/// scan's last buffer.
static void FinishScan(GstLidarOdometry* self) {
  State& state = *self->state;
  Stream& stream = state.stream;
  const auto scan = stream.collector.Take();
  if (!scan) return;
  const gint64 begin_us = g_get_monotonic_time();
  for (const MotionSample& s : state.imu.Take()) stream.odometry->OnTurn(s.time, s.rate, s.force);
  const Estimate estimate = stream.odometry->OnScan(scan->start, scan->duration, scan->points);
  const auto time = static_cast<GstClockTime>(g_get_monotonic_time() - begin_us) * GST_USECOND;
  stream.last = estimate;
  CountScan(&state, estimate, time);
  GST_LOG_OBJECT(self, "%s, %.3f m %.3f m %.3f m, %d iterations in %" GST_TIME_FORMAT,
                 ToString(estimate.tracking), estimate.pose.position.x(),
                 estimate.pose.position.y(), estimate.pose.position.z(), estimate.iterations,
                 GST_TIME_ARGS(time));
  WriteTrajectory(self, estimate);
  WarnIfLost(self, estimate);
  if (Snapshot(state).post_messages) Post(self, OdometryMessage(estimate));
  PushPose(GST_ELEMENT(self), estimate, stream.newest_pts);
  SearchLoops(self, estimate);
  PushMap(GST_ELEMENT(self), stream.map_from_odometry, estimate.time, stream.newest_pts);
}

/// Waits until all scans have been searched for loops. Then pushes the corrected pose of the last
/// scan.
static void FinishLoops(GstLidarOdometry* self) {
  Stream& stream = self->state->stream;
  if (!stream.loops) return;
  stream.loops->Finish();
  TakeLoops(self);
  if (stream.last.time == Time{}) return;  // there was no scan
  PushMap(GST_ELEMENT(self), stream.map_from_odometry, stream.last.time, stream.newest_pts);
}

/// Adds the buffer to the open scan. Returns false if the buffer cannot be mapped, or if its size
/// is not a multiple of the size of a point.
static bool AddBuffer(GstLidarOdometry* self, GstBuffer* buffer, const GstLidarSlice& slice,
                      Time at) {
  Stream& stream = self->state->stream;
  const BufferMap map(buffer, GST_MAP_READ);
  if (!map || map.size() % stream.info->point_step != 0) return false;
  stream.collector.Add(slice, at, map.data(), map.size());
  stream.newest_pts = GST_BUFFER_PTS(buffer);
  return true;
}

static GstFlowReturn TransformIp(GstBaseTransform* base, GstBuffer* buffer) {
  auto* self = GST_LIDAR_ODOMETRY(base);
  Stream& stream = self->state->stream;
  if (!stream.info || !stream.odometry) return GST_FLOW_NOT_NEGOTIATED;
  GstLidarSlice slice;
  if (!gst_lidar_buffer_get_slice(buffer, &slice) || slice.slice_count == 0) slice = {0, 0, 1, 0};
  const auto at = SampledAt(buffer);
  if (!at) {
    GST_ELEMENT_ERROR(self, STREAM, FORMAT,
                      ("The clouds have no timestamps, which odometry needs. Use pointcloudparse "
                       "with a framerate."),
                      (nullptr));
    return GST_FLOW_ERROR;
  }
  if (stream.collector.BeginsNewScan(slice)) FinishScan(self);
  if (!AddBuffer(self, buffer, slice, *at)) {
    GST_WARNING_OBJECT(self, "the size of a buffer does not match its caps: it gets no pose");
    return GST_FLOW_OK;
  }
  // A scan is aligned when its last slice has arrived. So earlier slices get a predicted pose.
  if (stream.collector.complete()) FinishScan(self);
  const GstLidarPose pose = ToMeta(stream.odometry->PredictAt(*at), stream.last);
  gst_lidar_buffer_set_pose(buffer, &pose);
  return GST_FLOW_OK;
}

static gboolean SetCaps(GstBaseTransform* base, GstCaps* in, GstCaps*) {
  Stream& stream = GST_LIDAR_ODOMETRY(base)->state->stream;
  FinishScan(GST_LIDAR_ODOMETRY(base));
  stream.info = CloudInfo::FromCaps(in);
  if (stream.info && stream.collector.SetInfo(*stream.info)) {
    stream.refused.Reset();
    return TRUE;
  }
  if (!stream.refused.Note(in)) return FALSE;
  GST_ELEMENT_ERROR(base, STREAM, FORMAT,
                    ("Odometry needs clouds with x, y, z as F32 side by side."),
                    ("%" GST_PTR_FORMAT, static_cast<gpointer>(in)));
  return FALSE;
}

static gboolean SinkEvent(GstBaseTransform* base, GstEvent* event) {
  auto* self = GST_LIDAR_ODOMETRY(base);
  Stream& stream = self->state->stream;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_CAPS:
      break;  // the pad odometry has its own segment and caps
    case GST_EVENT_EOS:
      FinishScan(self);
      FinishLoops(self);
      PushToPoses(GST_ELEMENT(self), event);
      break;
    case GST_EVENT_FLUSH_STOP:
      stream.collector.Take();
      PushToPoses(GST_ELEMENT(self), event);
      break;
    default:
      PushToPoses(GST_ELEMENT(self), event);
  }
  return GST_BASE_TRANSFORM_CLASS(gst_lidar_odometry_parent_class)->sink_event(base, event);
}

static gboolean Start(GstBaseTransform* base) {
  auto* self = GST_LIDAR_ODOMETRY(base);
  State& state = *self->state;
  Settings settings = Snapshot(state);
  {
    std::lock_guard lock(state.mutex);
    state.counters = {};
  }
  const auto start = settings.initial_pose.empty()
                         ? std::optional(Pose())
                         : lidar::odometry::ParsePose(settings.initial_pose);
  if (!start) {
    GST_ELEMENT_ERROR(
        self, RESOURCE, SETTINGS,
        ("initial-pose is \"%s\", but must be a position and a unit quaternion, x y z qx qy qz qw.",
         settings.initial_pose.c_str()),
        (nullptr));
    return FALSE;
  }
  settings.odometry.start = *start;
  if (!settings.initial_velocity.empty()) {
    settings.odometry.start_velocity = lidar::odometry::ParseTwist(settings.initial_velocity);
    if (!settings.odometry.start_velocity) {
      GST_ELEMENT_ERROR(
          self, RESOURCE, SETTINGS,
          ("initial-velocity is \"%s\", but must be vx vy vz in m/s and wx wy wz in rad/s.",
           settings.initial_velocity.c_str()),
          (nullptr));
      return FALSE;
    }
  }
  state.stream = {};
  state.imu.Clear();
  state.stream.odometry = std::make_unique<Odometry>(settings.odometry);
  if (settings.local_maps > 0) {
    lidar::slam::LoopSettings loops;
    loops.most_maps = settings.local_maps;
    state.stream.loops = std::make_unique<LoopThread>(loops);
  }
  if (settings.trajectory.empty()) return TRUE;
  state.stream.trajectory = lidar::RowFile(settings.trajectory);
  if (state.stream.trajectory.ok()) return TRUE;
  GST_ELEMENT_ERROR(self, RESOURCE, OPEN_WRITE,
                    ("Cannot write the trajectory \"%s\".", settings.trajectory.c_str()),
                    GST_ERROR_SYSTEM);
  return FALSE;
}

static gboolean Stop(GstBaseTransform* base) {
  GST_LIDAR_ODOMETRY(base)->state->stream = {};
  return TRUE;
}

static GstPad* RequestPad(GstElement* element, GstPadTemplate* pad_template, const gchar*,
                          const GstCaps*) {
  return AddSidePad(element, pad_template, &GST_LIDAR_ODOMETRY(element)->state->imu);
}

static void ReleasePad(GstElement* element, GstPad* pad) {
  gst_pad_set_active(pad, FALSE);
  gst_element_remove_pad(element, pad);
}

static void gst_lidar_odometry_init(GstLidarOdometry* self) {
  self->state = new State;
  gst_base_transform_set_in_place(GST_BASE_TRANSFORM(self), TRUE);
  gst_pad_use_fixed_caps(AddPad(self, "odometry"));
}

static void gst_lidar_odometry_class_init(GstLidarOdometryClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_odometry_debug, "lidarodometry", 0,
                          "Odometry from point clouds");
  ServeState<GstLidarOdometry, gst_lidar_odometry_parent_class, kProperties>(klass);
  Describe(klass,
           {"LiDAR odometry", "Filter/Analyzer/PointCloud",
            "Finds the poses of the sensor by aligning its scans to a map of what it saw"},
           {{"sink", GST_PAD_SINK, GST_LIDAR_CLOUD_MEDIA_TYPE},
            {"src", GST_PAD_SRC, GST_LIDAR_CLOUD_MEDIA_TYPE},
            {"odometry", GST_PAD_SRC, GST_LIDAR_ODOMETRY_MEDIA_TYPE},
            {"map", GST_PAD_SRC, GST_LIDAR_ODOMETRY_MEDIA_TYPE, GST_PAD_REQUEST},
            {"imu", GST_PAD_SINK, GST_LIDAR_IMU_MEDIA_TYPE, GST_PAD_REQUEST}});
  GST_ELEMENT_CLASS(klass)->request_new_pad = RequestPad;
  GST_ELEMENT_CLASS(klass)->release_pad = ReleasePad;
  auto* transform = GST_BASE_TRANSFORM_CLASS(klass);
  transform->start = Start;
  transform->stop = Stop;
  transform->set_caps = SetCaps;
  transform->sink_event = SinkEvent;
  transform->transform_ip = TransformIp;
}
