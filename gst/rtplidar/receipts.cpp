// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/rtplidar/receipts.h"

#include <gst/rtp/gstrtpbuffer.h>

#include "gst/lidar/gstlidar.h"

namespace lidar::gst {

void Receipts::OnBuffer(GstBuffer* buffer) {
  GstLidarSlice slice{};
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  if (!gst_lidar_buffer_get_slice(buffer, &slice) ||
      !gst_rtp_buffer_map(buffer, GST_MAP_READ, &rtp)) {
    return;
  }
  const rtp::Delivery::Packet packet{gst_rtp_buffer_get_ssrc(&rtp),
                                     gst_rtp_buffer_get_seq(&rtp),
                                     {slice.scan_id, slice.slice_index},
                                     gst_rtp_buffer_get_marker(&rtp) != FALSE};
  gst_rtp_buffer_unmap(&rtp);
  std::lock_guard lock(mutex_);
  delivery_.OnSent(packet);
}

void Receipts::Watch(GstPad* src) {
  const auto look = [](GstPad*, GstPadProbeInfo* info, gpointer self) -> GstPadProbeReturn {
    auto* receipts = static_cast<Receipts*>(self);
    if ((info->type & GST_PAD_PROBE_TYPE_BUFFER_LIST) == 0) {
      receipts->OnBuffer(GST_PAD_PROBE_INFO_BUFFER(info));
      return GST_PAD_PROBE_OK;
    }
    GstBufferList* list = GST_PAD_PROBE_INFO_BUFFER_LIST(info);
    for (guint i = 0; i < gst_buffer_list_length(list); ++i)
      receipts->OnBuffer(gst_buffer_list_get(list, i));
    return GST_PAD_PROBE_OK;
  };
  constexpr auto kBoth =
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST);
  gst_pad_add_probe(src, kBoth, look, this, nullptr);
}

bool Receipts::OnEvent(GstEvent* event, GstEvent** upstream) {
  *upstream = nullptr;
  GstLidarPacketsReceived packets{};
  if (!gst_lidar_event_parse_packets_received(event, &packets)) return false;
  GstLidarSlicesReceived slices{packets.receiver, 0, {}};
  std::lock_guard lock(mutex_);
  for (guint i = 0; i < packets.count; ++i) {
    const GstLidarSequenceRange& range = packets.ranges[i];
    for (const auto& slice : delivery_.OnReceived(packets.ssrc, range.first, range.last)) {
      if (slices.count == GST_LIDAR_MAX_RECEIVED) break;
      slices.slices[slices.count++] = {slice.scan_id, slice.index};
    }
  }
  // An event is sent even if it lists no slices, because the encoder counts the receivers.
  *upstream = gst_lidar_event_new_slices_received(&slices);
  return true;
}

}  // namespace lidar::gst
