// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/bitrateadapter/encoder_bitrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace lidar::gst {
namespace {

constexpr gdouble kBps = 1;
constexpr gdouble kKbps = 1000;

struct KnownEncoder {
  std::string_view prefix;  // of the factory's name
  std::string_view suffix;
  const char* property;
  gdouble bps_per_unit;
  const char* control = "";
};

// The first row that matches applies, so exceptions stand before the row of their family.
constexpr std::array kKnown = {
    KnownEncoder{"x264enc", "", "bitrate", kKbps},
    KnownEncoder{"x265enc", "", "bitrate", kKbps},
    KnownEncoder{"openh264enc", "", "bitrate", kBps},
    KnownEncoder{"vp8enc", "", "target-bitrate", kBps},
    KnownEncoder{"vp9enc", "", "target-bitrate", kBps},
    KnownEncoder{"av1enc", "", "target-bitrate", kKbps},
    KnownEncoder{"svtav1enc", "", "target-bitrate", kKbps},
    KnownEncoder{"svthevcenc", "", "bitrate", kKbps},
    KnownEncoder{"rav1enc", "", "bitrate", kBps},
    KnownEncoder{"theoraenc", "", "bitrate", kKbps},
    KnownEncoder{"opusenc", "", "bitrate", kBps},
    KnownEncoder{"nvv4l2", "enc", "bitrate", kBps},  // Jetson
    KnownEncoder{"nv", "enc", "bitrate", kKbps},
    KnownEncoder{"omx", "enc", "target-bitrate", kBps},
    KnownEncoder{"v4l2", "enc", "extra-controls", kBps, "video_bitrate"},
    KnownEncoder{"va", "enc", "bitrate", kKbps},  // va and vaapi
    KnownEncoder{"msdk", "enc", "bitrate", kKbps},
    KnownEncoder{"qsv", "enc", "bitrate", kKbps},
    KnownEncoder{"amf", "enc", "bitrate", kKbps},
    KnownEncoder{"mf", "enc", "bitrate", kKbps},
    KnownEncoder{"d3d12", "enc", "bitrate", kKbps},
    KnownEncoder{"vtenc_", "", "bitrate", kKbps},
    KnownEncoder{"mpp", "enc", "bps", kBps},  // Rockchip
    KnownEncoder{"imxvpuenc_", "", "bitrate", kKbps},
    KnownEncoder{"vpuenc_", "", "bitrate", kKbps},
    KnownEncoder{"avenc_", "", "bitrate", kBps},
};

bool Fits(const KnownEncoder& known, std::string_view factory) {
  return factory.size() >= known.prefix.size() + known.suffix.size() &&
         factory.substr(0, known.prefix.size()) == known.prefix &&
         factory.substr(factory.size() - known.suffix.size()) == known.suffix;
}

bool IsEncoder(GstElement* element) {
  const gchar* klass = gst_element_get_metadata(element, GST_ELEMENT_METADATA_KLASS);
  return klass != nullptr && std::string_view(klass).find("Encoder") != std::string_view::npos;
}

/// Returns the source pad of the element that feeds `pad`, also if that element is inside of a bin
/// or outside of the bin of `pad`. Returns null if `pad` is not linked.
PadPtr RealPeer(GstPad* pad) {
  PadPtr peer(gst_pad_get_peer(pad));
  while (peer && GST_IS_PROXY_PAD(peer.get())) {
    if (GST_IS_GHOST_PAD(peer.get())) {  // a bin's output: continue with the pad inside
      peer.reset(gst_ghost_pad_get_target(GST_GHOST_PAD(peer.get())));
    } else {  // a bin's input, seen from inside: continue outside
      const PadPtr ghost(GST_PAD(gst_proxy_pad_get_internal(GST_PROXY_PAD(peer.get()))));
      peer.reset(ghost ? gst_pad_get_peer(ghost.get()) : nullptr);
    }
  }
  return peer;
}

/// Returns the sink pad of `element`, or null if the element does not have exactly one.
PadPtr OnlySinkPad(GstElement* element) {
  GST_OBJECT_LOCK(element);
  PadPtr pad(element->numsinkpads == 1 ? GST_PAD(gst_object_ref(element->sinkpads->data))
                                       : nullptr);
  GST_OBJECT_UNLOCK(element);
  return pad;
}

/// Returns the range of a numeric property, or nothing for a property of another type.
std::optional<std::pair<gdouble, gdouble>> RangeOf(const GParamSpec* spec) {
  if (G_IS_PARAM_SPEC_UINT(spec))
    return {{G_PARAM_SPEC_UINT(spec)->minimum, G_PARAM_SPEC_UINT(spec)->maximum}};
  if (G_IS_PARAM_SPEC_INT(spec))
    return {{G_PARAM_SPEC_INT(spec)->minimum, G_PARAM_SPEC_INT(spec)->maximum}};
  const auto wide = [](auto minimum, auto maximum) {
    return std::pair{static_cast<gdouble>(minimum), static_cast<gdouble>(maximum)};
  };
  if (G_IS_PARAM_SPEC_UINT64(spec))
    return wide(G_PARAM_SPEC_UINT64(spec)->minimum, G_PARAM_SPEC_UINT64(spec)->maximum);
  if (G_IS_PARAM_SPEC_INT64(spec))
    return wide(G_PARAM_SPEC_INT64(spec)->minimum, G_PARAM_SPEC_INT64(spec)->maximum);
  if (G_IS_PARAM_SPEC_ULONG(spec))
    return wide(G_PARAM_SPEC_ULONG(spec)->minimum, G_PARAM_SPEC_ULONG(spec)->maximum);
  if (G_IS_PARAM_SPEC_LONG(spec))
    return wide(G_PARAM_SPEC_LONG(spec)->minimum, G_PARAM_SPEC_LONG(spec)->maximum);
  if (G_IS_PARAM_SPEC_DOUBLE(spec))
    return wide(G_PARAM_SPEC_DOUBLE(spec)->minimum, G_PARAM_SPEC_DOUBLE(spec)->maximum);
  return std::nullopt;
}

/// Sets a field of a structure property, and keeps the other fields, which the user may have set.
/// Returns the bitrate that was set [bit/s].
guint SetControl(GstElement* encoder, const BitrateControl& control, gdouble units) {
  GstStructure* old = nullptr;
  g_object_get(encoder, control.property.c_str(), &old, nullptr);
  const StructurePtr controls(old != nullptr ? old : gst_structure_new_empty("controls"));
  const gdouble top = std::numeric_limits<gint>::max();
  const auto value = static_cast<gint>(std::min(units, top));
  gst_structure_set(controls.get(), control.control.c_str(), G_TYPE_INT, value, nullptr);
  g_object_set(encoder, control.property.c_str(), controls.get(), nullptr);
  return static_cast<guint>(value * control.bps_per_unit);
}

}  // namespace

