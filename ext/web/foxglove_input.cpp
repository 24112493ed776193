// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/foxglove_input.h"

#include <mutex>
#include <optional>

#include "ext/web/poses.h"
#include "ext/web/slice_stream.h"
#include "gst/common/buffer_map.h"
#include "gst/common/coordinate_frames.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/refused_caps.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "src/foxglove/messages.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_foxglove_input_debug);
#define GST_CAT_DEFAULT gst_lidar_foxglove_input_debug

namespace {

using namespace lidar::gst;
using lidar::foxglove::Header;
using lidar::foxglove::Pose;
using lidar::foxglove::Schema;
using lidar::web::Hub;
using lidar::web::InputSettings;
using lidar::web::SharedTopic;

constexpr const char* kTransforms = "/tf";
constexpr const char* kPoses = "/pose";
constexpr const char* kCamera = "/camera";
/// The number of frames that may wait, which is a quarter of a second for most cameras.
constexpr std::size_t kVideoDepth = 8;
/// The largest number of slices in a scan of our streams. Each slice has a transform.
constexpr guint kMaxDepth = 64;

enum class Kind { kNone, kCloud, kDraco, kOdometry, kSlices, kH264, kVp8 };

struct State {
  std::mutex mutex;  // guards the settings and `hub`
  InputSettings settings;
  std::shared_ptr<Hub> hub;
  // Only the streaming thread uses the members below.
  std::shared_ptr<Hub> used;  // the hub, from start to stop
  Kind kind = Kind::kNone;
  CloudInfo info;
  RefusedCaps refused;
  std::unique_ptr<lidar::web::SliceStream> slices;  // only for kSlices, which has no other topic
  SharedTopic data;
  SharedTopic transforms;
  SharedTopic poses;
  std::string parent_frame;  // only for kOdometry
  std::string child_frame;
  bool no_poses = false;  // another stream uses their topics
};

}  // namespace

struct _GstLidarFoxgloveInput {
  GstBaseSink parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarFoxgloveInput, gst_lidar_foxglove_input, GST_TYPE_BASE_SINK)

namespace lidar::web {

void SetHub(GstLidarFoxgloveInput* input, std::shared_ptr<Hub> hub) {
  const std::lock_guard lock(input->state->mutex);
  input->state->hub = std::move(hub);
}

InputSettings SettingsOf(GstLidarFoxgloveInput* input) {
  const std::lock_guard lock(input->state->mutex);
  return input->state->settings;
}

void SetSettings(GstLidarFoxgloveInput* input, const InputSettings& settings) {
  const std::lock_guard lock(input->state->mutex);
  input->state->settings = settings;
}

}  // namespace lidar::web

namespace {

State& StateOf(gpointer self) { return *GST_LIDAR_FOXGLOVE_INPUT(self)->state; }

void CloseTopics(State* state) {
  state->slices.reset();
  for (SharedTopic* topic : {&state->data, &state->transforms, &state->poses}) {
    if (*topic && state->used) state->used->server->Close(*topic);
    topic->reset();
  }
  state->no_poses = false;
}

std::string TopicName(const InputSettings& settings, const char* usual) {
  if (!settings.topic.empty()) return settings.topic;
  return settings.number == 0 ? usual : usual + ("_" + std::to_string(settings.number));
}

/// Opens the topic `name`. If another pad publishes other data on it, posts an error message and
/// returns false.
bool OpenTopic(GstBaseSink* sink, const std::string& name, Schema schema, SharedTopic* topic) {
  State& state = StateOf(sink);
  *topic = state.used->server->Open(name, schema);
  if (*topic) return true;
  GST_ELEMENT_ERROR(sink, RESOURCE, SETTINGS,
                    ("Cannot show this stream: %s.", lidar::web::TopicInUse(name).c_str()),
                    (nullptr));
  return false;
}

bool OpenPoses(GstBaseSink* sink, const std::string& name) {
  State& state = StateOf(sink);
  if (!OpenTopic(sink, name, Schema::kPose, &state.poses) ||
      !OpenTopic(sink, kTransforms, Schema::kFrameTransform, &state.transforms))
    return false;
  state.transforms->set_depth(kMaxDepth);
  return true;
}

/// Returns the kind of stream that has these caps. Returns kNone and sets `why` if no kind fits.
Kind KindOf(GstCaps* caps, std::optional<CloudInfo>* info, std::string* why) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  if (gst_structure_has_name(s, GST_LIDAR_DRACO_MEDIA_TYPE)) return Kind::kDraco;
  if (gst_structure_has_name(s, GST_LIDAR_ODOMETRY_MEDIA_TYPE)) return Kind::kOdometry;
  if (gst_structure_has_name(s, GST_LIDAR_SLICE_MEDIA_TYPE)) return Kind::kSlices;
  if (gst_structure_has_name(s, "video/x-h264")) return Kind::kH264;
  if (gst_structure_has_name(s, "video/x-vp8")) return Kind::kVp8;
  *info = CloudInfo::FromFrameCaps(caps, why);
  if (!*info) return Kind::kNone;
  if ((*info)->fields.HasPackedXyz()) return Kind::kCloud;
  *why = "x, y and z are not F32 side by side";
  return Kind::kNone;
}

