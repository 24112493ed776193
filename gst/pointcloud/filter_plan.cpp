// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/filter_plan.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/coordinate_frames.h"
#include "gst/lidar/gstlidar.h"

namespace lidar::gst {
namespace {

/// Parses caps of either byte order. CloudInfo accepts only little-endian caps, so the byte order
/// is returned in `big_endian`.
std::optional<CloudInfo> ParseCaps(const GstCaps* caps, bool* big_endian, std::string* why) {
  const CapsPtr copy(gst_caps_copy(caps));
  gboolean flag = FALSE;
  gst_structure_get_boolean(gst_caps_get_structure(caps, 0), "is-bigendian", &flag);
  *big_endian = flag != FALSE;
  gst_caps_set_simple(copy.get(), "is-bigendian", G_TYPE_BOOLEAN, FALSE, nullptr);
  return CloudInfo::FromFrameCaps(copy.get(), why);
}

/// Parses names such as "x,y,z,intensity", or names with types such as "x:F32,intensity:U8". The
/// fields of the result are packed. Offsets, which caps have after the types, are ignored.
std::optional<cdr::PointLayout> ParseWanted(const std::string& text, const PointFields& given,
                                            std::string* why) {
  std::istringstream in(text);
  cdr::PointLayout layout;
  for (std::string word; std::getline(in, word, ',');) {
    const std::size_t colon = word.find(':');
    const std::string name = word.substr(0, colon);
    const PointField* field = given.Find(name);
    if (field == nullptr) {
      *why = "there is no field " + name + "; the cloud has " + given.ToString();
      return std::nullopt;
    }
    // Coordinates are F32 unless another type is requested, because all elements accept F32.
    const bool is_axis = name == "x" || name == "y" || name == "z";
    FieldType type = is_axis ? FieldType::kF32 : field->type;
    if (colon != std::string::npos) {
      const std::string type_name = word.substr(colon + 1, word.find(':', colon + 1) - colon - 1);
      const auto parsed = PointFields::Parse(name + ":" + type_name + ":0", why);
      if (!parsed) return std::nullopt;
      type = parsed->all()[0].type;
    }
    if (layout.fields.Find(name) != nullptr) {
      *why = "there are two fields " + name;
      return std::nullopt;
    }
    layout.fields.Add(name, type);
  }
  layout.point_step = layout.fields.MinimumStep();
  return layout;
}

std::optional<PointFilterSettings> ParseSettings(const FilterSettings& s, std::string* why) {
  PointFilterSettings parsed;
  parsed.beam_step = s.beam_step;
  parsed.column_step = s.column_step;
  parsed.min_range_m = s.min_range;
  parsed.max_range_m = s.max_range;
  parsed.voxel_size_m = s.voxel_size;
  parsed.crop_inside = s.crop_inside;
  parsed.invalid = s.invalid;
  *why = "apply-pose and target-frame cannot be set together";
  if (s.apply_pose && !s.target_frame.empty()) return std::nullopt;
  parsed.has_pose = s.apply_pose || !s.target_frame.empty();
  if (!s.transform.empty()) {
    parsed.transform = ParseTransform(s.transform);
    *why = "transform must be 16 numbers, or x, y, z, roll, pitch, yaw";
    if (!parsed.transform) return std::nullopt;
  }
  if (!s.crop_box.empty()) {
    const auto box = ParseNumbers(s.crop_box);
    *why = "crop-box must be six numbers: the least x, y, z, then the largest";
    if (!box || box->size() != 6) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i)
      if ((*box)[i] > (*box)[i + 3]) return std::nullopt;
    parsed.crop_box.emplace();
    std::copy(box->begin(), box->end(), parsed.crop_box->begin());
  }
  return parsed;
}

std::optional<Transform> PoseOf(GstBuffer* buffer) {
  GstLidarPose pose{};
  if (!gst_lidar_buffer_get_pose(buffer, &pose)) return std::nullopt;
  const double* p = pose.position;
  const double* q = pose.orientation;
  return FromPose({p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]});
}

/// Returns the frame of the clouds, from the settings or else from the caps.
std::string FrameOf(const FilterSettings& settings, const GstCaps* caps) {
  if (!settings.frame_id.empty()) return settings.frame_id;
  return FrameIn(gst_caps_get_structure(caps, 0), GST_LIDAR_FRAME_ID);
}

/// Removes the pose from a buffer whose points have been moved by it. Otherwise the next element
/// would move them again.
void DropPose(GstBuffer* buffer) {
  GstCustomMeta* meta = gst_buffer_get_custom_meta(buffer, GST_LIDAR_POSE_META_NAME);
  if (meta != nullptr) gst_buffer_remove_meta(buffer, &meta->meta);
}

