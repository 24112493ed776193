// SPDX-License-Identifier: LGPL-2.1-or-later
// Pad probes that handle each packet, whether it is pushed alone or in a list.
#pragma once
#include <gst/gst.h>

#include "gst/common/refs.h"

namespace lidar::gst {

constexpr auto kPacketProbe =
    static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST);

/// Replaces each packet by the result of `map`. If the result is NULL, the packet is dropped.
template <class Map>
GstPadProbeReturn MapPackets(GstPadProbeInfo* info, Map map) {
  if ((info->type & GST_PAD_PROBE_TYPE_BUFFER) != 0) {
    info->data = map(BufferPtr(GST_PAD_PROBE_INFO_BUFFER(info))).release();
    return info->data != nullptr ? GST_PAD_PROBE_OK : GST_PAD_PROBE_HANDLED;
  }
  const BufferListPtr list(GST_PAD_PROBE_INFO_BUFFER_LIST(info));
  const guint n = gst_buffer_list_length(list.get());
  GstBufferList* out = gst_buffer_list_new_sized(n);
  for (guint i = 0; i < n; ++i)
    if (BufferPtr packet = map(BufferPtr(gst_buffer_ref(gst_buffer_list_get(list.get(), i)))))
      gst_buffer_list_add(out, packet.release());
  info->data = out;
  return gst_buffer_list_length(out) > 0 ? GST_PAD_PROBE_OK : GST_PAD_PROBE_DROP;
}

}  // namespace lidar::gst
