// SPDX-License-Identifier: LGPL-2.1-or-later
// What channels carry, as protobuf: clouds, video, poses and transforms.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"

namespace lidar::foxglove {

/// Frame and time of an observation.
struct Header {
  std::uint64_t unix_ns = 0;
  std::string frame_id;
};

struct Pose {
  std::array<double, 3> position{};               // x, y, z [m]
  std::array<double, 4> orientation{0, 0, 0, 1};  // unit quaternion x, y, z, w
};

/// Points as they are in memory.
struct PointsView {
  const PointFields& fields;
  std::uint32_t point_step = 0;  // bytes
  std::uint32_t width = 0;       // points of a row
  std::uint32_t height = 1;      // rows, which are beams if there are several
  ByteView data;                 // width * height points, row-major
};

struct EncodedCloud {
  std::vector<std::uint8_t> message;
  std::uint32_t points = 0;
};

/// Makes a foxglove.PointCloud of the returns: points that are finite and not all zero. Keeps every
/// n-th point if there are more than `max_points` (0: no limit). Points of an organised cloud get a
/// field `ring` with their beam's number, unless they have one, because their position in the
/// message no longer gives the beam. `points` has x, y and z as adjacent F32.
EncodedCloud EncodePointCloud(const Header& header, const PointsView& points,
                              std::uint32_t max_points);
/// foxglove.CompressedPointCloud of a Draco file.
std::vector<std::uint8_t> EncodeDracoCloud(const Header& header, ByteView draco);
/// foxglove.CompressedVideo of one frame; `format` is "h264" (Annex B) or "vp8".
std::vector<std::uint8_t> EncodeVideo(const Header& header, ByteView frame, const char* format);
/// foxglove.PoseInFrame.
std::vector<std::uint8_t> EncodePose(const Header& header, const Pose& pose);
/// foxglove.FrameTransform: `pose` is that of `child` in the frame of the header.
std::vector<std::uint8_t> EncodeTransform(const Header& header, const std::string& child,
                                          const Pose& pose);

}  // namespace lidar::foxglove