/// Keeps the sensor model, reduced to the remaining beams, if it still describes the positions of
/// the points. Otherwise removes the model.
void KeepModel(const PointFilterSettings& s, CloudInfo* out) {
  if (!out->sensor_model) return;
  if (s.has_pose || s.transform || s.column_step > 1 || s.invalid == InvalidPoints::kRemove) {
    out->sensor_model.reset();
    return;
  }
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < out->sensor_model->beams.size(); i += s.beam_step)
    beams.push_back(out->sensor_model->beams[i]);
  out->sensor_model->beams = std::move(beams);
}

}  // namespace

std::unique_ptr<FilterPlan> FilterPlan::Make(const FilterSettings& settings, const GstCaps* caps,
                                             std::string* why) {
  bool big_endian = false;
  const auto info = ParseCaps(caps, &big_endian, why);
  if (!info) return nullptr;
  const auto parsed = ParseSettings(settings, why);
  if (!parsed) return nullptr;
  std::optional<cdr::PointLayout> wanted;
  if (!settings.fields.empty()) {
    wanted = ParseWanted(settings.fields, info->fields, why);
    if (!wanted) return nullptr;
  }
  auto plan = std::make_unique<FilterPlan>();
  plan->in_ = *info;
  plan->layout_ = cdr::ToRosLayout({info->fields, info->point_step}, info->width, info->height);
  plan->layout_.is_bigendian = big_endian;
  plan->converter_ = cdr::PointConverter::Make(plan->layout_, wanted, why);
  if (!plan->converter_) return nullptr;
  const cdr::PointLayout& points = plan->converter_->points();
  plan->filter_ = PointFilter::Make(*parsed, points.fields, points.point_step);
  if (!plan->filter_) {
    *why = "these settings need x, y and z as F32 side by side, but the fields are " +
           points.fields.ToString();
    return nullptr;
  }
  plan->column_step_ = parsed->column_step;
  plan->apply_pose_ = settings.apply_pose;
  plan->drops_pose_ = settings.apply_pose || !settings.target_frame.empty();
  plan->frame_ = FrameOf(settings, caps);
  if (!parsed->has_pose && !parsed->transform) plan->out_frame_ = plan->frame_;
  if (!parsed->transform && !settings.target_frame.empty())
    plan->out_frame_ = settings.target_frame;
  plan->out_ = *info;
  plan->out_.fields = points.fields;
  plan->out_.point_step = points.point_step;
  if (parsed->invalid == InvalidPoints::kRemove)
    plan->out_.is_dense = true;
  else if (parsed->needs_xyz())
    plan->out_.is_dense = false;
  KeepModel(*parsed, &plan->out_);
  return plan;
}

void FilterPlan::Describe(const FilteredCloud& cloud) {
  if (caps_ && out_.width == cloud.width && out_.height == cloud.height) return;
  out_.width = cloud.width;
  out_.height = cloud.height;
  caps_.reset(out_.ToCaps());
  if (!out_frame_.empty())
    gst_caps_set_simple(caps_.get(), GST_LIDAR_FRAME_ID, G_TYPE_STRING, out_frame_.c_str(),
                        nullptr);
}

BufferPtr FilterPlan::Apply(GstBuffer* buffer, const Transform& placed) {
  const BufferMap map(buffer, GST_MAP_READ);
  if (!map || map.size() != in_.FrameSize()) return nullptr;
  const std::optional<Transform> pose = apply_pose_ ? PoseOf(buffer) : placed;
  if (!pose) {
    ++without_pose_;
    return BufferPtr(gst_buffer_new());
  }
  const std::uint8_t* points = map.data();
  if (!converter_->copies()) {
    converted_.assign(converter_->size(), 0);
    cdr::PointCloud2 cloud;
    cloud.layout = layout_;
    cloud.data = map.view();
    if (!converter_->Convert(cloud, converted_.data())) return nullptr;
    points = converted_.data();
  }
  GstLidarSlice slice{};
  const bool is_slice = gst_lidar_buffer_get_slice(buffer, &slice) != FALSE;
  auto owned = std::make_unique<FilteredCloud>(
      filter_->Apply({points, in_.width, in_.height, slice.first_column, *pose}));
  if (owned->points.empty()) return BufferPtr(gst_buffer_new());
  Describe(*owned);
  FilteredCloud* cloud = owned.release();
  BufferPtr out(gst_buffer_new_wrapped_full(
      static_cast<GstMemoryFlags>(0), cloud->points.data(), cloud->points.size(), 0,
      cloud->points.size(), cloud, [](gpointer p) { delete static_cast<FilteredCloud*>(p); }));
  gst_buffer_copy_into(
      out.get(), buffer,
      static_cast<GstBufferCopyFlags>(GST_BUFFER_COPY_FLAGS | GST_BUFFER_COPY_TIMESTAMPS |
                                      GST_BUFFER_COPY_META),
      0, static_cast<gsize>(-1));
  if (drops_pose_) DropPose(out.get());
  if (is_slice && column_step_ > 1) {
    slice.first_column = cloud->first_column;
    gst_lidar_buffer_set_slice(out.get(), &slice);
  }
  return out;
}

}  // namespace lidar::gst
