// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/foxglove/messages.h"

#include <cmath>

#include "src/foxglove/proto_writer.h"

namespace lidar::foxglove {
namespace {

void WriteTime(ProtoWriter& out, std::uint64_t unix_ns) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  out.Message(1, [&](ProtoWriter& time) {
    time.Varint(1, unix_ns / kSecond);
    time.Varint(2, unix_ns % kSecond);
  });
}

/// Writes a Vector3 or a Quaternion. The fields of both are numbered from 1.
template <std::size_t n>
void WriteNumbers(ProtoWriter& out, std::uint32_t field, const std::array<double, n>& values) {
  out.Message(field, [&](ProtoWriter& w) {
    for (std::uint32_t i = 0; i < n; ++i) w.Double(i + 1, values[i]);
  });
}

void WritePose(ProtoWriter& out, const Pose& pose) {
  out.Message(3, [&](ProtoWriter& w) {
    WriteNumbers(w, 1, pose.position);
    WriteNumbers(w, 2, pose.orientation);
  });
}

/// Returns the value of PackedElementField.NumericType for `type`.
std::uint64_t NumericType(FieldType type) {
  switch (type) {
    case FieldType::kU8:
      return 1;
    case FieldType::kI8:
      return 2;
    case FieldType::kU16:
      return 3;
    case FieldType::kI16:
      return 4;
    case FieldType::kU32:
      return 5;
    case FieldType::kI32:
      return 6;
    case FieldType::kF32:
      return 7;
    case FieldType::kF64:
      return 8;
  }
  return 0;
}

void WriteElement(ProtoWriter& out, const std::string& name, std::uint32_t offset, FieldType type) {
  out.Message(5, [&](ProtoWriter& w) {
    w.String(1, name);
    w.Fixed32(2, offset);
    w.Varint(3, NumericType(type));
  });
}

class CloudPacker {
 public:
  CloudPacker(const PointsView& points, std::uint32_t max_points)
      : points_(points),
        xyz_(points.fields.Find("x")->offset),
        adds_ring_(points.height > 1 && points.fields.Find("ring") == nullptr) {
    for (std::size_t i = 0; i < Size(); ++i) returns_ += IsReturn(At(i));
    if (max_points > 0) every_ = std::max(1U, (returns_ + max_points - 1) / max_points);
  }

  std::uint32_t count() const { return (returns_ + every_ - 1) / every_; }
  std::uint32_t stride() const {
    return points_.point_step + (adds_ring_ ? std::uint32_t{sizeof(std::uint16_t)} : 0);
  }
  bool adds_ring() const { return adds_ring_; }

  void Append(std::vector<std::uint8_t>* out) const {
    const std::size_t start = out->size();
    out->resize(start + std::size_t{count()} * stride());
    std::uint8_t* to = out->data() + start;
    std::uint32_t seen = 0;
    for (std::size_t i = 0; i < Size(); ++i) {
      const std::uint8_t* from = At(i);
      if (!IsReturn(from) || seen++ % every_ != 0) continue;
      std::memcpy(to, from, points_.point_step);
      if (adds_ring_) {
        const std::size_t ring = i / points_.width;
        to[points_.point_step] = static_cast<std::uint8_t>(ring);
        to[points_.point_step + 1] = static_cast<std::uint8_t>(ring >> 8);
      }
      to += stride();
    }
  }

 private:
  std::size_t Size() const { return std::size_t{points_.width} * points_.height; }
  const std::uint8_t* At(std::size_t i) const { return points_.data.data + i * points_.point_step; }
  bool IsReturn(const std::uint8_t* point) const {
    std::array<float, 3> p;
    std::memcpy(p.data(), point + xyz_, sizeof p);
    const float sum = std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]);
    return sum > 0 && std::isfinite(sum);
  }

  const PointsView& points_;
  const std::uint32_t xyz_;
  const bool adds_ring_;
  std::uint32_t returns_ = 0;
  std::uint32_t every_ = 1;
};

}  // namespace

EncodedCloud EncodePointCloud(const Header& header, const PointsView& points,
                              std::uint32_t max_points) {
  const CloudPacker packer(points, max_points);
  EncodedCloud cloud;
  const std::size_t size = std::size_t{packer.count()} * packer.stride();
  constexpr std::size_t kRoomForFields = 2048;
  cloud.message.reserve(size + kRoomForFields);
  ProtoWriter out(&cloud.message);
  WriteTime(out, header.unix_ns);
  out.String(2, header.frame_id);
  WritePose(out, {});
  out.Fixed32(4, packer.stride());
  for (const PointField& field : points.fields.all())
    WriteElement(out, field.name, field.offset, field.type);
  if (packer.adds_ring()) WriteElement(out, "ring", points.point_step, FieldType::kU16);
  out.BeginBytes(6, size);
  packer.Append(&cloud.message);
  cloud.points = packer.count();
  return cloud;
}

std::vector<std::uint8_t> EncodeDracoCloud(const Header& header, ByteView draco) {
  std::vector<std::uint8_t> bytes;
  ProtoWriter out(&bytes);
  WriteTime(out, header.unix_ns);
  out.String(2, header.frame_id);
  WritePose(out, {});
  out.Bytes(4, draco);
  out.String(5, "draco");
  return bytes;
}

std::vector<std::uint8_t> EncodeVideo(const Header& header, ByteView frame, const char* format) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(frame.size + 128);
  ProtoWriter out(&bytes);
  WriteTime(out, header.unix_ns);
  out.String(2, header.frame_id);
  out.Bytes(3, frame);
  out.String(4, format);
  return bytes;
}

std::vector<std::uint8_t> EncodePose(const Header& header, const Pose& pose) {
  std::vector<std::uint8_t> bytes;
  ProtoWriter out(&bytes);
  WriteTime(out, header.unix_ns);
  out.String(2, header.frame_id);
  WritePose(out, pose);
  return bytes;
}

std::vector<std::uint8_t> EncodeTransform(const Header& header, const std::string& child,
                                          const Pose& pose) {
  std::vector<std::uint8_t> bytes;
  ProtoWriter out(&bytes);
  WriteTime(out, header.unix_ns);
  out.String(2, header.frame_id);
  out.String(3, child);
  WriteNumbers(out, 4, pose.position);
  WriteNumbers(out, 5, pose.orientation);
  return bytes;
}

}  // namespace lidar::foxglove
