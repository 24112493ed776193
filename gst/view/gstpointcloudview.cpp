// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-pointcloudview
 *
 * Draws point clouds as video, for any video sink, encoder or pngenc.
 *
 * |[
 * gst-launch-1.0 lidartestsrc is-live=true ! pointcloudview ! videoconvert ! autovideosink
 * ]|
 */
#include <gst/base/gstbasetransform.h>

#include <gst/video/video.h>

#include <memory>
#include <mutex>

#include "gst/common/buffer_map.h"
#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/common/refused_caps.h"
#include "gst/view/renderer.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_point_cloud_view_debug);
#define GST_CAT_DEFAULT gst_lidar_point_cloud_view_debug

#define VIDEO_FORMATS "{ RGBx, BGRx, RGB, BGR, RGBA, BGRA }"

namespace {

using namespace lidar::gst;

const GEnumValue kViews[] = {{0, "From above, x to the right", "top"},
                             {1, "As from behind the sensor", "perspective"},
                             {2, "The range image of the sensor, forward in the middle", "range"},
                             {0, nullptr, nullptr}};
const GEnumValue kColors[] = {{0, "z", "height"},
                              {1, "Intensity, reflectivity or signal", "intensity"},
                              {2, "Distance", "range"},
                              {3, "Number of the beam", "ring"},
                              {0, nullptr, nullptr}};

GType ViewType() {
  static const GType type = RegisterEnum("GstLidarPointCloudViewView", kViews);
  return type;
}
GType ColorType() {
  static const GType type = RegisterEnum("GstLidarPointCloudViewColor", kColors);
  return type;
}

struct Settings {
  gint view = 1;
  gint color_by = 0;
  bool map = false;
  guint width = 1280;
  guint height = 720;
  gdouble extent_m = 100;
  gdouble eye_x = -16;
  gdouble eye_y = 0;
  gdouble eye_z = 9;
  gdouble target_x = 12;
  gdouble target_y = 0;
  gdouble target_z = -2;
  gdouble field_of_view = 70;
  guint point_size = 0;
  gdouble color_min = 0;
  gdouble color_max = 0;
};

using Row = Property<Settings>;
constexpr gdouble kFar = 10'000;
constexpr gint kAnytime = GST_PARAM_MUTABLE_PLAYING;
const std::array<Row, 16> kProperties = {{
    {"view", "Projection of the cloud", EnumField<Settings>{&Settings::view, ViewType}, 0, 0,
     kAnytime},
    {"color-by", "Quantity that the colours show",
     EnumField<Settings>{&Settings::color_by, ColorType}, 0, 0, kAnytime},
    {"map",
     "Draw clouds over the map that earlier clouds make by their poses, with the route (see "
     "lidarodometry)",
     &Settings::map, 0, 0, kAnytime},
    {"width", "Width of the video unless downstream fixes it [pixels]", &Settings::width, 16, 8192},
    {"height", "Height of the video unless downstream fixes it [pixels]", &Settings::height, 16,
     8192},
    {"extent", "Width of the picture from above [m]", &Settings::extent_m, 1, kFar, kAnytime},
    {"eye-x", "Position of the camera in the sensor frame, forward [m]", &Settings::eye_x, -kFar,
     kFar, kAnytime},
    {"eye-y", "Position of the camera in the sensor frame, left [m]", &Settings::eye_y, -kFar, kFar,
     kAnytime},
    {"eye-z", "Position of the camera in the sensor frame, up [m]", &Settings::eye_z, -kFar, kFar,
     kAnytime},
    {"target-x", "Point that the camera looks at, forward [m]", &Settings::target_x, -kFar, kFar,
     kAnytime},
    {"target-y", "Point that the camera looks at, left [m]", &Settings::target_y, -kFar, kFar,
     kAnytime},
    {"target-z", "Point that the camera looks at, up [m]", &Settings::target_z, -kFar, kFar,
     kAnytime},
    {"field-of-view", "Horizontal field of view of the camera [degrees]", &Settings::field_of_view,
     5, 150, kAnytime},
    {"point-size", "Size of a point [pixels]; 0: by its distance", &Settings::point_size, 0, 64,
     kAnytime},
    {"color-min", "Value of the first colour [m, or the unit of the field]", &Settings::color_min,
     -kFar, kFar, kAnytime},
    {"color-max", "Value of the last colour; not above color-min: automatic", &Settings::color_max,
     -kFar, kFar, kAnytime},
}};

struct State {
  std::mutex mutex;  // guards the settings and `changed`
  Settings settings;
  bool changed = true;
  // Only the streaming thread uses the members below.
  std::optional<CloudInfo> info;
  RefusedCaps refused;
  GstVideoInfo video;
  std::optional<TrailMap> map;
  gint map_colors = 0;  // the value of color_by with which the map was made
  std::unique_ptr<Renderer> renderer;
  bool warned_no_pose = false;
  bool drawing = false;  // a picture was begun
  guint scan_id = 0;
  GstClockTime pts = GST_CLOCK_TIME_NONE;  // PTS of that scan
  GstClockTime capture_time = GST_CLOCK_TIME_NONE;
};

ViewSettings ToView(const Settings& s) {
  const auto f = [](gdouble v) { return static_cast<float>(v); };
  ViewSettings view;
  view.view = static_cast<ViewKind>(s.view);
  view.color_by = static_cast<ColorBy>(s.color_by);
  view.extent_m = f(s.extent_m);
  view.eye_m = {f(s.eye_x), f(s.eye_y), f(s.eye_z)};
  view.target_m = {f(s.target_x), f(s.target_y), f(s.target_z)};
  view.field_of_view_deg = f(s.field_of_view);
  view.point_size = static_cast<int>(s.point_size);
  view.color_min = f(s.color_min);
  view.color_max = f(s.color_max);
  return view;
}

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarPointCloudView, gst_lidar_point_cloud_view, GST,
                     LIDAR_POINT_CLOUD_VIEW, GstBaseTransform)
