// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/message_types.h"

#include <array>
#include <utility>

#include "gst/common/caps_text.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/coded_slice.h"
#include "src/cdr/motion_samples.h"
#include "src/cdr/ros_types.h"

namespace lidar::gst {
namespace {

constexpr const char* kTime = R"(MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
)";
constexpr const char* kDuration = R"(MSG: builtin_interfaces/Duration
int32 sec
uint32 nanosec
)";
constexpr const char* kHeader = R"(MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
)";
constexpr const char* kCloud = R"(std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
)";
constexpr const char* kPointField = R"(MSG: sensor_msgs/PointField
uint8 INT8=1
uint8 UINT8=2
uint8 INT16=3
uint8 UINT16=4
uint8 INT32=5
uint8 UINT32=6
uint8 FLOAT32=7
uint8 FLOAT64=8
string name
uint32 offset
uint8 datatype
uint32 count
)";
constexpr const char* kImu = R"(std_msgs/Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
)";
constexpr const char* kQuaternion = R"(MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
)";
constexpr const char* kVector3 = R"(MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
)";
constexpr const char* kOdometry = R"(std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
)";
constexpr const char* kPoseWithCovariance = R"(MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
)";
constexpr const char* kPose = R"(MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
)";
constexpr const char* kPoint = R"(MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
)";
constexpr const char* kTwistWithCovariance = R"(MSG: geometry_msgs/TwistWithCovariance
geometry_msgs/Twist twist
float64[36] covariance
)";
constexpr const char* kTwist = R"(MSG: geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
)";
constexpr const char* kSlice =
    R"(# A part of a scan as a coder of gst-lidar made it; the channel's metadata has its caps.
std_msgs/Header header                 # stamp: when the first column was sampled; 0: not known
builtin_interfaces/Duration duration   # of the sweep; -1 s: not known
uint32 scan_id
uint32 slice_index
uint32 slice_count                     # 0: scan and slice are not known
uint32 first_column
bool discontinuity                     # what came before it is missing
uint8[] data
)";

/// Joins a definition and the definitions to which it refers.
template <class... Parts>
std::string Definition(const char* first, Parts... needed) {
  std::string text = first;
  for (const char* part : {needed...}) text.append(80, '=').append("\n").append(part);
  return text;
}

std::string TextOf(MessageType type) {
  switch (type) {
    case MessageType::kCloud:
      return Definition(kCloud, kHeader, kTime, kPointField);
    case MessageType::kImu:
      return Definition(kImu, kHeader, kTime, kQuaternion, kVector3);
    case MessageType::kOdometry:
      return Definition(kOdometry, kHeader, kTime, kPoseWithCovariance, kPose, kPoint, kQuaternion,
                        kTwistWithCovariance, kTwist, kVector3);
    case MessageType::kSlice:
      break;
  }
  return Definition(kSlice, kHeader, kTime, kDuration);
}

struct TypeInfo {
  MessageType type;
  std::string_view schema;
  std::string_view topic;
  const char* media_type;  // NULL: any type of coded slices
};
constexpr std::array<TypeInfo, 4> kTypes = {{
    {MessageType::kCloud, cdr::InfoOf(cdr::RosType::kPointCloud2).name, "/points",
     GST_LIDAR_CLOUD_MEDIA_TYPE},
    {MessageType::kImu, cdr::InfoOf(cdr::RosType::kImu).name, "/imu", GST_LIDAR_IMU_MEDIA_TYPE},
    {MessageType::kOdometry, cdr::InfoOf(cdr::RosType::kOdometry).name, "/odometry",
     GST_LIDAR_ODOMETRY_MEDIA_TYPE},
    {MessageType::kSlice, cdr::CodedSlice::kName, "/slices", nullptr},
}};

const TypeInfo& InfoOf(MessageType type) { return kTypes[static_cast<std::size_t>(type)]; }

}  // namespace

mcap::Schema SchemaOf(MessageType type) {
  return {0, std::string(InfoOf(type).schema), "ros2msg", TextOf(type)};
}

std::optional<MessageType> TypeOf(const mcap::Schema& schema, const mcap::Channel& channel) {
  for (const TypeInfo& info : kTypes)
    if (schema.name == info.schema && channel.message_encoding == "cdr") return info.type;
  return std::nullopt;
}

std::optional<MessageType> TypeOf(const GstCaps* caps) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  for (const TypeInfo& info : kTypes)
    if (info.media_type != nullptr && gst_structure_has_name(s, info.media_type)) return info.type;
  const gchar* alignment = gst_structure_get_string(s, "alignment");
  if (g_strcmp0(alignment, "slice") == 0) return MessageType::kSlice;
  return std::nullopt;
}

bool IsOurImu(const GstCaps* caps) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  gint size = 0;
  return gst_structure_get_int(s, "sample-size", &size) && size == gint{kImuSampleSize} &&
         g_strcmp0(gst_structure_get_string(s, "fields"), kImuFields) == 0;
}

std::string_view TopicOf(MessageType type) { return InfoOf(type).topic; }

CapsPtr CapsOfType(const std::string& text, MessageType type) {
  CapsPtr caps = CapsFromText(text);
  return caps && TypeOf(caps.get()) == type ? std::move(caps) : nullptr;
}

}  // namespace lidar::gst
