// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/gstlidarcloudinfo.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "gst/lidar/cloud_info.h"

namespace {

/// Calls `use` with a value of the C++ type that corresponds to `type`.
template <class Use>
auto WithType(GstLidarFieldType type, Use use) {
  switch (type) {
    case GST_LIDAR_FIELD_I8:
      return use(gint8{});
    case GST_LIDAR_FIELD_U8:
      return use(guint8{});
    case GST_LIDAR_FIELD_I16:
      return use(gint16{});
    case GST_LIDAR_FIELD_U16:
      return use(guint16{});
    case GST_LIDAR_FIELD_I32:
      return use(gint32{});
    case GST_LIDAR_FIELD_U32:
      return use(guint32{});
    case GST_LIDAR_FIELD_F32:
      return use(gfloat{});
    case GST_LIDAR_FIELD_F64:
      break;
  }
  return use(gdouble{});
}

template <class T>
T Limited(gdouble value) {
  if constexpr (std::numeric_limits<T>::is_integer) {
    using Limits = std::numeric_limits<T>;
    if (std::isnan(value)) return 0;
    if (value <= static_cast<gdouble>(Limits::min())) return Limits::min();
    if (value >= static_cast<gdouble>(Limits::max())) return Limits::max();
    return static_cast<T>(std::nearbyint(value));
  } else {
    return static_cast<T>(value);
  }
}

}  // namespace

gboolean gst_lidar_cloud_info_from_caps(GstLidarCloudInfo* info, const GstCaps* caps) {
  *info = {};
  const auto parsed = lidar::gst::CloudInfo::FromFrameCaps(caps);
  if (!parsed) return FALSE;
  info->width = parsed->width;
  info->height = parsed->height;
  info->point_step = parsed->point_step;
  info->is_dense = parsed->is_dense;
  info->framerate_n = parsed->framerate_n;
  info->framerate_d = parsed->framerate_d;
  for (const lidar::PointField& field : parsed->fields.all()) {
    GstLidarField& out = info->fields[info->n_fields++];
    g_strlcpy(out.name, field.name.c_str(), sizeof out.name);
    out.type = static_cast<GstLidarFieldType>(field.type);  // the enums have the same order
    out.offset = field.offset;
  }
  return TRUE;
}

const GstLidarField* gst_lidar_cloud_info_find(const GstLidarCloudInfo* info, const gchar* name) {
  for (guint i = 0; i < info->n_fields; ++i)
    if (std::strcmp(info->fields[i].name, name) == 0) return &info->fields[i];
  return nullptr;
}

gboolean gst_lidar_cloud_map(GstLidarCloud* cloud, const GstLidarCloudInfo* info, GstBuffer* buffer,
                             GstMapFlags flags) {
  *cloud = {};
  if (!gst_buffer_map(buffer, &cloud->map, flags)) return FALSE;
  const gsize points = gsize{info->width} * info->height;
  if (cloud->map.size != points * info->point_step) {
    gst_buffer_unmap(buffer, &cloud->map);
    return FALSE;
  }
  cloud->info = *info;
  cloud->data = cloud->map.data;
  cloud->n_points = points;
  cloud->buffer = buffer;
  return TRUE;
}

void gst_lidar_cloud_unmap(GstLidarCloud* cloud) {
  if (cloud->buffer != nullptr) gst_buffer_unmap(cloud->buffer, &cloud->map);
  *cloud = {};
}

gdouble gst_lidar_cloud_get(const GstLidarCloud* cloud, const GstLidarField* field, gsize index) {
  const guint8* at = cloud->data + index * cloud->info.point_step + field->offset;
  return WithType(field->type, [at](auto value) {
    std::memcpy(&value, at, sizeof value);
    return static_cast<gdouble>(value);
  });
}

void gst_lidar_cloud_set(GstLidarCloud* cloud, const GstLidarField* field, gsize index,
                         gdouble value) {
  guint8* at = cloud->data + index * cloud->info.point_step + field->offset;
  WithType(field->type, [at, value](auto type) {
    const auto stored = Limited<decltype(type)>(value);
    std::memcpy(at, &stored, sizeof stored);
  });
}
