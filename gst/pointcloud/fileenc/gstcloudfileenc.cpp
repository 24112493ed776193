// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-pcdenc
 * SECTION:element-plyenc
 *
 * Makes each cloud a PCD or PLY file, which multifilesink writes.
 *
 * |[
 * gst-launch-1.0 lidartestsrc slices-per-scan=1 num-buffers=3 ! pcdenc \
 *   ! multifilesink location=scan%06d.pcd
 * ]|
 */
#include <gst/gst.h>

#include <gst/base/gstbasetransform.h>

#include <mutex>
#include <optional>

#include "gst/common/buffer_map.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/common/refused_caps.h"
#include "gst/lidar/gstlidar.h"
#include "gst/pointcloud/fileenc/cloud_file_writer.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_cloud_file_enc_debug);
#define GST_CAT_DEFAULT gst_lidar_cloud_file_enc_debug

namespace {

using namespace lidar::gst;

constexpr PadRow kSink{"sink", GST_PAD_SINK, GST_LIDAR_CLOUD_MEDIA_TYPE};

struct Settings {
  bool binary = true;
};

const std::array<Property<Settings>, 1> kProperties = {{
    {"binary", "Write numbers as little-endian binary; false: as text", &Settings::binary, 0, 0,
     GST_PARAM_MUTABLE_PLAYING},
}};

struct State {
  std::mutex mutex;  // guards the settings
  Settings settings;
  // The members below are used by the streaming thread only.
  std::optional<CloudInfo> info;
  RefusedCaps refused;
  bool slices_reported = false;
};

}  // namespace

/// The base class of the elements. Its subclasses differ in the file format that they write.
struct GstLidarCloudFileEnc {
  GstBaseTransform parent;
  State* state;
};
struct GstLidarCloudFileEncClass {
  GstBaseTransformClass parent;
  std::string (*write)(const CloudFileInput& cloud);
};
using GstLidarPcdEnc = GstLidarCloudFileEnc;
using GstLidarPcdEncClass = GstLidarCloudFileEncClass;
using GstLidarPlyEnc = GstLidarCloudFileEnc;
using GstLidarPlyEncClass = GstLidarCloudFileEncClass;

static GType gst_lidar_cloud_file_enc_get_type();
static GType gst_lidar_pcd_enc_get_type();
static GType gst_lidar_ply_enc_get_type();
G_DEFINE_ABSTRACT_TYPE(GstLidarCloudFileEnc, gst_lidar_cloud_file_enc, GST_TYPE_BASE_TRANSFORM)
G_DEFINE_TYPE(GstLidarPcdEnc, gst_lidar_pcd_enc, gst_lidar_cloud_file_enc_get_type())
G_DEFINE_TYPE(GstLidarPlyEnc, gst_lidar_ply_enc, gst_lidar_cloud_file_enc_get_type())
GST_ELEMENT_REGISTER_DEFINE(pcdenc, "pcdenc", GST_RANK_NONE, gst_lidar_pcd_enc_get_type())
GST_ELEMENT_REGISTER_DEFINE(plyenc, "plyenc", GST_RANK_NONE, gst_lidar_ply_enc_get_type())

static State& StateOf(gpointer self) { return *static_cast<GstLidarCloudFileEnc*>(self)->state; }

static GstCaps* TransformCaps(GstBaseTransform* base, GstPadDirection direction, GstCaps*,
                              GstCaps* filter) {
  GstPad* other = direction == GST_PAD_SINK ? base->srcpad : base->sinkpad;
  const CapsPtr caps(gst_pad_get_pad_template_caps(other));
  if (filter == nullptr) return gst_caps_ref(caps.get());
  return gst_caps_intersect_full(filter, caps.get(), GST_CAPS_INTERSECT_FIRST);
}

static gboolean SetCaps(GstBaseTransform* base, GstCaps* in, GstCaps*) {
  State& state = StateOf(base);
  std::string why;
  state.info = CloudInfo::FromFrameCaps(in, &why);
  if (state.info) {
    state.refused.Reset();
    return TRUE;
  }
  if (state.refused.Note(in))
    GST_ELEMENT_ERROR(base, STREAM, FORMAT, ("The caps do not describe a cloud: %s.", why.c_str()),
                      ("%" GST_PTR_FORMAT, static_cast<gpointer>(in)));
  return FALSE;
}