struct _GstLidarPointCloudView {
  GstBaseTransform parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarPointCloudView, gst_lidar_point_cloud_view, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE(pointcloudview, "pointcloudview", GST_RANK_NONE,
                            gst_lidar_point_cloud_view_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_POINT_CLOUD_VIEW(self)->state; }

/// Returns the template caps of the other pad, with the frame rates of `caps`.
static GstCaps* TransformCaps(GstBaseTransform* base, GstPadDirection direction, GstCaps* caps,
                              GstCaps* filter) {
  GstPad* other = direction == GST_PAD_SINK ? base->srcpad : base->sinkpad;
  CapsPtr pattern(gst_pad_get_pad_template_caps(other));
  CapsPtr out(gst_caps_new_empty());
  for (guint i = 0; i < gst_caps_get_size(caps); ++i) {
    const GValue* rate = gst_structure_get_value(gst_caps_get_structure(caps, i), "framerate");
    GstCaps* one = gst_caps_copy(pattern.get());
    if (rate != nullptr) gst_caps_set_value(one, "framerate", rate);
    out.reset(gst_caps_merge(out.release(), one));
  }
  if (filter == nullptr) return out.release();
  return gst_caps_intersect_full(filter, out.get(), GST_CAPS_INTERSECT_FIRST);
}

static GstCaps* FixateCaps(GstBaseTransform* base, GstPadDirection direction, GstCaps*,
                           GstCaps* other) {
  other = gst_caps_make_writable(gst_caps_truncate(other));
  if (direction == GST_PAD_SINK) {
    State& state = StateOf(base);
    std::lock_guard lock(state.mutex);
    GstStructure* s = gst_caps_get_structure(other, 0);
    gst_structure_fixate_field_nearest_int(s, "width", static_cast<gint>(state.settings.width));
    gst_structure_fixate_field_nearest_int(s, "height", static_cast<gint>(state.settings.height));
    if (gst_structure_has_field(s, "pixel-aspect-ratio"))
      gst_structure_fixate_field_nearest_fraction(s, "pixel-aspect-ratio", 1, 1);
  }
  return gst_caps_fixate(other);
}

static gboolean SetCaps(GstBaseTransform* base, GstCaps* in, GstCaps* out) {
  State& state = StateOf(base);
  std::string why;
  state.info = CloudInfo::FromFrameCaps(in, &why);
  if (state.info) why = "x, y and z are not F32 side by side";
  if (!state.info || !state.info->fields.HasPackedXyz()) {
    if (state.refused.Note(in))
      GST_ELEMENT_ERROR(base, STREAM, FORMAT,
                        ("The caps do not describe a cloud that can be drawn: %s.", why.c_str()),
                        ("%" GST_PTR_FORMAT, static_cast<gpointer>(in)));
    return FALSE;
  }
  state.refused.Reset();
  GstVideoInfo video;
  if (!gst_video_info_from_caps(&video, out)) return FALSE;
  // An unorganised slice may have other caps than the slice before it. The picture of the scan is
  // continued.
  if (state.renderer && gst_video_info_is_equal(&video, &state.video)) return TRUE;
  state.video = video;
  std::lock_guard lock(state.mutex);
  state.changed = true;
  state.renderer.reset();
  state.drawing = false;  // a picture that was begun has the old format
  return TRUE;
}

static gboolean GetUnitSize(GstBaseTransform*, GstCaps* caps, gsize* size) {
  GstVideoInfo video;
  if (gst_video_info_from_caps(&video, caps)) {
    *size = GST_VIDEO_INFO_SIZE(&video);
    return TRUE;
  }
  const auto info = CloudInfo::FromCaps(caps);
  if (!info) return FALSE;
  *size = info->FrameSize();
  return TRUE;
}

static gboolean TransformSize(GstBaseTransform* base, GstPadDirection direction, GstCaps*, gsize,
                              GstCaps* other_caps, gsize* other_size) {
  return direction == GST_PAD_SINK ? GetUnitSize(base, other_caps, other_size) : FALSE;
}

static void Paint(const Canvas& canvas, GstVideoFrame* frame) {
  const auto step = static_cast<int>(GST_VIDEO_FRAME_COMP_PSTRIDE(frame, 0));
  const auto r = static_cast<int>(GST_VIDEO_FRAME_COMP_POFFSET(frame, 0));
  const auto g = static_cast<int>(GST_VIDEO_FRAME_COMP_POFFSET(frame, 1));
  const auto b = static_cast<int>(GST_VIDEO_FRAME_COMP_POFFSET(frame, 2));
  const int unused = step == 4 ? 6 - r - g - b : r;  // alpha or x
  auto* data = static_cast<guint8*>(GST_VIDEO_FRAME_PLANE_DATA(frame, 0));
  for (int y = 0; y < canvas.height(); ++y) {
    const Color* from = canvas.Row(y);
    guint8* to = data + y * GST_VIDEO_FRAME_PLANE_STRIDE(frame, 0);
    for (int x = 0; x < canvas.width(); ++x, to += step) {
      to[unused] = 255;
      to[r] = from[x].r;
      to[g] = from[x].g;
      to[b] = from[x].b;
    }
  }
}

/// Moves the map to the pose of `in`. Returns false if the points of `in` must not be added to the
/// map.
static bool FollowPose(GstBaseTransform* base, GstBuffer* in) {
  State& state = StateOf(base);
  if (!state.map) return false;
  GstLidarPose pose;
  if (!gst_lidar_buffer_get_pose(in, &pose)) {
    if (!state.warned_no_pose)
      GST_ELEMENT_WARNING(base, STREAM, FAILED,
                          ("The clouds have no poses, so there is no map: put lidarodometry in "
                           "front of pointcloudview."),
                          (nullptr));
    state.warned_no_pose = true;
    return false;
  }
  const GstClockTime captured = gst_lidar_buffer_get_capture_time(in);
  const GstClockTime at = GST_CLOCK_TIME_IS_VALID(captured) ? captured : GST_BUFFER_PTS(in);
  state.map->MoveTo(pose, GST_CLOCK_TIME_IS_VALID(at) ? static_cast<double>(at) / GST_SECOND : 0);
  return pose.tracking != GST_LIDAR_TRACKING_LOST;
}

/// Returns the map, or null if the settings do not want a map. If color_by has changed, begins a
/// new map.
static TrailMap* UpdateMap(State* state) {
  const Settings& settings = state->settings;
  const bool stale = state->map_colors != settings.color_by;
  if (!settings.map || stale) state->map.reset();
  if (settings.map && !state->map) state->map.emplace();
  state->map_colors = settings.color_by;
  return state->map ? &*state->map : nullptr;
}

/// Applies changed settings. Called at the beginning of a picture, so that a picture is drawn with
/// one set of settings.
static void ApplySettings(State* state) {
  std::lock_guard lock(state->mutex);
  if (state->changed || !state->renderer)
    state->renderer =
        std::make_unique<Renderer>(ToView(state->settings), GST_VIDEO_INFO_WIDTH(&state->video),
                                   GST_VIDEO_INFO_HEIGHT(&state->video), UpdateMap(state));
  state->changed = false;
}

static void BeginPicture(State* state, const GstLidarSlice& slice, GstBuffer* in) {
  state->renderer->Begin();
  state->drawing = true;
  state->scan_id = slice.scan_id;
  state->pts = GST_BUFFER_PTS(in);
  state->capture_time = gst_lidar_buffer_get_capture_time(in);
}

static GstFlowReturn FinishPicture(GstBaseTransform* base, GstBuffer* out) {
  State& state = StateOf(base);
  GstVideoFrame frame;
  if (!gst_video_frame_map(&frame, &state.video, out, GST_MAP_WRITE)) {
    GST_ELEMENT_ERROR(base, RESOURCE, WRITE, (nullptr), ("cannot map the output buffer"));
    return GST_FLOW_ERROR;
  }
  Paint(state.renderer->Finish(), &frame);
  gst_video_frame_unmap(&frame);
  GST_BUFFER_PTS(out) = state.pts;
  GST_BUFFER_DURATION(out) = state.info->ScanDuration();
  // The base class has copied the time of the last slice, or of the next scan. Replaces this time.
  if (GST_CLOCK_TIME_IS_VALID(state.capture_time))
    gst_lidar_buffer_set_capture_time(out, state.capture_time);
  state.drawing = false;
  return GST_FLOW_OK;
}

/// Draws a slice. The last slice of a scan completes the picture.
static GstFlowReturn Transform(GstBaseTransform* base, GstBuffer* in, GstBuffer* out) {
  State& state = StateOf(base);
  const BufferMap bytes(in, GST_MAP_READ);
  if (!bytes || bytes.size() != state.info->FrameSize()) {
    GST_ELEMENT_ERROR(
        base, STREAM, FORMAT, ("A buffer does not match its caps."),
        ("it has %" G_GSIZE_FORMAT " bytes, but the caps describe a cloud of %" G_GSIZE_FORMAT,
         gst_buffer_get_size(in), state.info->FrameSize()));
    return GST_FLOW_ERROR;
  }
  GstLidarSlice slice{};
  gst_lidar_buffer_get_slice(in, &slice);
  GstFlowReturn flow = GST_BASE_TRANSFORM_FLOW_DROPPED;
  if (state.drawing && slice.scan_id != state.scan_id)
    flow = FinishPicture(base, out);  // the last slice of the scan was lost
  const bool done = flow == GST_FLOW_OK;
  const bool begins = !state.drawing;
  if (begins) ApplySettings(&state);
  const bool into_map = FollowPose(base, in);
  if (begins) BeginPicture(&state, slice, in);
  state.renderer->Draw(*state.info, slice, bytes.data(), into_map);
  // Returns at most one picture per buffer. If this buffer has already completed the picture of an
  // incomplete scan, its own scan is completed with the next buffer.
  if (slice.slice_index + 1 < slice.slice_count || done) return flow;
  return FinishPicture(base, out);
}

/// Returns OK if a slice does not complete a picture. If this returned DROPPED, the base class
/// would mark the next picture as DISCONT.
static GstFlowReturn GenerateOutput(GstBaseTransform* base, GstBuffer** out) {
  const GstFlowReturn flow =
      GST_BASE_TRANSFORM_CLASS(gst_lidar_point_cloud_view_parent_class)->generate_output(base, out);
  if (flow != GST_BASE_TRANSFORM_FLOW_DROPPED) return flow;
  gst_clear_buffer(out);
  return GST_FLOW_OK;
}

static gboolean TransformMeta(GstBaseTransform* base, GstBuffer* out, GstMeta* meta,
                              GstBuffer* in) {
  // A picture must not have the metas of a slice.
  if (meta->info == gst_meta_get_info(GST_LIDAR_SLICE_META_NAME) ||
      meta->info == gst_meta_get_info(GST_LIDAR_POSE_META_NAME))
    return FALSE;
  return GST_BASE_TRANSFORM_CLASS(gst_lidar_point_cloud_view_parent_class)
      ->transform_meta(base, out, meta, in);
}

static gboolean SinkEvent(GstBaseTransform* base, GstEvent* event) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) StateOf(base).drawing = false;
  return GST_BASE_TRANSFORM_CLASS(gst_lidar_point_cloud_view_parent_class)->sink_event(base, event);
}

