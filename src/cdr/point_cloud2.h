// SPDX-License-Identifier: LGPL-2.1-or-later
// sensor_msgs/msg/PointCloud2, and the conversion of its points to ours.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cdr/messages.h"
#include "src/cloud/point_fields.h"

namespace lidar::cdr {

/// sensor_msgs/msg/PointField, whose datatypes 1 to 8 are our FieldTypes in the same order.
struct RosField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 1;
};
bool operator==(const RosField& a, const RosField& b);

/// The common properties of a source's messages.
struct RosLayout {
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<RosField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;  // bytes
  std::uint32_t row_step = 0;    // bytes
};
bool operator==(const RosLayout& a, const RosLayout& b);

struct PointCloud2 {
  Header header;
  RosLayout layout;
  ByteView data;  // not owned: a part of the message it was read from
  bool is_dense = false;
};

/// Returns nothing for another message; `why` then has the reason for a user.
std::optional<PointCloud2> ReadPointCloud2(ByteView message, std::string* why = nullptr);
std::vector<std::uint8_t> WritePointCloud2(const PointCloud2& cloud);

/// A cloud that owns its points.
struct MadeCloud {
  PointCloud2 cloud;  // its data are `points`
  std::vector<std::uint8_t> points;
};
/// livox_ros_driver2/msg/CustomMsg, as the PointCloud2 that the same driver publishes of it: x, y,
/// z, intensity, tag, line, and timestamp as F64 [ns since 1970]. Returns nothing for another
/// message.
std::optional<MadeCloud> ReadLivox(ByteView message, std::string* why = nullptr);

/// point_cloud_interfaces/msg/CompressedPointCloud2
struct CompressedCloud {
  PointCloud2 cloud;   // its data are compressed
  std::string format;  // "draco", "zlib", "zstd"
};
std::optional<CompressedCloud> ReadCompressedCloud(ByteView message, std::string* why = nullptr);
std::vector<std::uint8_t> WriteCompressedCloud(const CompressedCloud& compressed);

/// Returns the bytes between the beginnings of two rows. Returns nothing if the data's length
/// contradicts width, height and steps. Many drivers set row_step to 0 or to the total size, so
/// packed rows are recognised by the size alone.
std::optional<std::size_t> RowStride(const PointCloud2& cloud);

/// A message in two parts, for a gathering write: the points go between `head` and `tail`.
struct PointCloud2Frame {
  std::vector<std::uint8_t> head;
  std::vector<std::uint8_t> tail;
};
/// Uses the size of `cloud.data`, not the points.
PointCloud2Frame FramePointCloud2(const PointCloud2& cloud);

/// The layout of points in our clouds.
struct PointLayout {
  PointFields fields;
  std::uint32_t point_step = 0;  // bytes
};

/// Returns the layout of packed rows of little-endian points. Adjacent fields a[0], a[1], ... of
/// one type become one field with as many elements.
RosLayout ToRosLayout(const PointLayout& points, std::uint32_t width, std::uint32_t height);

/// Converts points of messages of one layout to little-endian points in packed rows.
class PointConverter {
 public:
  /// `wanted` selects fields and their new types. Without it all fields stay; only x, y and z
  /// become F32 side by side, as all elements need them. A field of n elements becomes n fields
  /// a[0], a[1], ... A field is padding if it has no usable name, an earlier field's name, an
  /// unknown type or more than kMaxFields elements. Returns nothing if the layout contradicts
  /// itself, is too large, or lacks a wanted field; `why` then has the reason.
  static std::optional<PointConverter> Make(const RosLayout& layout,
                                            const std::optional<PointLayout>& wanted = {},
                                            std::string* why = nullptr);

  const RosLayout& layout() const { return from_; }
  const PointLayout& points() const { return to_; }
  /// Bytes of one cloud of ours.
  std::size_t size() const { return std::size_t{from_.width} * from_.height * to_.point_step; }
  /// Returns true if points are copied as they are.
  bool copies() const { return steps_.empty(); }

  /// `cloud` has layout(). Returns false if it has no RowStride(). `out` has size() bytes.
  bool Convert(const PointCloud2& cloud, std::uint8_t* out) const;

  static constexpr std::size_t kMaxSize = std::size_t{1} << 30;  // limit of clouds in caps

 private:
  /// Bytes that move together, or one number that changes its type or its byte order.
  struct Step {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t size = 0;  // bytes in the message
    FieldType from_type{};
    FieldType to_type{};
    bool converts = false;
  };

  bool Plan(const std::vector<PointField>& source, std::string* why);
  void ConvertPoint(const std::uint8_t* from, std::uint8_t* to) const;

  RosLayout from_;
  PointLayout to_;
  std::vector<Step> steps_;
};

}  // namespace lidar::cdr