/// Warns if slices arrive, because then each slice becomes a file, which is rarely wanted.
static void ReportSlices(GstBaseTransform* base, GstBuffer* in) {
  State& state = StateOf(base);
  GstLidarSlice slice{};
  if (state.slices_reported || !gst_lidar_buffer_get_slice(in, &slice) || slice.slice_count < 2)
    return;
  state.slices_reported = true;
  GST_ELEMENT_WARNING(
      base, STREAM, FORMAT,
      ("Slices arrive instead of whole scans, so each scan becomes %u files.", slice.slice_count),
      ("Put scanassembler in front, or set slices-per-scan=1 at the source."));
}

static std::string Write(GstBaseTransform* base, GstBuffer* in) {
  State& state = StateOf(base);
  ReportSlices(base, in);
  const BufferMap map(in, GST_MAP_READ);
  if (!map || map.size() != state.info->FrameSize()) return "";
  CloudFileInput cloud{&*state.info, map.data(), std::nullopt, true};
  const GstClockTime capture = gst_lidar_buffer_get_capture_time(in);
  if (GST_CLOCK_TIME_IS_VALID(capture)) cloud.capture_time = capture;
  {
    std::lock_guard lock(state.mutex);
    cloud.binary = state.settings.binary;
  }
  return reinterpret_cast<GstLidarCloudFileEncClass*>(G_OBJECT_GET_CLASS(base))->write(cloud);
}

/// Creates the output buffer with its content, because the size of the file is not known before it
/// is written.
static GstFlowReturn PrepareOutput(GstBaseTransform* base, GstBuffer* in, GstBuffer** out) {
  auto text = std::make_unique<std::string>(Write(base, in));
  if (text->empty()) {
    GST_ELEMENT_ERROR(
        base, STREAM, FORMAT, ("A buffer does not match its caps."),
        ("it has %" G_GSIZE_FORMAT " bytes, but the caps describe a cloud of %" G_GSIZE_FORMAT,
         gst_buffer_get_size(in), StateOf(base).info->FrameSize()));
    return GST_FLOW_ERROR;
  }
  std::string* owned = text.release();
  *out = gst_buffer_new_wrapped_full(GST_MEMORY_FLAG_READONLY, owned->data(), owned->size(), 0,
                                     owned->size(), owned,
                                     [](gpointer p) { delete static_cast<std::string*>(p); });
  CopyMetadata(*out, in);
  return GST_FLOW_OK;
}

static gboolean Stop(GstBaseTransform* base) {
  State& state = StateOf(base);
  state.info.reset();
  state.refused.Reset();
  state.slices_reported = false;
  return TRUE;
}

static void gst_lidar_cloud_file_enc_init(GstLidarCloudFileEnc* self) { self->state = new State; }

static void gst_lidar_cloud_file_enc_class_init(GstLidarCloudFileEncClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_cloud_file_enc_debug, "cloudfileenc", 0,
                          "Point clouds as files");
  ServeState<GstLidarCloudFileEnc, gst_lidar_cloud_file_enc_parent_class, kProperties>(klass);
  gst_type_mark_as_plugin_api(gst_lidar_cloud_file_enc_get_type(), {});
  auto* transform = GST_BASE_TRANSFORM_CLASS(klass);
  transform->transform_caps = TransformCaps;
  transform->set_caps = SetCaps;
  transform->prepare_output_buffer = PrepareOutput;
  transform->transform = [](GstBaseTransform*, GstBuffer*, GstBuffer*) { return GST_FLOW_OK; };
  transform->stop = Stop;
}

static void gst_lidar_pcd_enc_init(GstLidarPcdEnc*) {}

static void gst_lidar_pcd_enc_class_init(GstLidarPcdEncClass* klass) {
  klass->write = WritePcd;
  Describe(klass,
           {"PCD encoder", "Codec/Encoder/PointCloud",
            "Writes each cloud as a file of the Point Cloud Library"},
           {kSink, {"src", GST_PAD_SRC, "application/x-pcd"}});
}

static void gst_lidar_ply_enc_init(GstLidarPlyEnc*) {}

static void gst_lidar_ply_enc_class_init(GstLidarPlyEncClass* klass) {
  klass->write = WritePly;
  Describe(klass, {"PLY encoder", "Codec/Encoder/PointCloud", "Writes each cloud as a PLY file"},
           {kSink, {"src", GST_PAD_SRC, "application/x-ply"}});
}
