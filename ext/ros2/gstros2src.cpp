// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-ros2src
 *
 * Receives clouds, samples of an IMU, odometry, or transforms that ROS 2 nodes publish. Needs no
 * ROS.
 *
 * |[
 * gst-launch-1.0 ros2src topic=/ouster/points ! dracoenc geometry=xyz ! fakesink
 * ]|
 */
#include <gst/base/gstpushsrc.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

#include "ext/ros2/message_reader.h"
#include "ext/ros2/ros_settings.h"
#include "gst/common/coordinate_frames.h"
#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/refs.h"
#include "gst/common/source_caps.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_ros2_src_debug);
#define GST_CAT_DEFAULT gst_lidar_ros2_src_debug

namespace {

using namespace lidar::gst;
using lidar::cdr::RosType;
using lidar::dds::Reader;
using Verdict = MessageReader::Verdict;

GType SrcTypeType() {
  static const GEnumValue kValues[] = {
      {Int(RosType::kPointCloud2), "sensor_msgs/msg/PointCloud2", "pointcloud2"},
      {Int(RosType::kCompressedCloud), "point_cloud_interfaces/msg/CompressedPointCloud2",
       "compressed"},
      {Int(RosType::kLivox), "livox_ros_driver2/msg/CustomMsg", "livox"},
      {Int(RosType::kImu), "sensor_msgs/msg/Imu", "imu"},
      {Int(RosType::kOdometry), "nav_msgs/msg/Odometry", "odometry"},
      {Int(RosType::kTransforms), "tf2_msgs/msg/TFMessage", "tf"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarRos2SrcType", kValues);
  return type;
}

struct Ros2SrcSettings {
  RosSettings ros;
  RosType type = RosType::kPointCloud2;
};

/// The depth for static transforms, which each publisher sends only once. tf2 also keeps a hundred
/// of them.
constexpr guint kStaticDepth = 100;

/// Returns true if the contents of the topic never change. As in ROS, this depends on the name of
/// the topic.
bool IsForGood(const Ros2SrcSettings& settings) {
  const std::string name = settings.ros.topic.substr(settings.ros.topic.rfind('/') + 1);
  return settings.type == RosType::kTransforms && name == "tf_static";
}

struct Counters {
  guint64 messages = 0;
  guint64 bytes = 0;
  guint64 empty = 0;
  guint64 damaged = 0;
  guint64 other_types = 0;
  guint64 lost = 0;
  guint publishers = 0;
};
const std::array<Stat<Counters>, 7> kStats = {{
    {"messages", &Counters::messages},
    {"bytes", &Counters::bytes},
    {"messages-empty", &Counters::empty},
    {"messages-damaged", &Counters::damaged},
    {"messages-lost", &Counters::lost},
    {"publishers", &Counters::publishers},
    {"publishers-of-other-types", &Counters::other_types},
}};

struct State {
  // Guards the members up to `counters`. It is not locked while waiting or posting.
  std::mutex mutex;
  Ros2SrcSettings settings;
  std::shared_ptr<Reader> reader;  // exists from start to stop
  Counters counters;

  // Only the streaming thread uses the members below, between start and stop.
  std::unique_ptr<MessageReader> messages;
  bool warned_damaged = false;
  bool warned_type = false;
  bool warned_incompatible = false;
  const char* incompatible = "";  // describes the publisher's incompatible QoS
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarRos2Src, gst_lidar_ros2_src, GST, LIDAR_ROS2_SRC, GstPushSrc)
struct _GstLidarRos2Src {
  GstPushSrc parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarRos2Src, gst_lidar_ros2_src, GST_TYPE_PUSH_SRC)
GST_ELEMENT_REGISTER_DEFINE(ros2src, "ros2src", GST_RANK_NONE, gst_lidar_ros2_src_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_ROS2_SRC(self)->state; }

static std::shared_ptr<Reader> ReaderOf(gpointer self) {
  State& state = StateOf(self);
  const std::lock_guard lock(state.mutex);
  return state.reader;
}

/// Returns the counters, including those that DDS counts.
static Counters CountersNow(GObject* object) {
  State& state = StateOf(object);
  const auto reader = ReaderOf(object);
  const std::lock_guard lock(state.mutex);
  if (reader) {
    state.counters.lost = reader->lost();
    state.counters.publishers = reader->publishers();
  }
  return state.counters;
}

static StructurePtr Stats(GObject* object) {
  return ToStructure("application/x-ros2src-stats", kStats, CountersNow(object));
}

static const std::array<Property<Ros2SrcSettings>, 8> kProperties = {{
    Within<&Ros2SrcSettings::ros>(RosRows(), "topic"),
    {"type", "Type of the topic's messages",
     EnumField<Ros2SrcSettings, RosType>{&Ros2SrcSettings::type, SrcTypeType}},
    Within<&Ros2SrcSettings::ros>(RosRows(), "domain-id"),
    Within<&Ros2SrcSettings::ros>(RosRows(), "node-name"),
    Within<&Ros2SrcSettings::ros>(RosRows(), "qos"),
    Within<&Ros2SrcSettings::ros>(RosRows(), "depth"),
    Within<&Ros2SrcSettings::ros>(RosRows(), "ros-distro"),
    {"stats",
     "messages, bytes [bytes], messages-empty, messages-damaged, messages-lost, publishers, "
     "publishers-of-other-types",
     Stats},
}};

/// Posts a warning if the receive buffer is small. A cloud arrives in dozens of datagrams at once,
/// so a small buffer loses whole clouds.
static void WarnOfSmallBuffer(GstLidarRos2Src* self) {
  constexpr guint kWanted = lidar::dds::Domain::kReceiveBuffer;
  const guint granted = lidar::dds::Domain::GrantedReceiveBuffer();
  if (granted >= kWanted) return;
  GST_ELEMENT_WARNING(
      self, RESOURCE, SETTINGS,
      ("The kernel grants a receive buffer of %u bytes instead of %u: clouds may get lost.",
       granted, kWanted),
      ("raise it with: sysctl -w net.core.rmem_max=%u", kWanted));
}

static gboolean Start(GstBaseSrc* base) {
  auto* self = GST_LIDAR_ROS2_SRC(base);
  State& state = StateOf(self);
  const Ros2SrcSettings settings = Snapshot(state);
  auto options = ToOptions(GST_ELEMENT(self), settings.ros, settings.type);
  if (!options) return FALSE;
  if (IsForGood(settings)) {
    options->reliable = options->transient = true;
    options->depth = std::max(options->depth, kStaticDepth);
  }
  std::string why;
  std::shared_ptr<Reader> reader = Reader::Create(*options, &why);
  if (!reader) {
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ,
                      ("DDS cannot subscribe to %s: %s.", settings.ros.topic.c_str(), why.c_str()),
                      (nullptr));
    return FALSE;
  }
  if (lidar::cdr::IsCloud(settings.type)) WarnOfSmallBuffer(self);
  state.messages = std::make_unique<MessageReader>(
      settings.type, [base] { return CapsPtr(gst_pad_get_allowed_caps(GST_BASE_SRC_PAD(base))); },
      IsForGood(settings));
  state.incompatible =
      IsForGood(settings)
          ? "does not keep its transforms for later subscribers (durability transient local)"
          : "is best-effort, which qos=reliable does not accept";
  state.warned_damaged = state.warned_type = state.warned_incompatible = false;
  const std::lock_guard lock(state.mutex);
  state.reader = std::move(reader);
  state.counters = {};
  return TRUE;
}

static gboolean Stop(GstBaseSrc* base) {
  State& state = StateOf(base);
  CountersNow(G_OBJECT(base));
  std::unique_lock lock(state.mutex);
  // Deletes the reader without the lock, because deleting it waits for threads of DDS.
  const std::shared_ptr<Reader> reader = std::move(state.reader);
  state.counters.publishers = 0;
  lock.unlock();
  state.messages.reset();
  return TRUE;
}

static void Count(GstLidarRos2Src* self, guint64 Counters::*counter, guint64 amount = 1) {
  State& state = StateOf(self);
  const std::lock_guard lock(state.mutex);
  state.counters.*counter += amount;
}

/// Counts a publisher of another type. Warns only once, because any peer in the network can add
/// publishers.
static void NoteOtherType(GstLidarRos2Src* self, const Reader& reader) {
  Count(self, &Counters::other_types);
  if (std::exchange(StateOf(self).warned_type, true)) return;
  // The name of the type is from the network and may be invalid UTF-8, which must not be posted on
  // the bus.
  const StringPtr type(g_utf8_make_valid(reader.other_type().c_str(), -1));
  GST_ELEMENT_WARNING(
      self, STREAM, WRONG_TYPE,
      ("A publisher of the topic has the type %s; its messages are not received.", type.get()),
      (nullptr));
}

static void NoteIncompatible(GstLidarRos2Src* self) {
  State& state = StateOf(self);
  if (std::exchange(state.warned_incompatible, true)) return;
  GST_ELEMENT_WARNING(self, RESOURCE, SETTINGS,
                      ("A publisher of the topic %s.", state.incompatible),
                      ("set qos=sensor-data if the publisher is best-effort"));
}

/// Counts a damaged message. Warns only once until the next good message, because a broken
/// publisher sends many damaged messages.
static void NoteDamaged(GstLidarRos2Src* self, const std::string& why) {
  State& state = StateOf(self);
  Count(self, &Counters::damaged);
  GST_DEBUG_OBJECT(self, "dropping a message: %s", why.c_str());
  if (!state.warned_damaged)
    GST_ELEMENT_WARNING(
        self, STREAM, DECODE,
        ("A message is damaged: %s. Such messages are dropped and counted.", why.c_str()),
        (nullptr));
  state.warned_damaged = true;
}

/// Reads a message. Returns OK if there is a buffer, and CUSTOM_SUCCESS if the message results in
/// no buffer.
static GstFlowReturn Take(GstLidarRos2Src* self, const lidar::dds::MessagePtr& message) {
  State& state = StateOf(self);
  const lidar::ByteView bytes = lidar::dds::BytesOf(message.get());
  Count(self, &Counters::messages);
  Count(self, &Counters::bytes, bytes.size);
  // Downstream may have changed its caps while this thread waited for the message.
  if (gst_pad_check_reconfigure(GST_BASE_SRC_PAD(self))) state.messages->Renegotiate();
  switch (state.messages->Read(bytes)) {
    case Verdict::kBuffer:
      state.warned_damaged = false;
      return GST_FLOW_OK;
    case Verdict::kEmpty:
      Count(self, &Counters::empty);
      break;
    case Verdict::kDamaged:
      NoteDamaged(self, state.messages->why());
      break;
    case Verdict::kNotNegotiated:
      return GST_FLOW_NOT_NEGOTIATED;
  }
  return GST_FLOW_CUSTOM_SUCCESS;
}

/// Waits for the next message that results in a buffer.
static GstFlowReturn NextBuffer(GstLidarRos2Src* self, Reader* reader) {
  for (;;) {
    switch (reader->Wait()) {
      case Reader::Event::kWoken:
        return GST_FLOW_FLUSHING;
      case Reader::Event::kFailed:
        GST_ELEMENT_ERROR(self, RESOURCE, READ, ("Waiting for messages of DDS failed."), (nullptr));
        return GST_FLOW_ERROR;
      case Reader::Event::kOtherType:
        NoteOtherType(self, *reader);
        continue;
      case Reader::Event::kIncompatible:
        NoteIncompatible(self);
        continue;
      case Reader::Event::kMessage:
        break;
    }
    const lidar::dds::MessagePtr message = reader->Take();
    const GstFlowReturn flow = message ? Take(self, message) : GST_FLOW_CUSTOM_SUCCESS;
    if (flow != GST_FLOW_CUSTOM_SUCCESS) return flow;
  }
}

static GstFlowReturn Create(GstPushSrc* push, GstBuffer** out) {
  auto* self = GST_LIDAR_ROS2_SRC(push);
  State& state = StateOf(self);
  const auto reader = ReaderOf(self);
  if (!reader) return GST_FLOW_FLUSHING;
  const GstFlowReturn flow = NextBuffer(self, reader.get());
  if (flow != GST_FLOW_OK) return flow;
  if (const CapsPtr caps = state.messages->TakeNewCaps()) {
    GST_DEBUG_OBJECT(self, "caps %" GST_PTR_FORMAT, static_cast<gpointer>(caps.get()));
    const GstFlowReturn set = SetSourceCaps(GST_BASE_SRC(self), caps.get());
    if (set != GST_FLOW_OK) return set;
  }
  *out = state.messages->TakeBuffer().release();
  return GST_FLOW_OK;
}

static gboolean Unlock(GstBaseSrc* base) {
  if (const auto reader = ReaderOf(base)) reader->Wake(true);
  return TRUE;
}

static gboolean UnlockStop(GstBaseSrc* base) {
  if (const auto reader = ReaderOf(base)) reader->Wake(false);
  return TRUE;
}

static void gst_lidar_ros2_src_init(GstLidarRos2Src* self) {
  self->state = new State;
  auto* base = GST_BASE_SRC(self);
  gst_base_src_set_live(base, TRUE);
  gst_base_src_set_format(base, GST_FORMAT_TIME);
  gst_base_src_set_do_timestamp(base, TRUE);
}

static void InstallVmethods(GstLidarRos2SrcClass* klass) {
  auto* src = GST_BASE_SRC_CLASS(klass);
  src->start = Start;
  src->stop = Stop;
  src->unlock = Unlock;
  src->unlock_stop = UnlockStop;
  src->is_seekable = [](GstBaseSrc*) -> gboolean { return FALSE; };
  // Create() sets the caps when the first message arrives, because the message determines them.
  src->negotiate = [](GstBaseSrc* base) -> gboolean {
    if (const auto& messages = StateOf(base).messages) messages->Renegotiate();
    return TRUE;
  };
  GST_PUSH_SRC_CLASS(klass)->create = Create;
}

static void gst_lidar_ros2_src_class_init(GstLidarRos2SrcClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_ros2_src_debug, "ros2src", 0, "Subscription of ROS 2");
  ServeState<GstLidarRos2Src, gst_lidar_ros2_src_parent_class, kProperties>(klass);
  Describe(
      klass, {"ROS 2 source", "Source/Network", "Subscribes to a topic of ROS 2"},
      {{"src", GST_PAD_SRC,
        GST_LIDAR_CLOUD_MEDIA_TYPE ";" GST_LIDAR_IMU_MEDIA_TYPE ";" GST_LIDAR_ODOMETRY_MEDIA_TYPE
                                   ";" GST_LIDAR_TF_MEDIA_TYPE}});
  InstallVmethods(klass);
}
