// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts caps to text, and untrusted text to caps. Untrusted text is not parsed by GStreamer,
// because the time of GStreamer's parser doubles with each level of nesting.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/refs.h"
#include "src/base/scalar_caps.h"

namespace lidar::gst {
namespace caps_text {

/// Converts an array of doubles. Returns nothing if a value in it is not a double.
inline std::optional<ScalarCaps::Value> ToDoubles(const GValue* array) {
  ScalarCaps::Doubles values;
  for (guint i = 0; i < gst_value_array_get_size(array); ++i) {
    const GValue* value = gst_value_array_get_value(array, i);
    if (G_VALUE_TYPE(value) != G_TYPE_DOUBLE) return std::nullopt;
    values.push_back(g_value_get_double(value));
  }
  return ScalarCaps::Value(std::move(values));
}

inline void SetDoubles(GstStructure* s, const gchar* name, const ScalarCaps::Doubles& values) {
  GValue array = G_VALUE_INIT;
  gst_value_array_init(&array, static_cast<guint>(values.size()));
  for (const double v : values) {
    GValue value = G_VALUE_INIT;
    g_value_init(&value, G_TYPE_DOUBLE);
    g_value_set_double(&value, v);
    gst_value_array_append_and_take_value(&array, &value);
  }
  gst_structure_take_value(s, name, &array);
}

/// Returns nothing if ScalarCaps does not support the type of the value.
inline std::optional<ScalarCaps::Value> ToScalar(const GValue* value) {
  using Value = ScalarCaps::Value;
  const GType type = G_VALUE_TYPE(value);
  if (type == G_TYPE_BOOLEAN) return Value(g_value_get_boolean(value) != FALSE);
  if (type == G_TYPE_INT) return Value(std::int32_t{g_value_get_int(value)});
  if (type == G_TYPE_UINT) return Value(std::uint32_t{g_value_get_uint(value)});
  if (type == G_TYPE_INT64) return Value(std::int64_t{g_value_get_int64(value)});
  if (type == G_TYPE_UINT64) return Value(std::uint64_t{g_value_get_uint64(value)});
  if (type == G_TYPE_FLOAT) return Value(g_value_get_float(value));
  if (type == G_TYPE_DOUBLE) return Value(g_value_get_double(value));
  if (type == GST_TYPE_FRACTION)
    return Value(ScalarCaps::Fraction{gst_value_get_fraction_numerator(value),
                                      gst_value_get_fraction_denominator(value)});
  if (type == GST_TYPE_ARRAY) return ToDoubles(value);
  if (type == G_TYPE_STRING && g_value_get_string(value) != nullptr)
    return Value(std::string(g_value_get_string(value)));
  if (type != GST_TYPE_BUFFER || gst_value_get_buffer(value) == nullptr) return std::nullopt;
  const BufferMap map(gst_value_get_buffer(value), GST_MAP_READ);
  if (!map) return std::nullopt;
  return Value(ScalarCaps::Bytes(map.view().begin(), map.view().end()));
}

inline void SetScalar(GstStructure* s, const gchar* name, const ScalarCaps::Value& value) {
  std::visit(
      [&](const auto& v) {
        using T = std::decay_t<decltype(v)>;
        const auto set = [&](GType type, auto... parts) {
          gst_structure_set(s, name, type, parts..., nullptr);
        };
        if constexpr (std::is_same_v<T, std::string>) set(G_TYPE_STRING, v.c_str());
        if constexpr (std::is_same_v<T, bool>) set(G_TYPE_BOOLEAN, gboolean{v});
        if constexpr (std::is_same_v<T, std::int32_t>) set(G_TYPE_INT, gint{v});
        if constexpr (std::is_same_v<T, std::uint32_t>) set(G_TYPE_UINT, guint{v});
        if constexpr (std::is_same_v<T, std::int64_t>) set(G_TYPE_INT64, gint64{v});
        if constexpr (std::is_same_v<T, std::uint64_t>) set(G_TYPE_UINT64, guint64{v});
        if constexpr (std::is_same_v<T, float>) set(G_TYPE_FLOAT, static_cast<gdouble>(v));
        if constexpr (std::is_same_v<T, double>) set(G_TYPE_DOUBLE, gdouble{v});
        if constexpr (std::is_same_v<T, ScalarCaps::Fraction>)
          set(GST_TYPE_FRACTION, gint{v.numerator}, gint{v.denominator});
        if constexpr (std::is_same_v<T, ScalarCaps::Bytes>) {
          const BufferPtr buffer(v.empty() ? gst_buffer_new()
                                           : gst_buffer_new_memdup(v.data(), v.size()));
          set(GST_TYPE_BUFFER, buffer.get());
        }
        if constexpr (std::is_same_v<T, ScalarCaps::Doubles>) SetDoubles(s, name, v);
      },
      value);
}

}  // namespace caps_text

/// Converts caps of one stream in system memory with scalar fields. For any other caps, returns
/// nothing and sets `why` to a reason for the user.
inline std::optional<ScalarCaps> ToScalarCaps(const GstCaps* caps, std::string* why = nullptr) {
  std::string ignored;
  std::string& reason = why != nullptr ? *why : ignored;
  reason = "the caps must describe one stream in system memory";
  if (gst_caps_is_any(caps) || gst_caps_get_size(caps) != 1 ||
      !gst_caps_features_is_equal(gst_caps_get_features(caps, 0),
                                  GST_CAPS_FEATURES_MEMORY_SYSTEM_MEMORY))
    return std::nullopt;
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  ScalarCaps scalar;
  scalar.media_type = gst_structure_get_name(s);
  for (gint i = 0; i < gst_structure_n_fields(s); ++i) {
    const gchar* name = gst_structure_nth_field_name(s, static_cast<guint>(i));
    auto value = caps_text::ToScalar(gst_structure_get_value(s, name));
    if (!value) {
      reason = std::string("the field ") + name +
               " is not a string, number, fraction, flag, buffer or array of doubles";
      return std::nullopt;
    }
    scalar.fields.push_back({name, *std::move(value)});
  }
  if (!scalar.ToText(&reason)) return std::nullopt;
  return scalar;
}

inline CapsPtr FromScalarCaps(const ScalarCaps& scalar) {
  CapsPtr caps(gst_caps_new_empty_simple(scalar.media_type.c_str()));
  GstStructure* s = gst_caps_get_structure(caps.get(), 0);
  for (const auto& field : scalar.fields) caps_text::SetScalar(s, field.name.c_str(), field.value);
  return caps;
}

/// Converts caps to text. If CapsFromText() could not parse the text, returns nothing and sets
/// `why` to a reason for the user.
inline std::optional<std::string> CapsToText(const GstCaps* caps, std::string* why = nullptr) {
  const auto scalar = ToScalarCaps(caps, why);
  return scalar ? scalar->ToText() : std::nullopt;
}

/// Returns fixed caps, or null if `text` does not describe caps with scalar fields.
inline CapsPtr CapsFromText(std::string_view text) {
  const auto scalar = ScalarCaps::Parse(text);
  return scalar ? FromScalarCaps(*scalar) : nullptr;
}

}  // namespace lidar::gst
