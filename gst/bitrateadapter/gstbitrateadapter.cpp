// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-bitrateadapter
 * @title: bitrateadapter
 *
 * Passes everything on, and turns the upstream event `target-bitrate` into the bitrate property of
 * the encoder before it, in that encoder's unit.
 *
 * |[
 * gst-launch-1.0 videotestsrc is-live=true ! openh264enc ! bitrateadapter max=4000000 ! \
 *   rtph264pay ! screamsink host=127.0.0.1 port=5004
 * ]|
 */
#include <gst/base/gstbasetransform.h>

#include <algorithm>
#include <limits>
#include <mutex>

#include "gst/bitrateadapter/encoder_bitrate.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/lidar/gstlidar.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_bitrate_adapter_debug);
#define GST_CAT_DEFAULT gst_lidar_bitrate_adapter_debug

namespace {

using namespace lidar::gst;

constexpr gdouble kMaxBps = std::numeric_limits<guint>::max();

struct Settings {
  std::string encoder;
  std::string property;
  gdouble scale = 0;
  guint min_bps = 0;
  guint max_bps = std::numeric_limits<guint>::max();
  gdouble fraction = 1;
};

struct State {
  std::mutex mutex;  // guards all below; never held while setting, pushing or posting
  Settings settings;
  guint bitrate = 0;
  bool warned = false;
  bool bounds_due = false;   // the limits have changed
  bool told_bounds = false;  // limits were sent downstream
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarBitrateAdapter, gst_lidar_bitrate_adapter, GST, LIDAR_BITRATE_ADAPTER,
                     GstBaseTransform)
struct _GstLidarBitrateAdapter {
  GstBaseTransform parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarBitrateAdapter, gst_lidar_bitrate_adapter, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE(bitrateadapter, "bitrateadapter", GST_RANK_NONE,
                            gst_lidar_bitrate_adapter_get_type())

static guint Bitrate(GObject* object) {
  State& state = *GST_LIDAR_BITRATE_ADAPTER(object)->state;
  const std::lock_guard lock(state.mutex);
  return state.bitrate;
}

static const std::array<Property<Settings>, 7> kProperties = {{
    {"encoder", "Name of the encoder; empty: the first element of klass Encoder upstream",
     &Settings::encoder, 0, 0, GST_PARAM_MUTABLE_PLAYING},
    {"property", "The encoder's bitrate property; empty: looked up by the encoder's factory",
     &Settings::property, 0, 0, GST_PARAM_MUTABLE_PLAYING},
    {"scale",
     "Units of the encoder's property in one bit/s [unit/(bit/s)], 0.001 for kbit/s; 0: looked "
     "up by the encoder's factory",
     &Settings::scale, 0, 1e6, GST_PARAM_MUTABLE_PLAYING},
    {"min", "Never set less than this [bit/s]", &Settings::min_bps, 0, kMaxBps,
     GST_PARAM_MUTABLE_PLAYING},
    {"max", "Never set more than this [bit/s]", &Settings::max_bps, 1, kMaxBps,
     GST_PARAM_MUTABLE_PLAYING},
    {"fraction", "Share of the target that this encoder gets", &Settings::fraction, 0.001, 1,
     GST_PARAM_MUTABLE_PLAYING},
    {"bitrate", "Bitrate that was set on the encoder last [bit/s]; 0: none yet", Bitrate},
}};

static ElementPtr FindEncoder(GstBaseTransform* base, const Settings& settings) {
  if (settings.encoder.empty()) return FindEncoderUpstream(GST_BASE_TRANSFORM_SINK_PAD(base));
  const ElementPtr parent(GST_ELEMENT(gst_object_get_parent(GST_OBJECT(base))));
  if (!parent || !GST_IS_BIN(parent.get())) return nullptr;
  return ElementPtr(
      gst_bin_get_by_name_recurse_up(GST_BIN(parent.get()), settings.encoder.c_str()));
}

/// Returns the usual control of the encoder, changed by the settings `property` and `scale`.
static std::optional<BitrateControl> ControlOf(GstElement* encoder, const Settings& settings) {
  GstElementFactory* factory = gst_element_get_factory(encoder);
  auto control = factory == nullptr ? std::nullopt : FindBitrateControl(GST_OBJECT_NAME(factory));
  if (!settings.property.empty()) {
    if (!control || control->property != settings.property)
      control = BitrateControl{settings.property, 1, ""};
  }
  if (control && settings.scale > 0) control->bps_per_unit = 1 / settings.scale;
  return control;
}

static void WarnOnce(GstLidarBitrateAdapter* self, const char* text, const char* what) {
  State& state = *self->state;
  {
    const std::lock_guard lock(state.mutex);
    if (state.warned) return;
    state.warned = true;
  }
  GST_ELEMENT_WARNING(self, STREAM, ENCODE, ("%s", text), ("%s", what));
}

/// Sets the bitrate of the encoder. Returns false if there is no encoder or its bitrate cannot be
/// set. The event then goes on upstream.
static bool Apply(GstLidarBitrateAdapter* self, guint target_bps) {
  State& state = *self->state;
  const Settings settings = Snapshot(state);
  const ElementPtr encoder = FindEncoder(GST_BASE_TRANSFORM(self), settings);
  if (!encoder) {
    WarnOnce(self, "There is no encoder upstream whose bitrate could follow the network.",
             "Put bitrateadapter behind the encoder, or name it with the property encoder.");
    return false;
  }
  const auto control = ControlOf(encoder.get(), settings);
  const auto wanted = static_cast<guint>(target_bps * settings.fraction);
  const guint bps = std::max(std::min(wanted, settings.max_bps), settings.min_bps);
  const auto set = control ? SetEncoderBitrate(encoder.get(), *control, bps) : std::nullopt;
  if (!set) {
    WarnOnce(self, "The bitrate of this encoder cannot be set.",
             "Name its bitrate property by the properties property and scale.");
    return false;
  }
  GST_LOG_OBJECT(self, "%s: %u bit/s of %u", GST_OBJECT_NAME(encoder.get()), *set, target_bps);
  bool changed = false;
  {
    const std::lock_guard lock(state.mutex);
    changed = state.bitrate != *set;
    state.bitrate = *set;
  }
  if (changed) g_object_notify(G_OBJECT(self), "bitrate");
  return true;
}

static gboolean SrcEvent(GstBaseTransform* base, GstEvent* event) {
  GstLidarTargetBitrate target{};
  if (gst_lidar_event_parse_target_bitrate(event, &target) &&
      Apply(GST_LIDAR_BITRATE_ADAPTER(base), target.bitrate)) {
    gst_event_unref(event);
    return TRUE;
  }
  return GST_BASE_TRANSFORM_CLASS(gst_lidar_bitrate_adapter_parent_class)->src_event(base, event);
}

/// Returns the limits of the whole target. The encoder gets only a fraction of the target, so the
/// user's limits are divided by this fraction.
static GstLidarBitrateBounds BoundsOf(const Settings& settings) {
  const auto whole = [&](guint bps) {
    return static_cast<guint>(std::min(bps / settings.fraction, kMaxBps));
  };
  return {whole(settings.min_bps), whole(settings.max_bps), whole(settings.max_bps)};
}

/// Sends the user's limits downstream, so that the sender's targets stay within them.
static void SendBounds(GstBaseTransform* base) {
  State& state = *GST_LIDAR_BITRATE_ADAPTER(base)->state;
  GstLidarBitrateBounds bounds{};
  {
    const std::lock_guard lock(state.mutex);
    state.bounds_due = false;
    bounds = BoundsOf(state.settings);
    const bool limits =
        bounds.min_bitrate > 0 || bounds.max_bitrate < std::numeric_limits<guint>::max();
    if (!limits && !state.told_bounds) return;
    state.told_bounds = limits;
  }
  gst_pad_push_event(GST_BASE_TRANSFORM_SRC_PAD(base), gst_lidar_event_new_bitrate_bounds(&bounds));
}

static gboolean SinkEvent(GstBaseTransform* base, GstEvent* event) {
  const bool is_caps = GST_EVENT_TYPE(event) == GST_EVENT_CAPS;
  const gboolean result =
      GST_BASE_TRANSFORM_CLASS(gst_lidar_bitrate_adapter_parent_class)->sink_event(base, event);
  if (is_caps && result) SendBounds(base);
  return result;
}

/// Sends changed limits before the next buffer. They are not sent earlier, because they must follow
/// the caps.
static void BeforeTransform(GstBaseTransform* base, GstBuffer*) {
  State& state = *GST_LIDAR_BITRATE_ADAPTER(base)->state;
  {
    const std::lock_guard lock(state.mutex);
    if (!state.bounds_due) return;
  }
  SendBounds(base);
}

static void OnPropertySet(GObject* object, GParamSpec*) {
  State& state = *GST_LIDAR_BITRATE_ADAPTER(object)->state;
  const std::lock_guard lock(state.mutex);
  state.bounds_due = true;
}

static gboolean Start(GstBaseTransform* base) {
  State& state = *GST_LIDAR_BITRATE_ADAPTER(base)->state;
  const std::lock_guard lock(state.mutex);
  state.told_bounds = false;
  state.bitrate = 0;
  state.warned = false;
  return TRUE;
}

static void gst_lidar_bitrate_adapter_init(GstLidarBitrateAdapter* self) {
  self->state = new State;
  gst_base_transform_set_passthrough(GST_BASE_TRANSFORM(self), TRUE);
}

static void gst_lidar_bitrate_adapter_class_init(GstLidarBitrateAdapterClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_bitrate_adapter_debug, "bitrateadapter", 0,
                          "Encoder bitrate adapter");
  ServeState<GstLidarBitrateAdapter, gst_lidar_bitrate_adapter_parent_class, kProperties,
             OnPropertySet>(klass);
  Describe(klass,
           {"Encoder bitrate adapter", "Filter/Network",
            "Sets the bitrate of the encoder before it from target-bitrate events"},
           {{"sink", GST_PAD_SINK, "ANY"}, {"src", GST_PAD_SRC, "ANY"}});
  auto* transform = GST_BASE_TRANSFORM_CLASS(klass);
  transform->start = Start;
  transform->src_event = SrcEvent;
  transform->sink_event = SinkEvent;
  transform->before_transform = BeforeTransform;
  transform->passthrough_on_same_caps = TRUE;
}