bool IsVideo(Kind kind) { return kind == Kind::kH264 || kind == Kind::kVp8; }

/// Returns the duration of a scan from the framerate of the caps. Returns 0 if they have no
/// framerate. The caps may be those of coded slices.
guint64 ScanDurationOf(GstCaps* caps) {
  gint n = 0;
  gint d = 1;
  if (!gst_structure_get_fraction(gst_caps_get_structure(caps, 0), "framerate", &n, &d) || n <= 0)
    return 0;
  return gst_util_uint64_scale_int(GST_SECOND, d, n);
}

bool OpenVideo(GstBaseSink* sink, const std::string& name) {
  State& state = StateOf(sink);
  if (!OpenTopic(sink, name, Schema::kCompressedVideo, &state.data)) return false;
  state.data->set_depth(kVideoDepth);
  return true;
}

/// Returns a function that sends a query upstream and waits for the answer.
lidar::web::UpstreamArchive::Ask AskUpstream(GstBaseSink* sink) {
  const std::shared_ptr<GstPad> pad(GST_PAD(gst_object_ref(GST_BASE_SINK_PAD(sink))),
                                    gst_object_unref);
  return [pad](GstQuery* query) { return gst_pad_peer_query(pad.get(), query) != FALSE; };
}

bool OpenSlices(GstBaseSink* sink, const InputSettings& settings, const GstCaps* caps) {
  State& state = StateOf(sink);
  Hub& hub = *state.used;
  std::string why;
  state.slices =
      lidar::web::SliceStream::Open(hub.server.get(), caps,
                                    {TopicName(settings, "/points"), settings.frame_id,
                                     settings.recording, AskUpstream(sink), hub.max_points},
                                    {hub.points, hub.malformed}, &why);
  if (state.slices) return true;
  GST_ELEMENT_ERROR(sink, STREAM, FORMAT, ("Cannot show these slices: %s.", why.c_str()),
                    ("%" GST_PTR_FORMAT, static_cast<gconstpointer>(caps)));
  return false;
}

bool OpenTopics(GstBaseSink* sink, Kind kind, const GstCaps* caps) {
  State& state = StateOf(sink);
  const InputSettings settings = lidar::web::SettingsOf(GST_LIDAR_FOXGLOVE_INPUT(sink));
  switch (kind) {
    case Kind::kCloud:
      return OpenTopic(sink, TopicName(settings, "/points"), Schema::kPointCloud, &state.data);
    case Kind::kDraco:
      return OpenTopic(sink, TopicName(settings, "/points_draco"), Schema::kCompressedPointCloud,
                       &state.data);
    case Kind::kOdometry:
      return OpenPoses(sink, TopicName(settings, kPoses));
    case Kind::kSlices:
      return OpenSlices(sink, settings, caps);
    case Kind::kH264:
    case Kind::kVp8:
      return OpenVideo(sink, TopicName(settings, kCamera));
    case Kind::kNone:
      break;
  }
  return false;
}