static gboolean Stop(GstBaseTransform* base) {
  State& state = StateOf(base);
  state.drawing = false;
  state.renderer.reset();
  state.map.reset();
  state.warned_no_pose = false;
  {
    std::lock_guard lock(state.mutex);
    state.changed = true;
  }
  state.info.reset();
  state.refused.Reset();
  return TRUE;
}

/// Makes the next picture use a new renderer.
static void MarkChanged(GObject* object, GParamSpec*) {
  State& state = StateOf(object);
  std::lock_guard lock(state.mutex);
  state.changed = true;
}

static void gst_lidar_point_cloud_view_init(GstLidarPointCloudView* self) {
  self->state = new State;
  gst_video_info_init(&self->state->video);
}

static void gst_lidar_point_cloud_view_class_init(GstLidarPointCloudViewClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_point_cloud_view_debug, "pointcloudview", 0,
                          "Point clouds as video");
  ServeState<GstLidarPointCloudView, gst_lidar_point_cloud_view_parent_class, kProperties,
             MarkChanged>(klass);
  Describe(klass, {"Point cloud view", "Converter/Video/PointCloud", "Draws point clouds as video"},
           {{"sink", GST_PAD_SINK, GST_LIDAR_CLOUD_MEDIA_TYPE},
            {"src", GST_PAD_SRC,
             "video/x-raw, format = (string) " VIDEO_FORMATS
             ", width = [ 16, 8192 ], height = [ 16, 8192 ], "
             "framerate = (fraction) [ 0, max ]"}});
  auto* transform = GST_BASE_TRANSFORM_CLASS(klass);
  transform->transform_caps = TransformCaps;
  transform->fixate_caps = FixateCaps;
  transform->set_caps = SetCaps;
  transform->get_unit_size = GetUnitSize;
  transform->transform_size = TransformSize;
  transform->transform = Transform;
  transform->generate_output = GenerateOutput;
  transform->transform_meta = TransformMeta;
  transform->sink_event = SinkEvent;
  transform->stop = Stop;
}
