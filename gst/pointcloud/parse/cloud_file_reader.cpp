// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/parse/cloud_file_reader.h"

#include <algorithm>

#include "gst/common/buffer_map.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/point_cloud2.h"

namespace lidar::gst {
namespace {

struct FileKind {
  CloudFileType type;
  const char* name;
  const char* media_type;  // NULL: not registered with typefind, because the files have no header
  const char* extension;
};
constexpr FileKind kFileKinds[] = {{CloudFileType::kPcd, "PCD", "application/x-pcd", "pcd"},
                                   {CloudFileType::kPly, "PLY", "application/x-ply", "ply"},
                                   {CloudFileType::kLas, "LAS", "application/vnd.las", "las"},
                                   {CloudFileType::kKitti, "KITTI", nullptr, nullptr}};

/// Returns the layout of the file's points in the form of ROS messages, which the converter needs.
cdr::RosLayout LayoutOf(const FileCloud& file) {
  cdr::RosLayout layout;
  layout.width = file.width;
  layout.height = file.height;
  layout.point_step = file.point_step;
  layout.row_step = file.point_step * file.width;
  layout.is_bigendian = file.is_bigendian;
  for (const PointField& f : file.fields)
    layout.fields.push_back(
        {f.name, f.offset, static_cast<std::uint8_t>(static_cast<int>(f.type) + 1), 1});
  return layout;
}

void Find(GstTypeFind* find, gpointer user_data) {
  const auto& wanted = *static_cast<const FileKind*>(user_data);
  guint64 length = gst_type_find_get_length(find);
  if (length == 0) length = 512;
  // A short file has fewer bytes than the first size, so smaller sizes are tried, too.
  for (guint size : {512U, 64U, 8U}) {
    if (size > length) continue;
    const guint8* data = gst_type_find_peek(find, 0, size);
    if (data == nullptr) continue;
    const auto type = TypeOfCloudFile({data, size});
    if (type != wanted.type) return;
    const CapsPtr caps(gst_caps_new_empty_simple(wanted.media_type));
    return gst_type_find_suggest(find, GST_TYPE_FIND_MAXIMUM, caps.get());
  }
}

}  // namespace

std::optional<CloudFileType> CloudFileTypeOf(const GstCaps* caps) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  for (const FileKind& kind : kFileKinds)
    if (kind.media_type != nullptr && gst_structure_has_name(s, kind.media_type)) return kind.type;
  return std::nullopt;
}

const char* NameOf(CloudFileType type) {
  for (const FileKind& kind : kFileKinds)
    if (kind.type == type) return kind.name;
  return "";
}

std::optional<FileBuffer> ReadCloudFile(CloudFileType type, ByteView file, std::string* why) {
  const auto cloud = ReadCloud(type, file, why);
  if (!cloud) return std::nullopt;
  FileBuffer read;
  read.info.width = cloud->width;
  read.info.height = cloud->height;
  cdr::PointCloud2 message;
  message.layout = LayoutOf(*cloud);
  message.data = {cloud->points.data(), cloud->points.size()};
  const auto converter = cdr::PointConverter::Make(message.layout, {}, why);
  if (!converter) return std::nullopt;
  read.info.fields = converter->points().fields;
  read.info.point_step = converter->points().point_step;
  read.buffer.reset(gst_buffer_new_allocate(nullptr, converter->size(), nullptr));
  if (converter->size() > 0) {
    BufferMap map(read.buffer.get(), GST_MAP_WRITE);
    if (!map) return std::nullopt;
    std::fill(map.data(), map.data() + map.size(), guint8{0});  // fills gaps between fields
    *why = "its points do not fit its header";
    if (!converter->Convert(message, map.data())) return std::nullopt;
  }
  if (cloud->capture_time)
    gst_lidar_buffer_set_capture_time(read.buffer.get(), *cloud->capture_time);
  return read;
}

gboolean RegisterCloudFileTypes(GstPlugin* plugin) {
  bool registered = true;
  for (const FileKind& kind : kFileKinds) {
    if (kind.media_type == nullptr) continue;
    const CapsPtr caps(gst_caps_new_empty_simple(kind.media_type));
    registered =
        gst_type_find_register(plugin, kind.media_type, GST_RANK_SECONDARY, Find, kind.extension,
                               caps.get(), const_cast<FileKind*>(&kind), nullptr) &&
        registered;
  }
  return registered;
}

}  // namespace lidar::gst
