// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads livox_ros_driver2/msg/CustomMsg.
#include "src/base/byte_writer.h"
#include "src/cdr/cdr_reader.h"
#include "src/cdr/point_cloud2.h"

namespace lidar::cdr {
namespace {

// The size of a point without padding.
constexpr std::size_t kSmallestPoint = 19;
constexpr std::uint32_t kPointStep = 26;
constexpr std::uint8_t kRosU8 = 2;
constexpr std::uint8_t kRosF32 = 7;
constexpr std::uint8_t kRosF64 = 8;

std::vector<RosField> LivoxFields() {
  return {{"x", 0, kRosF32, 1},          {"y", 4, kRosF32, 1},   {"z", 8, kRosF32, 1},
          {"intensity", 12, kRosF32, 1}, {"tag", 16, kRosU8, 1}, {"line", 17, kRosU8, 1},
          {"timestamp", 18, kRosF64, 1}};
}

void CopyPoint(std::uint64_t timebase, CdrReader* r, ByteWriter* w) {
  const std::uint32_t offset = r->U32();
  for (int axis = 0; axis < 3; ++axis) w->LeF32(r->F32());
  w->LeF32(static_cast<float>(r->U8()));
  w->U8(r->U8());
  w->U8(r->U8());
  w->LeF64(static_cast<double>(timebase + offset));
}

}  // namespace

std::optional<MadeCloud> ReadLivox(ByteView message, std::string* why) {
  CdrReader r(message);
  MadeCloud made;
  RosLayout& layout = made.cloud.layout;
  made.cloud.header = ReadHeader(&r);
  const std::uint64_t timebase = r.U64();
  r.U32();     // number of points, which is also the length of the sequence
  r.Bytes(4);  // number of the sensor, and reserved bytes
  layout.width = r.Count(kSmallestPoint);
  layout.fields = LivoxFields();
  layout.point_step = kPointStep;
  layout.row_step = kPointStep * layout.width;
  made.cloud.is_dense = true;
  made.points.reserve(layout.row_step);
  ByteWriter w(&made.points);
  for (std::uint32_t i = 0; i < layout.width && r.ok(); ++i) CopyPoint(timebase, &r, &w);
  made.cloud.data = {made.points.data(), made.points.size()};
  if (r.ok()) return made;
  if (why != nullptr) *why = "the message is truncated or is not a CustomMsg of Livox";
  return std::nullopt;
}

}  // namespace lidar::cdr
