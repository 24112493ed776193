// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-lidartestsrc
 *
 * A LiDAR that drives through a synthetic world: the videotestsrc of point clouds.
 *
 * |[
 * gst-launch-1.0 lidartestsrc is-live=true model=os1-64 ! fakesink dump=false
 * ]|
 */
#include <gst/base/gstpushsrc.h>

#include <iomanip>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/imu_pad.h"
#include "gst/common/properties.h"
#include "gst/common/source_caps.h"
#include "gst/testsrc/live_pacer.h"
#include "gst/testsrc/slice_maker.h"
#include "src/base/row_file.h"
#include "src/synth/geometry.h"
#include "src/synth/imu.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_test_src_debug);
#define GST_CAT_DEFAULT gst_lidar_test_src_debug

namespace {

using namespace lidar::gst;
using lidar::Duration;

const GEnumValue kModels[] = {{0, "OS0, 32 beams over 90 degrees", "os0-32"},
                              {1, "OS0, 64 beams over 90 degrees", "os0-64"},
                              {2, "OS0, 128 beams over 90 degrees", "os0-128"},
                              {3, "OS1, 32 beams over 42 degrees", "os1-32"},
                              {4, "OS1, 64 beams over 42 degrees", "os1-64"},
                              {5, "OS1, 128 beams over 42 degrees", "os1-128"},
                              {6, "OS2, 32 beams over 21 degrees", "os2-32"},
                              {7, "OS2, 64 beams over 21 degrees", "os2-64"},
                              {8, "OS2, 128 beams over 21 degrees", "os2-128"},
                              {9, "Velodyne VLP-16, as its driver publishes it", "vlp-16"},
                              {10, "Hesai XT32, as its driver publishes it", "xt32"},
                              {11, "Hesai AT128, as its driver publishes it", "at128"},
                              {12, "Livox Mid-360, as its driver publishes it", "mid-360"},
                              {0, nullptr, nullptr}};
const GEnumValue kModes[] = {
    {0, "512 columns, 10 scans/s", "512x10"},   {1, "512 columns, 20 scans/s", "512x20"},
    {2, "1024 columns, 10 scans/s", "1024x10"}, {3, "1024 columns, 20 scans/s", "1024x20"},
    {4, "2048 columns, 10 scans/s", "2048x10"}, {0, nullptr, nullptr}};
struct Mode {
  std::uint32_t columns;
  int scans_per_second;
};
constexpr std::array<Mode, 5> kModeValues = {
    {{512, 10}, {512, 20}, {1024, 10}, {1024, 20}, {2048, 10}}};
const GEnumValue kScenes[] = {{0, "A street in a town, with traffic", "street"},
                              {1, "A road tunnel", "tunnel"},
                              {2, "Open country", "field"},
                              {3, "A town on hills, and a round trip of 2 km through it", "town"},
                              {0, nullptr, nullptr}};

GType ModelType() {
  static const GType type = RegisterEnum("GstLidarTestSrcModel", kModels);
  return type;
}
GType ModeType() {
  static const GType type = RegisterEnum("GstLidarTestSrcMode", kModes);
  return type;
}
GType SceneType() {
  static const GType type = RegisterEnum("GstLidarTestSrcScene", kScenes);
  return type;
}

struct Settings {
  gint model = 4;
  gint mode = 2;
  gint scene = 0;
  gdouble speed_mps = 12;
  gdouble roughness = 1;
  gdouble noise_m = 0.01;
  bool mixed_pixels = false;
  guint seed = 0;
  guint slices_per_scan = 0;
  std::string channels;
  std::string trajectory_location;
  bool imu = false;
  bool is_live = false;
};

using Row = Property<Settings>;
const std::array<Row, 13> kProperties = {{
    {"model", "Sensor to simulate", EnumField<Settings>{&Settings::model, ModelType}},
    {"mode", "Columns of a scan x scans per second, of an Ouster",
     EnumField<Settings>{&Settings::mode, ModeType}},
    {"scene", "World to drive through", EnumField<Settings>{&Settings::scene, SceneType}},
    {"speed", "Speed of the sensor [m/s]", &Settings::speed_mps, 0, 100},
    {"roughness", "Amplitude of the car's sway, heave and tilt, relative to the scene's usual road",
     &Settings::roughness, 0, 20},
    {"noise", "Standard deviation of ranges on a bright target nearby [m]", &Settings::noise_m, 0,
     10},
    {"mixed-pixels", "Simulate mixed pixels: ranges at edges lie between the two surfaces",
     &Settings::mixed_pixels},
    {"seed", "Seed of the world and the noise: the same seed gives the same clouds",
     &Settings::seed, 0, G_MAXUINT},
    {"slices-per-scan",
     "Buffers a scan is cut into, rounded down to a divisor of the columns (1 = whole scans, 0 = "
     "automatic: a sweep of about 12.5 ms of an Ouster, whole scans of others)",
     &Settings::slices_per_scan, 0, 4096},
    {"channels",
     "Extra fields of a point of an Ouster, comma-separated: reflectivity, signal, ring, t (ns "
     "since "
     "the slice's first column)",
     &Settings::channels},
    {"trajectory-location",
     "File for the exact trajectory: one pose a buffer in TUM format, at its capture time",
     &Settings::trajectory_location},
    {"imu", "Add the pad imu, with the samples of an inertial measurement unit", &Settings::imu},
    {"is-live", "Scan at the pace of the clock; false: as fast as possible", &Settings::is_live},
}};

// The capture time at which a source that is not live starts: 2024-01-01T00:00:00Z. It is fixed, so
// that the output is repeatable.
constexpr GstClockTime kEpoch = G_GUINT64_CONSTANT(1'704'067'200) * GST_SECOND;

/// Writes poses to a text file in the format of the TUM RGB-D benchmark, which evo and other tools
/// read.
class TrajectoryLog {
 public:
  /// Creates the file, or empties an existing file. Check ok() afterwards.
  explicit TrajectoryLog(const std::string& path) : file_(path) {
    file_.stream() << std::fixed << "# timestamp tx ty tz qx qy qz qw\n" << std::flush;
  }
  bool ok() const { return file_.ok(); }
  /// Writes a row. Returns false if that fails.
  bool Write(GstClockTime unix_time, const lidar::synth::Pose& pose) {
    const auto [x, y, z, w] = pose.ToQuaternion();
    // The time is written as integers, because a double cannot represent a Unix time in
    // nanoseconds.
    file_.stream() << unix_time / GST_SECOND << '.' << std::setfill('0') << std::setw(9)
                   << unix_time % GST_SECOND << std::setprecision(6) << ' ' << pose.x << ' '
                   << pose.y << ' ' << pose.z << std::setprecision(9) << ' ' << x << ' ' << y << ' '
                   << z << ' ' << w << '\n';
    return file_.Flush();
  }

 private:
  lidar::RowFile file_;
};

struct State {
  explicit State(GstBaseSrc* source) : pacer(source) {}

  std::mutex mutex;  // guards `settings` and `latency`
  Settings settings;
  GstClockTime latency = GST_CLOCK_TIME_NONE;  // longest duration of a slice, while started
  // The members below are used by the streaming thread only, between start and stop.
  std::optional<SliceMaker> maker;
  std::optional<lidar::synth::Imu> imu;
  std::optional<ImuPad> imu_pad;
  std::unique_ptr<TrajectoryLog> log;
  LivePacer pacer;
};

lidar::synth::ScannerConfig ConfigFrom(const Settings& s) {
  lidar::synth::ScannerConfig config;
  const char* model = kModels[s.model].value_nick;
  int scans_per_second = lidar::synth::Firing::kScansPerSecond;
  if (const auto* firing = lidar::synth::FindFiring(model)) {
    config.sensor = lidar::synth::MakeSensor(*firing);
  } else {
    const Mode mode = kModeValues[static_cast<std::size_t>(s.mode)];
    config.sensor = *lidar::synth::MakeSensor(model, mode.columns);
    scans_per_second = mode.scans_per_second;
  }
  config.period = Duration(std::chrono::seconds(1)) / scans_per_second;
  config.scene = static_cast<lidar::synth::SceneKind>(s.scene);
  config.speed_mps = s.speed_mps;
  config.roughness = s.roughness;
  config.noise_m = s.noise_m;
  config.mixed_pixels = s.mixed_pixels;
  config.seed = s.seed;
  return config;
}

/// Ignores unknown channels here, because Start() refuses them.
SliceOptions OptionsFrom(const Settings& s) {
  std::string unknown;
  SliceOptions options;
  options.slices_per_scan = s.slices_per_scan;
  options.channels = ParseChannels(s.channels, &unknown).value_or(options.channels);
  return options;
}

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarTestSrc, gst_lidar_test_src, GST, LIDAR_TEST_SRC, GstPushSrc)
struct _GstLidarTestSrc {
  GstPushSrc parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarTestSrc, gst_lidar_test_src, GST_TYPE_PUSH_SRC)
GST_ELEMENT_REGISTER_DEFINE(lidartestsrc, "lidartestsrc", GST_RANK_NONE,
                            gst_lidar_test_src_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_TEST_SRC(self)->state; }

static gboolean Start(GstBaseSrc* base) {
  State& state = StateOf(base);
  const Settings settings = Snapshot(state);
  std::string unknown;
  if (!ParseChannels(settings.channels, &unknown)) {
    GST_ELEMENT_ERROR(
        base, RESOURCE, SETTINGS,
        ("There is no channel \"%s\"; the channels are reflectivity, signal, ring and t.",
         unknown.c_str()),
        (nullptr));
    return FALSE;
  }
  const char* model = kModels[settings.model].value_nick;
  if (!settings.channels.empty() && lidar::synth::FindFiring(model) != nullptr) {
    GST_ELEMENT_ERROR(
        base, RESOURCE, SETTINGS,
        ("The model %s has the fields that its driver publishes: do not set channels.", model),
        (nullptr));
    return FALSE;
  }
  std::unique_ptr<TrajectoryLog> log;
  if (!settings.trajectory_location.empty()) {
    log = std::make_unique<TrajectoryLog>(settings.trajectory_location);
    if (!log->ok()) {
      GST_ELEMENT_ERROR(
          base, RESOURCE, OPEN_WRITE,
          ("Cannot write the trajectory to \"%s\".", settings.trajectory_location.c_str()),
          GST_ERROR_SYSTEM);
      return FALSE;
    }
  }
  std::lock_guard lock(state.mutex);
  state.log = std::move(log);
  state.maker.emplace(ConfigFrom(settings), OptionsFrom(settings));
  if (settings.imu) {
    state.imu.emplace(state.maker->trajectory(), lidar::synth::kMemsImu, settings.seed);
    state.imu_pad.emplace(base);
  }
  state.latency = static_cast<GstClockTime>(state.maker->LongestSlice().count());
  return TRUE;
}

static gboolean Stop(GstBaseSrc* base) {
  State& state = StateOf(base);
  std::lock_guard lock(state.mutex);
  state.latency = GST_CLOCK_TIME_NONE;
  state.maker.reset();
  state.imu.reset();
  state.imu_pad.reset();
  state.log.reset();
  state.pacer.Stop();
  return TRUE;
}

static GstCaps* GetCaps(GstBaseSrc* base, GstCaps* filter) {
  State& state = StateOf(base);
  const Settings settings = Snapshot(state);
  GstCaps* caps = SliceMaker::InfoFor(ConfigFrom(settings), OptionsFrom(settings)).ToCaps();
  if (filter != nullptr) {
    GstCaps* both = gst_caps_intersect_full(filter, caps, GST_CAPS_INTERSECT_FIRST);
    gst_caps_unref(caps);
    caps = both;
  }
  return caps;
}

/// Negotiates the caps. If each buffer has different caps, Create() sets them instead.
static gboolean Negotiate(GstBaseSrc* base) {
  const auto& maker = StateOf(base).maker;
  if (maker && maker->OwnInfo() != nullptr) return TRUE;
  return GST_BASE_SRC_CLASS(gst_lidar_test_src_parent_class)->negotiate(base);
}

static gboolean Query(GstBaseSrc* base, GstQuery* query) {
  State& state = StateOf(base);
  if (GST_QUERY_TYPE(query) == GST_QUERY_LATENCY && gst_base_src_is_live(base)) {
    std::lock_guard lock(state.mutex);
    if (!GST_CLOCK_TIME_IS_VALID(state.latency)) return FALSE;
    gst_query_set_latency(query, TRUE, state.latency, GST_CLOCK_TIME_NONE);
    return TRUE;
  }
  return GST_BASE_SRC_CLASS(gst_lidar_test_src_parent_class)->query(base, query);
}

/// Skips slices if the source is late by more than a scan, because a sensor does not wait for its
/// reader.
static bool SkipWhatIsLate(GstElement* element, State* state) {
  const Duration due = state->maker->NextEnd() + state->maker->period();
  const auto now = state->pacer.Now();
  if (!now || *now < due) return false;
  GST_WARNING_OBJECT(element, "more than a scan late: skipping %" GST_TIME_FORMAT,
                     GST_TIME_ARGS((*now - due).count()));
  state->maker->SkipTo(*now);
  return true;
}

/// These functions convert a stream time to a running time and to a time since 1970.
static GstClockTime RunningTime(GstLidarTestSrc* self, Duration t) {
  const bool live = gst_base_src_is_live(GST_BASE_SRC(self));
  return live ? self->state->pacer.ToRunningTime(t) : static_cast<GstClockTime>(t.count());
}
static GstClockTime UnixTime(GstLidarTestSrc* self, Duration t) {
  const bool live = gst_base_src_is_live(GST_BASE_SRC(self));
  return live ? self->state->pacer.ToUnixTime(t) : kEpoch + static_cast<GstClockTime>(t.count());
}

/// Writes the pose at the time `at` to the trajectory. If that fails, posts a warning and closes
/// the file. The rows that have been written are kept.
static void LogPose(GstLidarTestSrc* self, Duration at) {
  State& state = *self->state;
  if (!state.log) return;
  if (state.log->Write(UnixTime(self, at), state.maker->trajectory().At(at))) return;
  state.log.reset();
  GST_ELEMENT_WARNING(self, RESOURCE, NO_SPACE_LEFT,
                      ("The trajectory can no longer be written; the stream goes on."),
                      GST_ERROR_SYSTEM);
}

/// Pushes the IMU samples between `begin` and `end`.
static void PushImu(GstLidarTestSrc* self, Duration begin, Duration end) {
  State& state = *self->state;
  if (!state.imu) return;
  state.imu->SkipTo(begin);
  auto samples = state.imu->Until(end);
  if (samples.empty()) return;
  const Duration first = samples.front().time - lidar::Time{};
  for (lidar::ImuSample& sample : samples) {
    const GstClockTime captured = UnixTime(self, sample.time - lidar::Time{});
    sample.time = lidar::Time{} + Duration{static_cast<std::int64_t>(captured)};
  }
  constexpr ImuToSensor kSensorsFrame = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  state.imu_pad->Push(samples, kSensorsFrame, RunningTime(self, first));
}

/// Creates a slice. Casts the rays before the slice is due, so that a live slice is pushed as soon
/// as its last column has been sampled.
static GstFlowReturn CreateSlice(GstLidarTestSrc* self, GstBuffer** out) {
  State& state = *self->state;
  const bool live = gst_base_src_is_live(GST_BASE_SRC(self));
  if (live && !state.pacer.started()) state.pacer.Start();
  const bool skipped = live && SkipWhatIsLate(GST_ELEMENT(self), &state);
  const Duration begin = state.maker->NextTime();
  const Duration end = state.maker->NextEnd();
  BufferPtr buffer = state.maker->Make(UnixTime(self, begin));
  const GstFlowReturn flow = live ? state.pacer.WaitUntil(end) : GST_FLOW_OK;
  if (flow != GST_FLOW_OK) return flow;
  GST_BUFFER_PTS(buffer.get()) = RunningTime(self, begin);
  gst_lidar_buffer_set_capture_time(buffer.get(), UnixTime(self, begin));
  if (skipped) GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT);
  LogPose(self, begin);
  PushImu(self, begin, end);
  *out = buffer.release();
  return GST_FLOW_OK;
}

