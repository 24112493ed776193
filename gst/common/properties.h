// SPDX-License-Identifier: LGPL-2.1-or-later
// GObject properties from one table: each row binds a property to a field of Settings.
#pragma once
#include <gst/gst.h>

#include <array>
#include <limits>
#include <string>
#include <variant>

namespace lidar::gst {

template <class... F>
struct Overload : F... {
  using F::operator()...;
};
template <class... F>
Overload(F...) -> Overload<F...>;

/// An enumeration is kept as gint; `type` gives its GType.
template <class Settings>
struct EnumField {
  gint Settings::*field;
  GType (*type)();
};

/// One property bound to one field of Settings; the default is the field's initialiser.
template <class Settings>
struct Property {
  const char* name;
  const char* blurb;  // names its unit in brackets
  std::variant<guint Settings::*, gint Settings::*, guint64 Settings::*, gdouble Settings::*,
               bool Settings::*, std::string Settings::*, EnumField<Settings>>
      field;
  gdouble min = 0;
  gdouble max = 0;
  // GST_PARAM_MUTABLE_PLAYING where a change takes effect at once
  gint mutability = GST_PARAM_MUTABLE_READY;
};

// Where gcc 12 sees the table's values and no row is a string, it warns of reading one past
// Settings.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Warray-bounds"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

/// Installs the rows of `table` under the ids first_id, first_id + 1, ...
template <class Settings, std::size_t N>
void InstallProperties(GObjectClass* klass, const std::array<Property<Settings>, N>& table,
                       guint first_id = 1) {
  const Settings defaults{};
  for (const auto& p : table) {
    const auto flags =
        static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | p.mutability);
    GParamSpec* spec = std::visit(
        Overload{
            [&](guint Settings::*f) {
              return g_param_spec_uint(p.name, p.name, p.blurb, static_cast<guint>(p.min),
                                       static_cast<guint>(p.max), defaults.*f, flags);
            },
            [&](gint Settings::*f) {
              return g_param_spec_int(p.name, p.name, p.blurb, static_cast<gint>(p.min),
                                      static_cast<gint>(p.max), defaults.*f, flags);
            },
            [&](guint64 Settings::*f) {
              const bool unlimited =
                  p.max >= static_cast<gdouble>(std::numeric_limits<guint64>::max());
              return g_param_spec_uint64(
                  p.name, p.name, p.blurb, static_cast<guint64>(p.min),
                  unlimited ? std::numeric_limits<guint64>::max() : static_cast<guint64>(p.max),
                  defaults.*f, flags);
            },
            [&](gdouble Settings::*f) {
              return g_param_spec_double(p.name, p.name, p.blurb, p.min, p.max, defaults.*f, flags);
            },
            [&](bool Settings::*f) {
              return g_param_spec_boolean(p.name, p.name, p.blurb, defaults.*f, flags);
            },
            [&](std::string Settings::*f) {
              // An empty default reads as NULL, as GStreamer's own elements show it.
              const std::string& text = defaults.*f;
              return g_param_spec_string(p.name, p.name, p.blurb,
                                         text.empty() ? nullptr : text.c_str(), flags);
            },
            [&](const EnumField<Settings>& f) {
              return g_param_spec_enum(p.name, p.name, p.blurb, f.type(), defaults.*f.field, flags);
            }},
        p.field);
    g_object_class_install_property(klass, first_id++, spec);
  }
}

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

template <class Settings>
void SetProperty(Settings& s, const Property<Settings>& p, const GValue* v) {
  std::visit(Overload{[&](guint Settings::*f) { s.*f = g_value_get_uint(v); },
                      [&](gint Settings::*f) { s.*f = g_value_get_int(v); },
                      [&](guint64 Settings::*f) { s.*f = g_value_get_uint64(v); },
                      [&](gdouble Settings::*f) { s.*f = g_value_get_double(v); },
                      [&](bool Settings::*f) { s.*f = g_value_get_boolean(v) != FALSE; },
                      [&](std::string Settings::*f) {
                        const gchar* text = g_value_get_string(v);
                        s.*f = text != nullptr ? text : "";
                      },
                      [&](const EnumField<Settings>& f) { s.*f.field = g_value_get_enum(v); }},
             p.field);
}

template <class Settings>
void GetProperty(const Settings& s, const Property<Settings>& p, GValue* v) {
  std::visit(Overload{[&](guint Settings::*f) { g_value_set_uint(v, s.*f); },
                      [&](gint Settings::*f) { g_value_set_int(v, s.*f); },
                      [&](guint64 Settings::*f) { g_value_set_uint64(v, s.*f); },
                      [&](gdouble Settings::*f) { g_value_set_double(v, s.*f); },
                      [&](bool Settings::*f) { g_value_set_boolean(v, s.*f); },
                      [&](std::string Settings::*f) {
                        g_value_set_string(v, (s.*f).empty() ? nullptr : (s.*f).c_str());
                      },
                      [&](const EnumField<Settings>& f) { g_value_set_enum(v, s.*f.field); }},
             p.field);
}

}  // namespace lidar::gst
