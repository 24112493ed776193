// SPDX-License-Identifier: LGPL-2.1-or-later
// sensor_msgs/msg/PointCloud2, and the conversion of its points to our points.
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

/// sensor_msgs/msg/PointField. Its datatypes 1 to 8 are our FieldTypes in the same order.
struct RosField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 1;
};
bool operator==(const RosField& a, const RosField& b);

/// The properties that all messages of a source have in common.
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
  ByteView data;  // not owned: a part of the message from which it was read
  bool is_dense = false;
};

/// Reads a message. Returns nothing and sets `why`, a text for users, if it is not a PointCloud2.
std::optional<PointCloud2> ReadPointCloud2(ByteView message, std::string* why = nullptr);
std::vector<std::uint8_t> WritePointCloud2(const PointCloud2& cloud);

/// A cloud that owns its points.
struct MadeCloud {
  PointCloud2 cloud;  // its data are the member `points`
  std::vector<std::uint8_t> points;
};
/// Converts a livox_ros_driver2/msg/CustomMsg to the PointCloud2 that the same driver would publish
/// for it. Its fields are x, y, z, intensity, tag, line, and timestamp as F64 [ns since 1970].
/// Returns nothing if `message` is not a CustomMsg.
std::optional<MadeCloud> ReadLivox(ByteView message, std::string* why = nullptr);

/// point_cloud_interfaces/msg/CompressedPointCloud2
struct CompressedCloud {
  PointCloud2 cloud;   // its data are compressed
  std::string format;  // "draco", "zlib", "zstd"
};
std::optional<CompressedCloud> ReadCompressedCloud(ByteView message, std::string* why = nullptr);
std::vector<std::uint8_t> WriteCompressedCloud(const CompressedCloud& compressed);

/// Returns the distance between the beginnings of two rows [bytes]. Returns nothing if the size of
/// the data contradicts the width, the height and the steps. Many drivers set row_step to 0 or to
/// the total size. Rows without padding are therefore recognised by the size of the data alone.
std::optional<std::size_t> RowStride(const PointCloud2& cloud);

/// The two parts of a message without its points, for a gathering write. The points are sent
/// between `head` and `tail`.
struct PointCloud2Frame {
  std::vector<std::uint8_t> head;
  std::vector<std::uint8_t> tail;
};
/// Writes the parts of a message. Reads the size of `cloud.data`, but not the points.
PointCloud2Frame FramePointCloud2(const PointCloud2& cloud);

/// The layout of points in our clouds.
struct PointLayout {
  PointFields fields;
  std::uint32_t point_step = 0;  // bytes
};

/// Returns the layout of little-endian points in rows without padding. Adjacent fields a[0], a[1],
/// ... of the same type are combined to one field with several elements.
RosLayout ToRosLayout(const PointLayout& points, std::uint32_t width, std::uint32_t height);

/// Converts the points of messages to little-endian points in rows without padding. All messages
/// must have the same layout.
class PointConverter {
 public:
  /// Makes a converter. `wanted` selects the fields and their new types. If there is no `wanted`,
  /// all fields are kept, but x, y and z become F32 side by side, because all elements need that. A
  /// field with n elements becomes n fields a[0], a[1], ... A field counts as padding if its name
  /// cannot be used or is the name of an earlier field, if its type is unknown, or if it has more
  /// than kMaxFields elements. Returns nothing and sets `why` if the layout is contradictory or too
  /// large, or if a wanted field is missing.
  static std::optional<PointConverter> Make(const RosLayout& layout,
                                            const std::optional<PointLayout>& wanted = {},
                                            std::string* why = nullptr);

  const RosLayout& layout() const { return from_; }
  const PointLayout& points() const { return to_; }
  /// Returns the size of a converted cloud [bytes].
  std::size_t size() const { return std::size_t{from_.width} * from_.height * to_.point_step; }
  /// Returns true if points are copied without changes.
  bool copies() const { return steps_.empty(); }

  /// Converts `cloud`, whose layout must be layout(), to `out`, which must have size() bytes.
  /// Returns false if `cloud` has no RowStride().
  bool Convert(const PointCloud2& cloud, std::uint8_t* out) const;

  static constexpr std::size_t kMaxSize = std::size_t{1} << 30;  // limit for clouds in caps

 private:
  /// Adjacent bytes that are copied, or a number whose type or byte order changes.
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