std::optional<BitrateControl> FindBitrateControl(const std::string& factory) {
  const auto* known = std::find_if(kKnown.begin(), kKnown.end(),
                                   [&](const KnownEncoder& k) { return Fits(k, factory); });
  if (known == kKnown.end()) return std::nullopt;
  return BitrateControl{known->property, known->bps_per_unit, known->control};
}

ElementPtr FindEncoderUpstream(GstPad* pad) {
  constexpr int kMaxElements = 64;  // bounds the search in a loop of links
  PadPtr sink(GST_PAD(gst_object_ref(pad)));
  for (int i = 0; sink && i < kMaxElements; ++i) {
    const PadPtr peer = RealPeer(sink.get());
    if (!peer) return nullptr;
    ElementPtr element(gst_pad_get_parent_element(peer.get()));
    if (!element || IsEncoder(element.get())) return element;
    sink = OnlySinkPad(element.get());
  }
  return nullptr;
}

std::optional<guint> SetEncoderBitrate(GstElement* encoder, const BitrateControl& control,
                                       guint bps) {
  const GParamSpec* spec =
      g_object_class_find_property(G_OBJECT_GET_CLASS(encoder), control.property.c_str());
  if (spec == nullptr || (spec->flags & G_PARAM_WRITABLE) == 0) return std::nullopt;
  const gdouble units = std::round(bps / control.bps_per_unit);
  if (!control.control.empty()) {
    if (spec->value_type != GST_TYPE_STRUCTURE) return std::nullopt;
    return SetControl(encoder, control, units);
  }
  const auto range = RangeOf(spec);
  if (!range) return std::nullopt;
  // The value is at least 1, because 0 means "automatic" to many encoders.
  const gdouble value = std::clamp(std::max(units, 1.0), range->first, range->second);
  GValue number = G_VALUE_INIT;
  g_value_init(&number, G_TYPE_DOUBLE);
  g_value_set_double(&number, value);
  g_object_set_property(G_OBJECT(encoder), control.property.c_str(), &number);
  g_value_unset(&number);
  return static_cast<guint>(
      std::min(value * control.bps_per_unit, gdouble{std::numeric_limits<guint>::max()}));
}

}  // namespace lidar::gst