/// Creates a buffer. If the width of the buffers varies, sets the caps of each buffer.
static GstFlowReturn Create(GstPushSrc* push, GstBuffer** out) {
  auto* self = GST_LIDAR_TEST_SRC(push);
  const CloudInfo* info = self->state->maker->OwnInfo();
  for (;;) {
    const GstFlowReturn flow = CreateSlice(self, out);
    if (flow != GST_FLOW_OK || info == nullptr) return flow;
    if (info->width > 0) break;
    gst_clear_buffer(out);  // drivers do not publish empty clouds
  }
  const CapsPtr caps(info->ToCaps());
  const GstFlowReturn flow = SetSourceCaps(GST_BASE_SRC(push), caps.get());
  // The base class ignores the buffer if the result is an error.
  if (flow != GST_FLOW_OK) gst_clear_buffer(out);
  return flow;
}

static gboolean Unlock(GstBaseSrc* base) {
  StateOf(base).pacer.SetFlushing(true);
  return TRUE;
}

static gboolean UnlockStop(GstBaseSrc* base) {
  StateOf(base).pacer.SetFlushing(false);
  return TRUE;
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  if (transition == GST_STATE_CHANGE_PAUSED_TO_PLAYING) StateOf(element).pacer.MeasureUnixOffset();
  return GST_ELEMENT_CLASS(gst_lidar_test_src_parent_class)->change_state(element, transition);
}

