// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-ros2sink
 *
 * Publishes clouds, samples of an IMU, or odometry for ROS 2 nodes, each buffer as a message. Needs
 * no ROS.
 *
 * |[
 * gst-launch-1.0 lidartestsrc is-live=true ! scanassembler ! ros2sink topic=/points
 * ]|
 */
#include <gst/base/gstbasesink.h>

#include <memory>
#include <mutex>
#include <utility>

#include "ext/ros2/message_writer.h"
#include "ext/ros2/ros_settings.h"
#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/imu_sample.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_ros2_sink_debug);
#define GST_CAT_DEFAULT gst_lidar_ros2_sink_debug

namespace {

using namespace lidar::gst;
using lidar::Duration;
using lidar::Time;
using lidar::cdr::RosType;
using lidar::dds::Writer;

constexpr gint kAutoType = -1;

GType SinkTypeType() {
  static const GEnumValue kValues[] = {
      {kAutoType, "PointCloud2, Imu or Odometry, as the caps say", "auto"},
      {Int(RosType::kPointCloud2), "sensor_msgs/msg/PointCloud2", "pointcloud2"},
      {Int(RosType::kCompressedCloud), "point_cloud_interfaces/msg/CompressedPointCloud2",
       "compressed"},
      {Int(RosType::kImu), "sensor_msgs/msg/Imu", "imu"},
      {Int(RosType::kOdometry), "nav_msgs/msg/Odometry", "odometry"},
      {Int(RosType::kTransforms), "tf2_msgs/msg/TFMessage", "tf"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarRos2SinkType", kValues);
  return type;
}

GType CompressionType() {
  static const GEnumValue kValues[] = {{Int(CloudCompression::kDraco), "Draco", "draco"},
                                       {Int(CloudCompression::kZlib), "zlib", "zlib"},
                                       {Int(CloudCompression::kZstd), "Zstandard", "zstd"},
                                       {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarRos2Compression", kValues);
  return type;
}

/// Returns the default settings. They are reliable, because the tools of ROS 2 subscribe reliably
/// by default.
RosSettings SinkDefaults() {
  RosSettings settings;
  settings.qos = RosQos::kReliable;
  return settings;
}

struct Ros2SinkSettings {
  RosSettings ros = SinkDefaults();
  gint type = kAutoType;
  CloudCompression compression = CloudCompression::kZstd;
  MessageSettings messages;
};

struct Counters {
  guint64 messages = 0;
  guint64 bytes = 0;
  guint64 unread = 0;
  guint64 timeouts = 0;
  guint64 refused = 0;
  guint subscribers = 0;
};
const std::array<Stat<Counters>, 6> kStats = {{
    {"messages", &Counters::messages},
    {"bytes", &Counters::bytes},
    {"messages-without-subscriber", &Counters::unread},
    {"messages-timed-out", &Counters::timeouts},
    {"buffers-refused", &Counters::refused},
    {"subscribers", &Counters::subscribers},
}};

struct State {
  // Guards the members up to `counters`. It is not locked while publishing or posting.
  std::mutex mutex;
  Ros2SinkSettings settings;
  std::shared_ptr<Writer> writer;  // exists from the first caps to stop
  Counters counters;

  // Only the streaming thread uses the members below, between start and stop.
  std::unique_ptr<MessageWriter> messages;
  bool warned_timeout = false;
  bool warned_refused = false;
  bool warned_incompatible = false;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarRos2Sink, gst_lidar_ros2_sink, GST, LIDAR_ROS2_SINK, GstBaseSink)
struct _GstLidarRos2Sink {
  GstBaseSink parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarRos2Sink, gst_lidar_ros2_sink, GST_TYPE_BASE_SINK)
GST_ELEMENT_REGISTER_DEFINE(ros2sink, "ros2sink", GST_RANK_NONE, gst_lidar_ros2_sink_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_ROS2_SINK(self)->state; }

static std::shared_ptr<Writer> WriterOf(gpointer self) {
  State& state = StateOf(self);
  const std::lock_guard lock(state.mutex);
  return state.writer;
}

static StructurePtr Stats(GObject* object) {
  State& state = StateOf(object);
  const auto writer = WriterOf(object);
  const guint subscribers = writer ? writer->subscribers() : 0;
  std::unique_lock lock(state.mutex);
  Counters counters = state.counters;
  lock.unlock();
  counters.subscribers = subscribers;
  return ToStructure("application/x-ros2sink-stats", kStats, counters);
}

static const std::array<Property<Ros2SinkSettings>, 13> kProperties = {{
    Within<&Ros2SinkSettings::ros>(RosRows(), "topic"),
    {"type", "Type of the topic's messages",
     EnumField<Ros2SinkSettings>{&Ros2SinkSettings::type, SinkTypeType}},
    {"compression",
     "Compression with type=compressed, as by point_cloud_transport's plugin of the same name",
     EnumField<Ros2SinkSettings, CloudCompression>{&Ros2SinkSettings::compression,
                                                   CompressionType}},
    Within<&Ros2SinkSettings::ros>(RosRows(), "domain-id"),
    Within<&Ros2SinkSettings::ros>(RosRows(), "node-name"),
    Within<&Ros2SinkSettings::ros>(RosRows(), "qos"),
    Within<&Ros2SinkSettings::ros>(RosRows(), "depth"),
    Within<&Ros2SinkSettings::ros>(RosRows(), "ros-distro"),
    {"frame-id",
     "Frame of the data; NULL: the frame in the caps, or lidar for clouds, imu for IMU samples, "
     "odom for odometry",
     At<&Ros2SinkSettings::messages, &MessageSettings::frames, &Frames::frame_id>, 0, 0,
     GST_PARAM_MUTABLE_PLAYING},
    {"child-frame-id",
     "Frame whose pose the odometry estimates; NULL: the frame in the caps, or lidar",
     At<&Ros2SinkSettings::messages, &MessageSettings::frames, &Frames::child_frame_id>, 0, 0,
     GST_PARAM_MUTABLE_PLAYING},
    {"position-variance", "Variance of tracked poses along each axis; 0: not known [m^2]",
     At<&Ros2SinkSettings::messages, &MessageSettings::position_variance>, 0, 999,
     GST_PARAM_MUTABLE_PLAYING},
    {"orientation-variance", "Variance of tracked poses about each axis; 0: not known [rad^2]",
     At<&Ros2SinkSettings::messages, &MessageSettings::orientation_variance>, 0, 999,
     GST_PARAM_MUTABLE_PLAYING},
    {"stats",
     "messages, bytes [bytes], messages-without-subscriber, messages-timed-out, buffers-refused, "
     "subscribers",
     Stats},
}};

static bool OpenWriter(GstLidarRos2Sink* self, const RosSettings& settings, RosType type) {
  State& state = StateOf(self);
  const auto options = ToOptions(GST_ELEMENT(self), settings, type);
  if (!options) return false;
  std::string why;
  std::shared_ptr<Writer> writer = Writer::Create(*options, &why);
  if (!writer) {
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_WRITE,
                      ("DDS cannot publish %s: %s.", settings.topic.c_str(), why.c_str()),
                      (nullptr));
    return false;
  }
  std::unique_lock lock(state.mutex);
  std::swap(state.writer, writer);
  lock.unlock();  // the last writer is deleted without the lock
  return true;
}

/// Opens the writer if the type is set, so that wrong settings fail at once. An automatic type is
/// known only when the caps arrive.
static gboolean Start(GstBaseSink* base) {
  auto* self = GST_LIDAR_ROS2_SINK(base);
  State& state = StateOf(self);
  const Ros2SinkSettings settings = Snapshot(state);
  state.warned_timeout = state.warned_refused = state.warned_incompatible = false;
  {
    const std::lock_guard lock(state.mutex);
    state.counters = {};
  }
  if (settings.type != kAutoType)
    return OpenWriter(self, settings.ros, static_cast<RosType>(settings.type));
  return ToOptions(GST_ELEMENT(self), settings.ros, RosType::kPointCloud2).has_value();
}

static gboolean Stop(GstBaseSink* base) {
  State& state = StateOf(base);
  std::unique_lock lock(state.mutex);
  // Deletes the writer without the lock, because deleting it waits for threads of DDS.
  const std::shared_ptr<Writer> writer = std::move(state.writer);
  lock.unlock();
  state.messages.reset();
  return TRUE;
}

/// Refused caps leave the state as it is, because GstBaseSink does not call SetCaps() again when
/// the earlier caps return.
static gboolean SetCaps(GstBaseSink* base, GstCaps* caps) {
  auto* self = GST_LIDAR_ROS2_SINK(base);
  State& state = StateOf(self);
  const Ros2SinkSettings settings = Snapshot(state);
  const bool automatic = settings.type == kAutoType;
  const auto type =
      automatic ? MessageWriter::UsualType(caps) : static_cast<RosType>(settings.type);
  if (!type) return FALSE;
  std::string why;
  auto messages = MessageWriter::Make(*type, caps, &why);
  if (!messages) {
    GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("This stream cannot be published: %s.", why.c_str()),
                      ("caps are %" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
    return FALSE;
  }
  const bool open = state.messages && state.messages->type() == *type;
  if (automatic && !open && !OpenWriter(self, settings.ros, *type)) return FALSE;
  state.messages = std::move(messages);
  return TRUE;
}

/// Counts the result. Warns only once until a message is sent again, because a subscriber that
/// hangs would cause many warnings.
static void NoteResult(GstLidarRos2Sink* self, Writer::Result result, gsize bytes) {
  State& state = StateOf(self);
  const bool sent = result == Writer::Result::kSent;
  const bool timeout = result == Writer::Result::kTimeout;
  {
    const std::lock_guard lock(state.mutex);
    Counters& c = state.counters;
    ++(sent ? c.messages : timeout ? c.timeouts : c.refused);
    if (sent) c.bytes += bytes;
  }
  if (!sent && !state.warned_timeout)
    GST_ELEMENT_WARNING(
        self, RESOURCE, WRITE,
        ("%s; messages are dropped and counted.",
         timeout ? "A subscriber is too slow for this topic" : "DDS refuses messages"),
        ("DDS %s", timeout ? "timed out" : "refused a message"));
  state.warned_timeout = !sent;
}

static void NoteIncompatible(GstLidarRos2Sink* self, Writer::Want want) {
  if (want == Writer::Want::kNothing || std::exchange(StateOf(self).warned_incompatible, true))
    return;
  if (want == Writer::Want::kReliability)
    GST_ELEMENT_WARNING(self, RESOURCE, SETTINGS,
                        ("A subscriber of the topic requires reliable messages, which "
                         "qos=sensor-data does not offer."),
                        ("set qos=reliable"));
  else
    GST_ELEMENT_WARNING(self, RESOURCE, SETTINGS,
                        ("A subscriber of the topic requires a QoS that ros2sink does not offer, "
                         "such as earlier messages (durability transient local)."),
                        ("subscribe with the durability volatile, and without a deadline"));
}

static Writer::Result PublishMessage(GstLidarRos2Sink* self, Writer* writer,
                                     const std::vector<lidar::ByteView>& pieces) {
  gsize bytes = 0;
  for (const lidar::ByteView& piece : pieces) bytes += piece.size;
  const Writer::Result result = writer->Publish(pieces);
  NoteResult(self, result, bytes);
  return result;
}

static GstFlowReturn Render(GstBaseSink* base, GstBuffer* buffer) {
  auto* self = GST_LIDAR_ROS2_SINK(base);
  State& state = StateOf(self);
  const auto writer = WriterOf(self);
  if (!writer || !state.messages) return GST_FLOW_NOT_NEGOTIATED;
  NoteIncompatible(self, writer->TakeIncompatible());
  if (writer->subscribers() == 0) {
    const bool is_imu = state.messages->type() == RosType::kImu;  // one message for each sample
    const std::lock_guard lock(state.mutex);
    state.counters.unread += is_imu ? gst_buffer_get_size(buffer) / lidar::kImuSampleSize : 1;
    return GST_FLOW_OK;
  }
  const Time now = Time{} + Duration{g_get_real_time() * 1000};
  auto last = Writer::Result::kSent;
  const auto publish = [&](const auto& pieces) {
    // Only the first message of a buffer may wait. A wait for each of many samples would delay a
    // stop of the element.
    if (last == Writer::Result::kTimeout)
      NoteResult(self, last, 0);
    else
      last = PublishMessage(self, writer.get(), pieces);
  };
  const Ros2SinkSettings settings = Snapshot(state);
  MessageSettings wanted = settings.messages;
  wanted.compression = settings.compression;
  const bool published = state.messages->Write(buffer, wanted, now, publish);
  if (published) return GST_FLOW_OK;
  {
    const std::lock_guard lock(state.mutex);
    ++state.counters.refused;
  }
  if (!state.warned_refused)
    GST_ELEMENT_WARNING(self, STREAM, FORMAT,
                        ("A buffer does not match its caps; such buffers are dropped and counted."),
                        ("the buffer has %" G_GSIZE_FORMAT " bytes", gst_buffer_get_size(buffer)));
  state.warned_refused = true;
  return GST_FLOW_OK;
}

static void gst_lidar_ros2_sink_init(GstLidarRos2Sink* self) { self->state = new State; }

static void gst_lidar_ros2_sink_class_init(GstLidarRos2SinkClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_ros2_sink_debug, "ros2sink", 0, "Publisher of ROS 2");
  ServeState<GstLidarRos2Sink, gst_lidar_ros2_sink_parent_class, kProperties>(klass);
  Describe(klass, {"ROS 2 sink", "Sink/Network", "Publishes on a topic of ROS 2"},
           {{"sink", GST_PAD_SINK,
             GST_LIDAR_CLOUD_MEDIA_TYPE ";" GST_LIDAR_IMU_MEDIA_TYPE
                                        ";" GST_LIDAR_ODOMETRY_MEDIA_TYPE}});
  auto* base = GST_BASE_SINK_CLASS(klass);
  base->start = Start;
  base->stop = Stop;
  base->set_caps = SetCaps;
  base->render = Render;
}
