// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/foxglove/schemas.h"

#include <array>
#include <nlohmann/json.hpp>

#include "src/base/base64.h"
#include "src/foxglove/proto_writer.h"

namespace lidar::foxglove {
namespace {

/// The values of FieldDescriptorProto.Type.
enum class Type : std::uint8_t {
  kDouble = 1,
  kInt64 = 3,
  kInt32 = 5,
  kFixed32 = 7,
  kString = 9,
  kMessage = 11,
  kBytes = 12,
  kEnum = 14,
};

struct Field {
  const char* name;
  std::uint32_t number;
  Type type;
  const char* type_name = nullptr;  // for messages and enumerations
  bool repeated = false;
};

struct Enum {
  const char* name;
  std::vector<const char*> values;  // numbered from 0
};

struct Message {
  const char* name;
  std::vector<Field> fields;
  std::vector<Enum> enums = {};
};

constexpr const char* kTimestamp = ".google.protobuf.Timestamp";
constexpr const char* kVector3 = ".foxglove.Vector3";
constexpr const char* kQuaternion = ".foxglove.Quaternion";
constexpr const char* kPose = ".foxglove.Pose";

const std::vector<Message> kTimeMessages = {
    {"Timestamp", {{"seconds", 1, Type::kInt64}, {"nanos", 2, Type::kInt32}}},
};

const std::vector<Message> kMessages = {
    {"Vector3", {{"x", 1, Type::kDouble}, {"y", 2, Type::kDouble}, {"z", 3, Type::kDouble}}},
    {"Quaternion",
     {{"x", 1, Type::kDouble},
      {"y", 2, Type::kDouble},
      {"z", 3, Type::kDouble},
      {"w", 4, Type::kDouble}}},
    {"Pose",
     {{"position", 1, Type::kMessage, kVector3}, {"orientation", 2, Type::kMessage, kQuaternion}}},
    {"PackedElementField",
     {{"name", 1, Type::kString},
      {"offset", 2, Type::kFixed32},
      {"type", 3, Type::kEnum, ".foxglove.PackedElementField.NumericType"}},
     {{"NumericType",
       {"UNKNOWN", "UINT8", "INT8", "UINT16", "INT16", "UINT32", "INT32", "FLOAT32", "FLOAT64"}}}},
    {"PointCloud",
     {{"timestamp", 1, Type::kMessage, kTimestamp},
      {"frame_id", 2, Type::kString},
      {"pose", 3, Type::kMessage, kPose},
      {"point_stride", 4, Type::kFixed32},
      {"fields", 5, Type::kMessage, ".foxglove.PackedElementField", true},
      {"data", 6, Type::kBytes}}},
    {"CompressedPointCloud",
     {{"timestamp", 1, Type::kMessage, kTimestamp},
      {"frame_id", 2, Type::kString},
      {"pose", 3, Type::kMessage, kPose},
      {"data", 4, Type::kBytes},
      {"format", 5, Type::kString}}},
    {"CompressedVideo",
     {{"timestamp", 1, Type::kMessage, kTimestamp},
      {"frame_id", 2, Type::kString},
      {"data", 3, Type::kBytes},
      {"format", 4, Type::kString}}},
    {"PoseInFrame",
     {{"timestamp", 1, Type::kMessage, kTimestamp},
      {"frame_id", 2, Type::kString},
      {"pose", 3, Type::kMessage, kPose}}},
    {"FrameTransform",
     {{"timestamp", 1, Type::kMessage, kTimestamp},
      {"parent_frame_id", 2, Type::kString},
      {"child_frame_id", 3, Type::kString},
      {"translation", 4, Type::kMessage, kVector3},
      {"rotation", 5, Type::kMessage, kQuaternion}}},
};

// The functions below use the field numbers of google/protobuf/descriptor.proto.

void WriteField(ProtoWriter& out, const Field& field) {
  constexpr std::uint64_t kOptional = 1;
  constexpr std::uint64_t kRepeated = 3;
  out.String(1, field.name);
  out.Varint(3, field.number);
  out.Varint(4, field.repeated ? kRepeated : kOptional);
  out.Varint(5, static_cast<std::uint64_t>(field.type));
  if (field.type_name != nullptr) out.String(6, field.type_name);
}

void WriteEnum(ProtoWriter& out, const Enum& e) {
  out.String(1, e.name);
  for (std::size_t i = 0; i < e.values.size(); ++i) {
    out.Message(2, [&](ProtoWriter& value) {
      value.String(1, e.values[i]);
      value.Varint(2, i);
    });
  }
}

void WriteMessage(ProtoWriter& out, const Message& message) {
  out.String(1, message.name);
  for (const Field& field : message.fields)
    out.Message(2, [&](ProtoWriter& w) { WriteField(w, field); });
  for (const Enum& e : message.enums) out.Message(4, [&](ProtoWriter& w) { WriteEnum(w, e); });
}

struct File {
  const char* name;
  const char* package;
  const char* dependency;  // may be NULL
  const std::vector<Message>& messages;
};

void WriteFile(ProtoWriter& out, const File& file) {
  out.String(1, file.name);
  out.String(2, file.package);
  if (file.dependency != nullptr) out.String(3, file.dependency);
  for (const Message& message : file.messages)
    out.Message(4, [&](ProtoWriter& w) { WriteMessage(w, message); });
  out.String(12, "proto3");
}

std::string StatisticsSchema() {
  const auto integer = [] { return nlohmann::json{{"type", "integer"}}; };
  nlohmann::json properties = {
      {"timestamp",
       {{"type", "object"},
        {"title", "time"},
        {"properties", {{"sec", integer()}, {"nsec", integer()}}}}},
      {"elements",
       {{"type", "object"},
        {"title", "elements"},
        {"description", "The property stats of each element, by its name"}}}};
  for (const StatisticsField& field : kStatisticsFields) {
    nlohmann::json& property = properties[field.name];
    property = {{"type", field.is_array ? "array" : "number"}, {"description", field.description}};
    if (field.is_array) property["items"] = {{"type", "number"}};
  }
  return nlohmann::json{
      {"title", "lidar.Statistics"}, {"type", "object"}, {"properties", properties}}
      .dump();
}

}  // namespace

const std::vector<StatisticsField> kStatisticsFields = {
    {"target_bitrate", "What the network allows the encoder [bit/s]"},
    {"sent_bitrate", "What is sent, headers included [bit/s]"},
    {"estimated_capacity", "What the link carries, whatever is sent [bit/s]"},
    {"queue_delay", "Delay in the queues of the network [ms]"},
    {"rtt", "Round trip time [ms]"},
    {"ref_wnd", "The reference window of the congestion control [bytes]"},
    {"bytes_in_flight", "Sent and not yet reported [bytes]"},
    {"step", "Quantisation step of the newest slice [m]"},
    {"error_bound", "The largest error that this step allows [m]"},
    {"packets_lost", "Packets that the network lost"},
    {"packets_ce", "Packets that the network marked"},
    {"slices_lost", "Slices that did not arrive whole"},
    {"position_deviation",
     "Of the odometry since the start: root of the sum of the variances of x, y and z [m]"},
    {"pose_covariance",
     "Of the odometry since the start, 6 x 6: x, y, z [m], and turns about these axes [rad]", true},
    {"poses_degenerate", "Scans that did not show the motion along one direction"},
    {"poses_lost", "Scans that did not fit the map of the odometry"},
};

std::vector<std::uint8_t> FileDescriptorSet() {
  constexpr const char* kTimeFile = "google/protobuf/timestamp.proto";
  const std::array<File, 2> files = {{
      {kTimeFile, "google.protobuf", nullptr, kTimeMessages},
      {"foxglove.proto", "foxglove", kTimeFile, kMessages},
  }};
  std::vector<std::uint8_t> bytes;
  ProtoWriter out(&bytes);
  for (const File& file : files) out.Message(1, [&](ProtoWriter& w) { WriteFile(w, file); });
  return bytes;
}

SchemaText TextOf(Schema schema) {
  const auto protobuf = [](const char* name) {
    return SchemaText{name, "protobuf", "protobuf", Base64(FileDescriptorSet())};
  };
  switch (schema) {
    case Schema::kPointCloud:
      return protobuf("foxglove.PointCloud");
    case Schema::kCompressedPointCloud:
      return protobuf("foxglove.CompressedPointCloud");
    case Schema::kCompressedVideo:
      return protobuf("foxglove.CompressedVideo");
    case Schema::kPose:
      return protobuf("foxglove.PoseInFrame");
    case Schema::kFrameTransform:
      return protobuf("foxglove.FrameTransform");
    case Schema::kSlice:
      return {"lidar.Slice", "lidar-slice", "json", ""};
    case Schema::kStatistics:
      break;
  }
  return {"lidar.Statistics", "json", "jsonschema", StatisticsSchema()};
}

}  // namespace lidar::foxglove