static void ApplyLive(GObject* object, GParamSpec*) {
  State& state = StateOf(object);
  std::unique_lock lock(state.mutex);
  const bool live = state.settings.is_live;
  lock.unlock();
  gst_base_src_set_live(GST_BASE_SRC(object), live);
}

static void gst_lidar_test_src_init(GstLidarTestSrc* self) {
  self->state = new State(GST_BASE_SRC(self));
  gst_base_src_set_format(GST_BASE_SRC(self), GST_FORMAT_TIME);
}

static void gst_lidar_test_src_class_init(GstLidarTestSrcClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_test_src_debug, "lidartestsrc", 0, "Synthetic LiDAR");
  ServeState<GstLidarTestSrc, gst_lidar_test_src_parent_class, kProperties, ApplyLive>(klass);
  Describe(klass,
           {"LiDAR test source", "Source/PointCloud",
            "A synthetic LiDAR that drives through a synthetic world"},
           {{"src", GST_PAD_SRC, GST_LIDAR_CLOUD_MEDIA_TYPE},
            {"imu", GST_PAD_SRC, GST_LIDAR_IMU_MEDIA_TYPE, GST_PAD_SOMETIMES}});
  auto* base = GST_BASE_SRC_CLASS(klass);
  base->start = Start;
  base->stop = Stop;
  base->get_caps = GetCaps;
  base->negotiate = Negotiate;
  base->query = Query;
  base->unlock = Unlock;
  base->unlock_stop = UnlockStop;
  GST_PUSH_SRC_CLASS(klass)->create = Create;
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
}
