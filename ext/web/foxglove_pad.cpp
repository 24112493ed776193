// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/foxglove_pad.h"

#include "ext/web/foxglove_input.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"

struct _GstLidarFoxglovePad {
  GstGhostPad parent;
};

G_DEFINE_TYPE(GstLidarFoxglovePad, gst_lidar_foxglove_pad, GST_TYPE_GHOST_PAD)

namespace {

using lidar::gst::ElementPtr;
using lidar::web::InputSettings;
using lidar::web::SetSettings;
using lidar::web::SettingsOf;

const std::array<lidar::gst::Property<InputSettings>, 2> kProperties = {{
    {"topic",
     "Topic of the channel; NULL: /points, /points_draco or /pose, with the number of the pad from "
     "the second on",
     &InputSettings::topic},
    {"frame-id", "Frame of the clouds, or of the sensor whose poses come",
     &InputSettings::frame_id},
}};

void SetPadProperty(GObject* object, guint id, const GValue* value, GParamSpec*) {
  const ElementPtr input(lidar::web::InputOf(GST_PAD(object)));
  if (!input) return;
  InputSettings settings = SettingsOf(GST_LIDAR_FOXGLOVE_INPUT(input.get()));
  lidar::gst::SetProperty(settings, kProperties[id - 1], value);
  SetSettings(GST_LIDAR_FOXGLOVE_INPUT(input.get()), settings);
}

void GetPadProperty(GObject* object, guint id, GValue* value, GParamSpec*) {
  const ElementPtr input(lidar::web::InputOf(GST_PAD(object)));
  const InputSettings settings =
      input ? SettingsOf(GST_LIDAR_FOXGLOVE_INPUT(input.get())) : InputSettings{};
  lidar::gst::GetProperty(settings, kProperties[id - 1], value);
}

}  // namespace

GstElement* lidar::web::InputOf(GstPad* pad) {
  const gst::PadPtr target(gst_ghost_pad_get_target(GST_GHOST_PAD(pad)));
  return target ? gst_pad_get_parent_element(target.get()) : nullptr;
}

static void gst_lidar_foxglove_pad_init(GstLidarFoxglovePad*) {}

static void gst_lidar_foxglove_pad_class_init(GstLidarFoxglovePadClass* klass) {
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = SetPadProperty;
  object->get_property = GetPadProperty;
  lidar::gst::InstallProperties(object, kProperties);
}
