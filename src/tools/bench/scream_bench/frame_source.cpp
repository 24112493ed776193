// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/scream_bench/frame_source.h"

#include <gst/rtp/gstrtpbuffer.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lidar::tools {

DataSize FrameSizes::Next(DataRate rate) {
  const double nominal = rate.bits_per_second() / 8 * Seconds(period_);
  double factor = 1;
  if (jitter_ > 0) factor += std::uniform_real_distribution<double>(-jitter_, jitter_)(random_);
  const double wanted = nominal * factor + carry_bytes_;
  const double size = std::max(0.0, std::floor(wanted));
  carry_bytes_ = std::clamp(wanted - size, -nominal, nominal);
  return DataSize::Bytes(static_cast<std::int64_t>(size));
}

gst::BufferListPtr FramePacketizer::Packetize(DataSize payload, Duration created,
                                              GstClockTime pts) {
  constexpr std::int64_t kRtpHeader = 12;
  const std::int64_t room = std::int64_t{mtu_} - kRtpHeader;
  const std::int64_t total = payload.bytes();
  const std::int64_t packets = (total + room - 1) / room;
  gst::BufferListPtr list(
      gst_buffer_list_new_sized(static_cast<guint>(std::max<std::int64_t>(packets, 1))));
  for (std::int64_t i = 0; i < packets; ++i) {
    const std::int64_t size = total * (i + 1) / packets - total * i / packets;
    GstBuffer* packet = gst_rtp_buffer_new_allocate(static_cast<guint>(size), 0, 0);
    GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
    gst_rtp_buffer_map(packet, GST_MAP_WRITE, &rtp);
    std::memset(gst_rtp_buffer_get_payload(&rtp), 0, static_cast<std::size_t>(size));
    gst_rtp_buffer_set_ssrc(&rtp, kSsrc);
    gst_rtp_buffer_set_payload_type(&rtp, kPayloadType);
    gst_rtp_buffer_set_seq(&rtp, next_sequence_++);
    gst_rtp_buffer_set_timestamp(&rtp, RtpTimestamp(created));
    gst_rtp_buffer_set_marker(&rtp, i + 1 == packets);
    gst_rtp_buffer_unmap(&rtp);
    GST_BUFFER_PTS(packet) = pts;
    gst_buffer_list_add(list.get(), packet);
  }
  return list;
}

}  // namespace lidar::tools
