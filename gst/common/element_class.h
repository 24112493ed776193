// SPDX-License-Identifier: LGPL-2.1-or-later
// Describes elements for the registry, and adds their pads.
#pragma once
#include <gst/gst.h>

#include <initializer_list>

namespace lidar::gst {

struct ElementInfo {
  const char* long_name;
  const char* classification;
  const char* description;
};

struct PadRow {
  const char* name;
  GstPadDirection direction;
  const char* caps;
  GstPadPresence presence = GST_PAD_ALWAYS;
  GType type = G_TYPE_NONE;  // type of the pads; NONE for GstPad
};

/// Sets the description of an element class, and adds its pad templates.
inline void Describe(gpointer klass, const ElementInfo& info,
                     std::initializer_list<PadRow> pads = {}) {
  auto* element = GST_ELEMENT_CLASS(klass);
  for (const PadRow& pad : pads) {
    GstStaticPadTemplate row{pad.name, pad.direction, pad.presence, GST_STATIC_CAPS(pad.caps)};
    if (pad.type == G_TYPE_NONE)
      gst_element_class_add_static_pad_template(element, &row);
    else
      gst_element_class_add_static_pad_template_with_gtype(element, &row, pad.type);
  }
  gst_element_class_set_static_metadata(element, info.long_name, info.classification,
                                        info.description, "gst-lidar");
}

/// Adds a pad with the template `name`. The element owns the pad.
inline GstPad* AddPad(gpointer element, const char* name) {
  auto* klass = GST_ELEMENT_GET_CLASS(element);
  GstPad* pad = gst_pad_new_from_template(gst_element_class_get_pad_template(klass, name), name);
  gst_element_add_pad(GST_ELEMENT(element), pad);
  return pad;
}

}  // namespace lidar::gst
