// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bin/gstscreamsinkpad.h"

#include "gst/common/refs.h"
#include "gst/scream/tx/settings.h"

struct _GstLidarScreamSinkPad {
  GstGhostPad parent;
};

G_DEFINE_TYPE(GstLidarScreamSinkPad, gst_lidar_scream_sink_pad, GST_TYPE_GHOST_PAD)

static void gst_lidar_scream_sink_pad_init(GstLidarScreamSinkPad*) {}

static void gst_lidar_scream_sink_pad_class_init(GstLidarScreamSinkPadClass* klass) {
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = [](GObject* o, guint, const GValue* v, GParamSpec* spec) {
    const lidar::gst::PadPtr target(gst_ghost_pad_get_target(GST_GHOST_PAD(o)));
    if (target) g_object_set_property(G_OBJECT(target.get()), spec->name, v);
  };
  object->get_property = [](GObject* o, guint, GValue* v, GParamSpec* spec) {
    const lidar::gst::PadPtr target(gst_ghost_pad_get_target(GST_GHOST_PAD(o)));
    if (target) g_object_get_property(G_OBJECT(target.get()), spec->name, v);
  };
  lidar::gst::InstallProperties(object, lidar::gst::TxPadPropertyTable());
}
