// SPDX-License-Identifier: LGPL-2.1-or-later
// The schemas of the messages that we send, as channels announce them:
// https://github.com/foxglove/foxglove-sdk.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace lidar::foxglove {

/// The content of a channel.
enum class Schema {
  kPointCloud,
  kCompressedPointCloud,
  kCompressedVideo,
  kPose,
  kFrameTransform,
  kStatistics,
  kSlice,  // slices as the robot encoded them, for our own page
};

struct SchemaText {
  const char* name;      // "foxglove.PointCloud"
  const char* encoding;  // of the messages: "protobuf", "json" or "lidar-slice"
  const char* language;  // of the schema: "protobuf", "jsonschema", or "json" (of a stream)
  std::string text;      // base64 if the language is protobuf; empty if each stream has its own
};
SchemaText TextOf(Schema schema);

/// Returns a serialised google.protobuf.FileDescriptorSet of all protobuf messages that we send.
std::vector<std::uint8_t> FileDescriptorSet();

/// A member of a statistics message, and its description.
struct StatisticsField {
  const char* name;
  const char* description;  // with its unit
  bool is_array = false;    // of numbers
};
extern const std::vector<StatisticsField> kStatisticsFields;

}  // namespace lidar::foxglove
