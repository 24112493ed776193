// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/gstscreamtxpad.h"

#include "gst/scream/tx/private.h"

struct _GstLidarScreamTxPad {
  GstPad parent;
  lidar::gst::TxPadSettings* settings;  // guarded by the object lock
  lidar::gst::TxStream* stream;
};

G_DEFINE_TYPE(GstLidarScreamTxPad, gst_lidar_scream_tx_pad, GST_TYPE_PAD)

namespace lidar::gst {

TxPadSettings PadSettings(GstPad* pad) {
  GST_OBJECT_LOCK(pad);
  const TxPadSettings settings = *GST_LIDAR_SCREAM_TX_PAD(pad)->settings;
  GST_OBJECT_UNLOCK(pad);
  return settings;
}

TxStream* PadStream(GstPad* pad) { return GST_LIDAR_SCREAM_TX_PAD(pad)->stream; }
void SetPadStream(GstPad* pad, TxStream* stream) { GST_LIDAR_SCREAM_TX_PAD(pad)->stream = stream; }

}  // namespace lidar::gst

static void gst_lidar_scream_tx_pad_init(GstLidarScreamTxPad* self) {
  self->settings = new lidar::gst::TxPadSettings;
  self->stream = nullptr;
}

static void SetPropertyVfunc(GObject* o, guint id, const GValue* v, GParamSpec*) {
  auto* self = GST_LIDAR_SCREAM_TX_PAD(o);
  GST_OBJECT_LOCK(self);
  lidar::gst::SetProperty(*self->settings, lidar::gst::TxPadPropertyTable()[id - 1], v);
  GST_OBJECT_UNLOCK(self);
  if (GstObject* parent = gst_object_get_parent(GST_OBJECT(o))) {
    lidar::gst::SettingsChanged(GST_LIDAR_SCREAM_TX(parent));
    gst_object_unref(parent);
  }
}

static void GetPropertyVfunc(GObject* o, guint id, GValue* v, GParamSpec*) {
  lidar::gst::GetProperty(lidar::gst::PadSettings(GST_PAD(o)),
                          lidar::gst::TxPadPropertyTable()[id - 1], v);
}

static void gst_lidar_scream_tx_pad_class_init(GstLidarScreamTxPadClass* klass) {
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = SetPropertyVfunc;
  object->get_property = GetPropertyVfunc;
  object->finalize = [](GObject* o) {
    delete GST_LIDAR_SCREAM_TX_PAD(o)->settings;
    G_OBJECT_CLASS(gst_lidar_scream_tx_pad_parent_class)->finalize(o);
  };
  lidar::gst::InstallProperties(object, lidar::gst::TxPadPropertyTable());
}
