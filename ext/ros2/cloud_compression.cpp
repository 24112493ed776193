// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ros2/cloud_compression.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>

#ifdef WITH_DRACO
#include "ext/draco/field_codec.h"
#endif

namespace lidar::gst {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kMostBytes = std::size_t{256} << 20;  // limit for a cloud, as for a message
constexpr int kZstdLevel = 1;
constexpr int kZlibLevel = 1;
constexpr int kGzipWindow = 15 + 16;  // zlib's plugin writes gzip
constexpr int kAnyWindow = 15 + 32;   // accepts zlib and gzip
// The largest number of bytes to which one byte of data can decompress.
constexpr std::size_t kZlibMost = 1032;
constexpr std::size_t kZstdMost = std::size_t{1} << 16;

/// The size of the points [bytes]: `least` if there are no gaps between rows, `most` if there are
/// gaps.
struct Bounds {
  std::size_t least, most;
};

std::optional<Bounds> BoundsOf(const cdr::RosLayout& layout) {
  const std::uint64_t row = std::uint64_t{layout.width} * layout.point_step;
  const std::uint64_t height = std::max(layout.height, 1U);
  if (row > kMostBytes || height > kMostBytes || row * height > kMostBytes) return std::nullopt;
  const std::uint64_t most = std::max<std::uint64_t>(row, layout.row_step) * height;
  return Bounds{row * height, std::min<std::uint64_t>(most, kMostBytes)};
}

/// Makes `out` large enough for all points that `data` can contain. Returns false if `data` is too
/// short for the points.
bool MakeRoom(ByteView data, const Bounds& bounds, std::size_t most_per_byte, Bytes* out) {
  const std::size_t most = (data.size + 1) * most_per_byte;
  if (bounds.least > most) return false;
  out->resize(std::min(bounds.most, most));
  return true;
}

bool Inflate(ByteView data, const Bounds& bounds, Bytes* out) {
  if (!MakeRoom(data, bounds, kZlibMost, out)) return false;
  z_stream stream{};
  if (inflateInit2(&stream, kAnyWindow) != Z_OK) return false;
  stream.next_in = const_cast<Bytef*>(data.data);
  stream.avail_in = static_cast<uInt>(data.size);
  stream.next_out = out->data();
  stream.avail_out = static_cast<uInt>(out->size());
  const int result = inflate(&stream, Z_FINISH);
  out->resize(stream.total_out);
  inflateEnd(&stream);
  return result == Z_STREAM_END;
}

bool UnpackZstd(ByteView data, const Bounds& bounds, Bytes* out) {
  if (!MakeRoom(data, bounds, kZstdMost, out)) return false;
  const std::size_t size = ZSTD_decompress(out->data(), out->size(), data.data, data.size);
  if (ZSTD_isError(size) != 0U) return false;
  out->resize(size);
  return true;
}

bool Deflate(ByteView points, Bytes* out) {
  z_stream stream{};
  constexpr int kUsualMemory = 8;
  if (deflateInit2(&stream, kZlibLevel, Z_DEFLATED, kGzipWindow, kUsualMemory,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    return false;
  out->resize(deflateBound(&stream, points.size));
  stream.next_in = const_cast<Bytef*>(points.data);
  stream.avail_in = static_cast<uInt>(points.size);
  stream.next_out = out->data();
  stream.avail_out = static_cast<uInt>(out->size());
  const int result = deflate(&stream, Z_FINISH);
  out->resize(stream.total_out);
  deflateEnd(&stream);
  return result == Z_STREAM_END;
}

bool PackZstd(ByteView points, Bytes* out) {
  out->resize(ZSTD_compressBound(points.size));
  const std::size_t size =
      ZSTD_compress(out->data(), out->size(), points.data, points.size, kZstdLevel);
  if (ZSTD_isError(size) != 0U) return false;
  out->resize(size);
  return true;
}

#ifdef WITH_DRACO
constexpr bool kHasDraco = true;

/// Returns the layout for Draco. Returns nothing if Draco cannot store the layout. Draco stores
/// numbers in the byte order of this machine.
std::optional<draco::FieldLayout> DracoLayoutOf(const cdr::RosLayout& layout) {
  if (layout.is_bigendian) return std::nullopt;
  draco::FieldLayout fields;
  fields.point_step = layout.point_step;
  for (const cdr::RosField& f : layout.fields) {
    if (f.datatype < 1 || f.datatype > 8) return std::nullopt;
    const bool is_position = f.name == "x" || f.name == "y" || f.name == "z";
    fields.fields.push_back(
        {static_cast<FieldType>(f.datatype - 1), f.offset, std::max(f.count, 1U), is_position});
  }
  return fields;
}

/// Decodes the points, and sets the width to their number. The publisher removes duplicate points,
/// and some versions of the publisher do not update the width.
bool UnpackDraco(const cdr::RosLayout& layout, ByteView data, cdr::MadeCloud* made) {
  const auto fields = DracoLayoutOf(layout);
  const std::size_t points = std::size_t{layout.width} * std::max(layout.height, 1U);
  if (!fields ||
      !draco::DecodeFields(data, *fields, static_cast<std::uint32_t>(points), &made->points))
    return false;
  if (made->points.size() == points * layout.point_step) return true;
  made->cloud.layout.height = 1;
  made->cloud.layout.width = static_cast<std::uint32_t>(made->points.size() / layout.point_step);
  return true;
}

bool PackDraco(const cdr::PointCloud2& cloud, Bytes* out) {
  const auto fields = DracoLayoutOf(cloud.layout);
  return fields && draco::EncodeFields(cloud.data, *fields, out);
}
#else
constexpr bool kHasDraco = false;
bool UnpackDraco(const cdr::RosLayout&, ByteView, cdr::MadeCloud*) { return false; }
bool PackDraco(const cdr::PointCloud2&, Bytes*) { return false; }
#endif

bool Unpack(const cdr::CompressedCloud& from, const Bounds& bounds, cdr::MadeCloud* made) {
  if (from.format == NameOf(CloudCompression::kZstd))
    return UnpackZstd(from.cloud.data, bounds, &made->points);
  if (from.format == NameOf(CloudCompression::kZlib))
    return Inflate(from.cloud.data, bounds, &made->points);
  made->cloud.layout.row_step = from.cloud.layout.width * from.cloud.layout.point_step;
  return UnpackDraco(from.cloud.layout, from.cloud.data, made);
}

bool IsKnown(const std::string& format) {
  for (const auto c : {CloudCompression::kDraco, CloudCompression::kZlib, CloudCompression::kZstd})
    if (format == NameOf(c)) return c != CloudCompression::kDraco || kHasDraco;
  return false;
}

}  // namespace

const char* NameOf(CloudCompression compression) {
  constexpr const char* kNames[] = {"draco", "zlib", "zstd"};
  return kNames[static_cast<std::size_t>(compression)];
}

std::optional<cdr::MadeCloud> Decompress(const cdr::CompressedCloud& compressed, std::string* why) {
  *why = "its compression is not draco, zlib or zstd, or support for it was not built";
  if (!IsKnown(compressed.format)) return std::nullopt;
  cdr::MadeCloud made;
  made.cloud = compressed.cloud;
  made.cloud.data = {};
  const auto bounds = BoundsOf(compressed.cloud.layout);
  *why = "width x height x point_step is above 256 MiB";
  if (!bounds) return std::nullopt;
  if (bounds->least == 0) return made;
  *why = "its compressed data are damaged";
  if (!Unpack(compressed, *bounds, &made)) return std::nullopt;
  made.cloud.data = {made.points.data(), made.points.size()};
  return made;
}

std::optional<cdr::CompressedCloud> Compress(CloudCompression compression,
                                             const cdr::PointCloud2& cloud, Bytes* packed) {
  const auto pack = [&] {
    switch (compression) {
      case CloudCompression::kZlib:
        return Deflate(cloud.data, packed);
      case CloudCompression::kZstd:
        return PackZstd(cloud.data, packed);
      case CloudCompression::kDraco:
        break;
    }
    return PackDraco(cloud, packed);
  };
  if (!pack()) return std::nullopt;
  cdr::CompressedCloud compressed{cloud, NameOf(compression)};
  compressed.cloud.data = {packed->data(), packed->size()};
  return compressed;
}

}  // namespace lidar::gst
