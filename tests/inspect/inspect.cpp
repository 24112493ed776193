// SPDX-License-Identifier: LGPL-2.1-or-later
// Prints the elements, pads and properties of the plugins as JSON. The output is the same on every
// machine.
#include <gst/gst.h>

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "gst/common/refs.h"

namespace {

using lidar::gst::ElementPtr;
using lidar::gst::StringPtr;
using nlohmann::ordered_json;

/// Returns the range of a property's values, or an empty value if its type has no range.
ordered_json RangeOf(GParamSpec* spec) {
  if (G_IS_PARAM_SPEC_INT(spec))
    return {G_PARAM_SPEC_INT(spec)->minimum, G_PARAM_SPEC_INT(spec)->maximum};
  if (G_IS_PARAM_SPEC_UINT(spec))
    return {G_PARAM_SPEC_UINT(spec)->minimum, G_PARAM_SPEC_UINT(spec)->maximum};
  if (G_IS_PARAM_SPEC_INT64(spec))
    return {G_PARAM_SPEC_INT64(spec)->minimum, G_PARAM_SPEC_INT64(spec)->maximum};
  if (G_IS_PARAM_SPEC_UINT64(spec))
    return {G_PARAM_SPEC_UINT64(spec)->minimum, G_PARAM_SPEC_UINT64(spec)->maximum};
  if (G_IS_PARAM_SPEC_DOUBLE(spec))
    return {G_PARAM_SPEC_DOUBLE(spec)->minimum, G_PARAM_SPEC_DOUBLE(spec)->maximum};
  return {};
}

/// Returns the nick and the description of each value of a type of enumerations or flags.
ordered_json ValuesOf(GType type) {
  ordered_json values = ordered_json::object();
  if (G_TYPE_IS_ENUM(type)) {
    auto* klass = G_ENUM_CLASS(g_type_class_ref(type));
    for (guint i = 0; i < klass->n_values; ++i)
      values[klass->values[i].value_nick] = klass->values[i].value_name;
    g_type_class_unref(klass);
  }
  return values;
}

/// Returns the states in which a property may be written.
std::string AccessOf(const GParamSpec* spec) {
  if ((spec->flags & G_PARAM_WRITABLE) == 0) return "read only";
  if (spec->flags & G_PARAM_CONSTRUCT_ONLY) return "at construction";
  if (spec->flags & GST_PARAM_MUTABLE_PLAYING) return "any state";
  if (spec->flags & GST_PARAM_MUTABLE_PAUSED) return "up to PAUSED";
  if (spec->flags & GST_PARAM_MUTABLE_READY) return "NULL or READY";
  return "not said";
}

ordered_json DescribeProperty(GParamSpec* spec) {
  ordered_json property;
  property["type"] = g_type_name(spec->value_type);
  property["access"] = AccessOf(spec);
  property["blurb"] = g_param_spec_get_blurb(spec);
  const ordered_json range = RangeOf(spec);
  if (!range.empty()) property["range"] = range;
  const ordered_json values = ValuesOf(spec->value_type);
  if (!values.empty()) property["values"] = values;
  if (G_IS_PARAM_SPEC_DOUBLE(spec)) {
    // The number itself is used here, because the text of a serialised double has all digits of its
    // binary value.
    property["default"] = G_PARAM_SPEC_DOUBLE(spec)->default_value;
  } else if (!G_IS_PARAM_SPEC_BOXED(spec) && !G_IS_PARAM_SPEC_OBJECT(spec)) {
    const StringPtr text(gst_value_serialize(g_param_spec_get_default_value(spec)));
    property["default"] = text ? ordered_json(text.get()) : ordered_json(nullptr);
  }
  return property;
}

/// Describes the properties that the classes of this project add. GStreamer documents the
/// properties of its own classes.
ordered_json DescribeProperties(GstElement* element) {
  ordered_json properties = ordered_json::object();
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
  std::map<std::string, GParamSpec*> sorted;
  for (guint i = 0; i < count; ++i)
    if (g_str_has_prefix(g_type_name(specs[i]->owner_type), "GstLidar"))
      sorted[specs[i]->name] = specs[i];
  g_free(specs);
  for (const auto& [name, spec] : sorted) properties[name] = DescribeProperty(spec);
  return properties;
}

ordered_json DescribePads(GstElementFactory* factory) {
  static const char* const kPresence[] = {"always", "sometimes", "request"};
  std::map<std::string, ordered_json> pads;
  for (const GList* t = gst_element_factory_get_static_pad_templates(factory); t != nullptr;
       t = t->next) {
    auto* pad_template = static_cast<GstStaticPadTemplate*>(t->data);
    GstCaps* caps = gst_static_pad_template_get_caps(pad_template);
    const StringPtr text(gst_caps_to_string(caps));
    gst_caps_unref(caps);
    pads[pad_template->name_template] = {
        {"direction", pad_template->direction == GST_PAD_SRC ? "src" : "sink"},
        {"presence", kPresence[pad_template->presence]},
        {"caps", text.get()}};
  }
  return pads;
}

/// Describes the signals of the classes of this project, including action signals.
ordered_json DescribeSignals(GType type) {
  std::map<std::string, ordered_json> all;
  for (; g_str_has_prefix(g_type_name(type), "GstLidar"); type = g_type_parent(type)) {
    guint count = 0;
    guint* ids = g_signal_list_ids(type, &count);
    for (guint i = 0; i < count; ++i) {
      GSignalQuery query;
      g_signal_query(ids[i], &query);
      ordered_json parameters = ordered_json::array();
      for (guint p = 0; p < query.n_params; ++p)
        parameters.push_back(g_type_name(query.param_types[p] & ~G_SIGNAL_TYPE_STATIC_SCOPE));
      all[query.signal_name] = {{"returns", g_type_name(query.return_type)},
                                {"parameters", parameters}};
    }
    g_free(ids);
  }
  return all;
}

ordered_json DescribeElement(GstElementFactory* factory) {
  const ElementPtr element(gst_element_factory_create(factory, nullptr));
  gst_object_ref_sink(element.get());
  const auto text = [&](const char* key) { return gst_element_factory_get_metadata(factory, key); };
  ordered_json out;
  out["long-name"] = text(GST_ELEMENT_METADATA_LONGNAME);
  out["klass"] = text(GST_ELEMENT_METADATA_KLASS);
  out["description"] = text(GST_ELEMENT_METADATA_DESCRIPTION);
  out["rank"] = gst_plugin_feature_get_rank(GST_PLUGIN_FEATURE(factory));
  out["type"] = G_OBJECT_TYPE_NAME(element.get());
  out["pads"] = DescribePads(factory);
  out["properties"] = DescribeProperties(element.get());
  const ordered_json signals = DescribeSignals(G_OBJECT_TYPE(element.get()));
  if (!signals.empty()) out["signals"] = signals;
  return out;
}

ordered_json DescribePlugin(GstRegistry* registry, GstPlugin* plugin) {
  std::map<std::string, ordered_json> elements;
  GList* features = gst_registry_get_feature_list_by_plugin(registry, gst_plugin_get_name(plugin));
  for (GList* f = features; f != nullptr; f = f->next) {
    if (!GST_IS_ELEMENT_FACTORY(f->data)) continue;
    auto* loaded = gst_plugin_feature_load(GST_PLUGIN_FEATURE(f->data));
    elements[GST_OBJECT_NAME(f->data)] = DescribeElement(GST_ELEMENT_FACTORY(loaded));
    gst_object_unref(loaded);
  }
  gst_plugin_feature_list_free(features);
  return {{"description", gst_plugin_get_description(plugin)},
          {"license", gst_plugin_get_license(plugin)},
          {"elements", elements}};
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  std::map<std::string, ordered_json> all;
  GstRegistry* registry = gst_registry_get();
  GList* plugins = gst_registry_get_plugin_list(registry);
  for (GList* p = plugins; p != nullptr; p = p->next) {
    auto* plugin = static_cast<GstPlugin*>(p->data);
    if (std::string(gst_plugin_get_package(plugin)) == "gst-lidar")
      all[gst_plugin_get_name(plugin)] = DescribePlugin(registry, plugin);
  }
  gst_plugin_list_free(plugins);
  std::puts(ordered_json(all).dump(2).c_str());
  gst_deinit();
  return all.empty() ? 1 : 0;
}
