// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bin/common.h"

namespace lidar::gst {

GstElement* AddChild(GstElement* bin, const char* factory, const char* name) {
  GstElement* child = gst_element_factory_make(factory, name);
  if (child != nullptr) gst_bin_add(GST_BIN(bin), child);
  return child;
}

void ReportMissing(GstElement* bin, const char* factory) {
  GST_ELEMENT_ERROR(bin, CORE, MISSING_PLUGIN, ("The element %s is missing", factory),
                    ("check the installation with: gst-inspect-1.0 %s", factory));
}

void Forward(GstElement* child, GParamSpec* spec, const GValue* value) {
  if (child == nullptr) return;
  if (g_object_class_find_property(G_OBJECT_GET_CLASS(child), spec->name) != nullptr)
    g_object_set_property(G_OBJECT(child), spec->name, value);
}

void GiveSocket(GstElement* child, GSocket* socket) {
  g_object_set(child, "socket", socket, "close-socket", FALSE, nullptr);
}

guint OverheadOf(GSocketAddress* peer) {
  constexpr guint kUdp = 8;
  return kUdp + (g_socket_address_get_family(peer) == G_SOCKET_FAMILY_IPV6 ? 40 : 20);
}

}  // namespace lidar::gst
