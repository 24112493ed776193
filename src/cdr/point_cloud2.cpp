// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/point_cloud2.h"

#include <algorithm>
#include <tuple>

namespace lidar::cdr {
namespace {

// The size of an empty name and three numbers, without padding.
constexpr std::size_t kSmallestField = 13;
// The largest number of fields. It limits the memory for fields, and no driver sends so many.
constexpr std::uint32_t kMaxRosFields = 1024;

auto Tie(const RosField& f) { return std::tie(f.name, f.offset, f.datatype, f.count); }
auto Tie(const RosLayout& l) {
  return std::tie(l.height, l.width, l.fields, l.is_bigendian, l.point_step, l.row_step);
}

std::vector<RosField> ReadFields(CdrReader* r) {
  const std::uint32_t count = r->Count(kSmallestField);
  std::vector<RosField> fields;
  for (std::uint32_t i = 0; i < count && i < kMaxRosFields && r->ok(); ++i) {
    RosField& f = fields.emplace_back();
    f.name = r->Text();
    f.offset = r->U32();
    f.datatype = r->U8();
    f.count = r->U32();
  }
  return count <= kMaxRosFields ? fields : std::vector<RosField>();
}

void WriteFields(const std::vector<RosField>& fields, CdrWriter* w) {
  w->U32(static_cast<std::uint32_t>(fields.size()));
  for (const RosField& f : fields) {
    w->Text(f.name);
    w->U32(f.offset);
    w->U8(f.datatype);
    w->U32(f.count);
  }
}

PointCloud2 ReadCloud(CdrReader* r) {
  PointCloud2 cloud;
  cloud.header = ReadHeader(r);
  cloud.layout.height = r->U32();
  cloud.layout.width = r->U32();
  cloud.layout.fields = ReadFields(r);
  cloud.layout.is_bigendian = r->Bool();
  cloud.layout.point_step = r->U32();
  cloud.layout.row_step = r->U32();
  cloud.data = r->Octets();
  cloud.is_dense = r->Bool();
  return cloud;
}

/// Writes the part of the message that is before the points.
void WriteHead(const PointCloud2& cloud, CdrWriter* w) {
  WriteHeader(cloud.header, w);
  w->U32(cloud.layout.height);
  w->U32(cloud.layout.width);
  WriteFields(cloud.layout.fields, w);
  w->Bool(cloud.layout.is_bigendian);
  w->U32(cloud.layout.point_step);
  w->U32(cloud.layout.row_step);
}

}  // namespace

bool operator==(const RosField& a, const RosField& b) { return Tie(a) == Tie(b); }
bool operator==(const RosLayout& a, const RosLayout& b) { return Tie(a) == Tie(b); }

std::optional<PointCloud2> ReadPointCloud2(ByteView message, std::string* why) {
  CdrReader r(message);
  PointCloud2 cloud = ReadCloud(&r);
  if (r.ok()) return cloud;
  if (why != nullptr) *why = "the message is truncated or is not a PointCloud2";
  return std::nullopt;
}

std::optional<CompressedCloud> ReadCompressedCloud(ByteView message, std::string* why) {
  CdrReader r(message);
  CompressedCloud compressed;
  compressed.cloud = ReadCloud(&r);
  compressed.format = r.Text();
  if (r.ok()) return compressed;
  if (why != nullptr) *why = "the message is truncated or is not a CompressedPointCloud2";
  return std::nullopt;
}

std::optional<std::size_t> RowStride(const PointCloud2& cloud) {
  const RosLayout& l = cloud.layout;
  const std::size_t height = std::max<std::size_t>(l.height, 1);
  if (cloud.data.size % height != 0) return std::nullopt;
  const std::size_t stride = cloud.data.size / height;
  const std::uint64_t row = std::uint64_t{l.width} * l.point_step;
  if (stride == row || (stride > row && stride == l.row_step)) return stride;
  return std::nullopt;
}

PointCloud2Frame FramePointCloud2(const PointCloud2& cloud) {
  PointCloud2Frame frame;
  CdrWriter w(&frame.head);
  WriteHead(cloud, &w);
  w.U32(static_cast<std::uint32_t>(cloud.data.size));
  frame.tail.push_back(cloud.is_dense ? 1 : 0);
  return frame;
}

std::vector<std::uint8_t> WritePointCloud2(const PointCloud2& cloud) {
  PointCloud2Frame frame = FramePointCloud2(cloud);
  std::vector<std::uint8_t> out = std::move(frame.head);
  out.reserve(out.size() + cloud.data.size + frame.tail.size());
  out.insert(out.end(), cloud.data.begin(), cloud.data.end());
  out.insert(out.end(), frame.tail.begin(), frame.tail.end());
  return out;
}

std::vector<std::uint8_t> WriteCompressedCloud(const CompressedCloud& compressed) {
  std::vector<std::uint8_t> out;
  CdrWriter w(&out);
  WriteHead(compressed.cloud, &w);
  w.Octets(compressed.cloud.data);
  w.Bool(compressed.cloud.is_dense);
  w.Text(compressed.format);
  return out;
}

RosLayout ToRosLayout(const PointLayout& points, std::uint32_t width, std::uint32_t height) {
  RosLayout layout;
  layout.height = height;
  layout.width = width;
  layout.point_step = points.point_step;
  layout.row_step = width * points.point_step;
  std::string array;  // name without [0] if the last field began an array
  for (const PointField& f : points.fields.all()) {
    const auto datatype = static_cast<std::uint8_t>(static_cast<int>(f.type) + 1);
    RosField* last = layout.fields.empty() ? nullptr : &layout.fields.back();
    if (last != nullptr && !array.empty() && datatype == last->datatype &&
        f.name == array + "[" + std::to_string(last->count) + "]" &&
        f.offset == last->offset + last->count * SizeOf(f.type)) {
      last->name = array;
      ++last->count;
      continue;
    }
    layout.fields.push_back({f.name, f.offset, datatype, 1});
    const std::size_t index = f.name.rfind("[0]");
    const bool begins = index != std::string::npos && index + 3 == f.name.size();
    array = begins ? f.name.substr(0, index) : std::string();
  }
  return layout;
}

}  // namespace lidar::cdr
