// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes the data of channels as protobuf: clouds, video, poses and transforms.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"

namespace lidar::foxglove {

/// The frame and the time of an observation.
struct Header {
  std::uint64_t unix_ns = 0;
  std::string frame_id;
};

struct Pose {
  std::array<double, 3> position{};               // x, y, z [m]
  std::array<double, 4> orientation{0, 0, 0, 1};  // unit quaternion x, y, z, w
};

/// A view of points in memory.
struct PointsView {
  const PointFields& fields;
  std::uint32_t point_step = 0;  // bytes
  std::uint32_t width = 0;       // points per row
  std::uint32_t height = 1;      // number of rows; several rows are beams
  ByteView data;                 // width * height points, row-major
};

struct EncodedCloud {
  std::vector<std::uint8_t> message;
  std::uint32_t points = 0;
};

/// Encodes a foxglove.PointCloud. It contains only returns, which are points that are finite and
/// not all zero. If there are more than `max_points` returns, it contains only every n-th return
/// (0: no limit). The position of a point in the message does not show its beam. Points of an
/// organised cloud therefore get a field `ring` with the number of their beam, unless they have
/// this field already. `points` must have x, y and z as adjacent F32.
EncodedCloud EncodePointCloud(const Header& header, const PointsView& points,
                              std::uint32_t max_points);
/// Encodes a foxglove.CompressedPointCloud that contains a Draco file.
std::vector<std::uint8_t> EncodeDracoCloud(const Header& header, ByteView draco);
/// Encodes a foxglove.CompressedVideo that contains one frame. `format` is "h264" (Annex B) or
/// "vp8".
std::vector<std::uint8_t> EncodeVideo(const Header& header, ByteView frame, const char* format);
/// Encodes a foxglove.PoseInFrame.
std::vector<std::uint8_t> EncodePose(const Header& header, const Pose& pose);
/// Encodes a foxglove.FrameTransform. `pose` is the pose of `child` in the frame of `header`.
std::vector<std::uint8_t> EncodeTransform(const Header& header, const std::string& child,
                                          const Pose& pose);

}  // namespace lidar::foxglove