gboolean SetCaps(GstBaseSink* sink, GstCaps* caps) {
  State& state = StateOf(sink);
  if (!state.used) return FALSE;
  std::optional<CloudInfo> info;
  std::string why;
  const Kind kind = KindOf(caps, &info, &why);
  if (kind == Kind::kNone) {
    if (state.refused.Note(caps))
      GST_ELEMENT_ERROR(sink, STREAM, FORMAT,
                        ("The caps do not describe a cloud that can be shown: %s.", why.c_str()),
                        ("%" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
    return FALSE;
  }
  state.refused.Reset();
  if (info) state.info = std::move(*info);
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  state.parent_frame = FrameIn(s, GST_LIDAR_FRAME_ID, lidar::web::kFixedFrame);
  state.child_frame = FrameIn(s, GST_LIDAR_CHILD_FRAME_ID, kCloudFrame);
  if (kind != Kind::kOdometry && !IsVideo(kind)) state.used->scan_duration = ScanDurationOf(caps);
  // A cloud of another width stays in the same channel. Coded slices with other caps are a new
  // stream.
  if (kind == state.kind && kind != Kind::kSlices) return TRUE;
  CloseTopics(&state);
  const bool good = OpenTopics(sink, kind, caps);
  if (!good) CloseTopics(&state);
  state.kind = good ? kind : Kind::kNone;
  return good;
}

/// Returns the time since the buffer's timestamp on the pipeline's clock, or 0 if it is unknown.
guint64 AgeOf(GstBaseSink* sink, GstBuffer* buffer) {
  const guint64 running_time =
      gst_segment_to_running_time(&sink->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
  const std::unique_ptr<GstClock, Unref> clock(gst_element_get_clock(GST_ELEMENT(sink)));
  if (!clock || !GST_CLOCK_TIME_IS_VALID(running_time)) return 0;
  const guint64 then = gst_element_get_base_time(GST_ELEMENT(sink)) + running_time;
  const guint64 now = gst_clock_get_time(clock.get());
  return now > then ? now - then : 0;
}

/// Returns the capture time. If the buffer has none, returns the time at which the buffer was due.
guint64 TimeOf(GstBaseSink* sink, GstBuffer* buffer) {
  const GstClockTime captured = gst_lidar_buffer_get_capture_time(buffer);
  if (GST_CLOCK_TIME_IS_VALID(captured)) return captured;
  return static_cast<guint64>(g_get_real_time()) * GST_USECOND - AgeOf(sink, buffer);
}

void PublishPose(State* state, const Header& header, const std::string& child, const Pose& pose) {
  auto& server = *state->used->server;
  const guint64 unix_ns = header.unix_ns;
  if (state->transforms->wanted())
    server.Publish(state->transforms,
                   {unix_ns, lidar::foxglove::EncodeTransform(header, child, pose)});
  if (state->poses->wanted())
    server.Publish(state->poses, {unix_ns, lidar::foxglove::EncodePose(header, pose)});
}

/// Publishes the pose of a cloud. The caller publishes the cloud afterwards.
void PublishPoseOfCloud(GstBaseSink* sink, GstBuffer* buffer, const Header& header) {
  State& state = StateOf(sink);
  GstLidarPose meta;
  if (state.no_poses || !gst_lidar_buffer_get_pose(buffer, &meta)) return;
  if (!state.poses) {
    InputSettings settings = lidar::web::SettingsOf(GST_LIDAR_FOXGLOVE_INPUT(sink));
    settings.topic.clear();
    auto& server = *state.used->server;
    const std::string name = TopicName(settings, kPoses);
    state.poses = server.Open(name, Schema::kPose);
    state.transforms = server.Open(kTransforms, Schema::kFrameTransform);
    if (!state.poses || !state.transforms) {
      GST_ELEMENT_WARNING(sink, RESOURCE, SETTINGS,
                          ("The poses of the clouds are not shown: %s.",
                           lidar::web::TopicInUse(state.poses ? kTransforms : name).c_str()),
                          (nullptr));
      state.no_poses = true;
      return;
    }
    state.transforms->set_depth(kMaxDepth);
  }
  PublishPose(&state, {header.unix_ns, lidar::web::kFixedFrame}, header.frame_id,
              lidar::web::PoseOf(meta));
}

bool RenderCloud(State* state, const Header& header, const BufferMap& map) {
  const CloudInfo& info = state->info;
  if (map.size() != info.FrameSize()) return false;
  ++state->used->clouds;
  if (!state->data->wanted()) return true;
  auto cloud = lidar::foxglove::EncodePointCloud(
      header, {info.fields, info.point_step, info.width, info.height, map.view()},
      state->used->max_points);
  state->used->points += cloud.points;
  state->used->server->Publish(state->data, {header.unix_ns, std::move(cloud.message)});
  return true;
}

bool RenderDraco(State* state, const Header& header, const BufferMap& map) {
  ++state->used->clouds;
  if (!state->data->wanted()) return true;
  state->used->server->Publish(
      state->data, {header.unix_ns, lidar::foxglove::EncodeDracoCloud(header, map.view())});
  return true;
}

bool RenderSlice(State* state, const Header& header, GstBuffer* buffer, const BufferMap& map) {
  ++state->used->clouds;
  GstLidarSlice slice;
  gst_lidar_buffer_get_slice(buffer, &slice);
  lidar::web::SliceMessage message;
  message.id = {slice.scan_id, slice.slice_index};
  message.count = slice.slice_count;
  message.first_column = slice.first_column;
  message.unix_ns = header.unix_ns;
  message.payload.assign(map.data(), map.data() + map.size());
  return state->slices->Push(std::move(message));
}

/// Publishes a video frame. If a frame is dropped for a client, the client continues with the next
/// key frame.
bool RenderVideo(State* state, const Header& header, GstBuffer* buffer, const BufferMap& map) {
  const char* format = state->kind == Kind::kVp8 ? "vp8" : "h264";
  const bool is_delta = GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_DELTA_UNIT);
  if (!state->data->wanted()) return true;
  state->used->server->Publish(
      state->data,
      {header.unix_ns, lidar::foxglove::EncodeVideo(header, map.view(), format), is_delta});
  return true;
}

/// Publishes the position and the orientation, which are the first seven doubles of the buffer.
bool RenderOdometry(State* state, const Header& header, const BufferMap& map) {
  lidar::ByteReader in(map.view());
  Pose pose;
  for (double& value : pose.position) value = in.LeF64();
  for (double& value : pose.orientation) value = in.LeF64();
  if (!in.ok()) return false;
  // If the pad's property frame-id is set, it has priority over the caps.
  const bool from_caps = header.frame_id == InputSettings{}.frame_id;
  PublishPose(state, {header.unix_ns, state->parent_frame},
              from_caps ? state->child_frame : header.frame_id, pose);
  return true;
}

/// Sets the depth of the channel to the number of slices in a scan. A slow client then misses whole
/// scans, and a fast client misses no slice.
void LearnDepth(State* state, GstBuffer* buffer) {
  GstLidarSlice slice;
  gst_lidar_buffer_get_slice(buffer, &slice);
  if (state->data && !IsVideo(state->kind))
    state->data->set_depth(CLAMP(slice.slice_count, 1, kMaxDepth));
}

GstFlowReturn Render(GstBaseSink* sink, GstBuffer* buffer) {
  State& state = StateOf(sink);
  if (!state.used || state.kind == Kind::kNone) return GST_FLOW_NOT_NEGOTIATED;
  LearnDepth(&state, buffer);
  const Header header{TimeOf(sink, buffer),
                      lidar::web::SettingsOf(GST_LIDAR_FOXGLOVE_INPUT(sink)).frame_id};
  if (state.kind != Kind::kOdometry) PublishPoseOfCloud(sink, buffer, header);
  const BufferMap map(buffer, GST_MAP_READ);
  bool good = false;
  if (map && map.size() > 0) {
    if (state.kind == Kind::kCloud) good = RenderCloud(&state, header, map);
    if (state.kind == Kind::kDraco) good = RenderDraco(&state, header, map);
    if (state.kind == Kind::kSlices) good = RenderSlice(&state, header, buffer, map);
    if (state.kind == Kind::kOdometry) good = RenderOdometry(&state, header, map);
    if (IsVideo(state.kind)) good = RenderVideo(&state, header, buffer, map);
  }
  if (!good) {
    ++state.used->malformed;
    GST_WARNING_OBJECT(sink, "dropping a buffer that is damaged or does not match its caps");
  }
  return GST_FLOW_OK;
}

gboolean Start(GstBaseSink* sink) {
  State& state = StateOf(sink);
  const std::lock_guard lock(state.mutex);
  state.used = state.hub;
  state.refused.Reset();
  return TRUE;
}

gboolean Stop(GstBaseSink* sink) {
  State& state = StateOf(sink);
  CloseTopics(&state);
  state.kind = Kind::kNone;
  state.used.reset();
  return TRUE;
}

}  // namespace

static void gst_lidar_foxglove_input_init(GstLidarFoxgloveInput* self) { self->state = new State; }

static void gst_lidar_foxglove_input_class_init(GstLidarFoxgloveInputClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_foxglove_input_debug, "foxglovesink", 0, "Foxglove server");
  OwnState<GstLidarFoxgloveInput, gst_lidar_foxglove_input_parent_class>(G_OBJECT_CLASS(klass));
  Describe(
      klass, {"Foxglove input", "Sink", "One stream of foxglovesink"},
      {{"sink", GST_PAD_SINK,
        GST_LIDAR_CLOUD_MEDIA_TYPE
        "; " GST_LIDAR_DRACO_MEDIA_TYPE ", geometry=xyz; " GST_LIDAR_ODOMETRY_MEDIA_TYPE
        "; " GST_LIDAR_SLICE_MEDIA_TYPE "; video/x-h264, stream-format=byte-stream, alignment=au; "
        "video/x-vp8"}});
  auto* sink = GST_BASE_SINK_CLASS(klass);
  sink->start = Start;
  sink->stop = Stop;
  sink->set_caps = SetCaps;
  sink->render = Render;
}
