// SPDX-License-Identifier: LGPL-2.1-or-later
// rtplidarpay: slices of encoded clouds to RTP packets.
#pragma once
#include <gst/rtp/gstrtpbasepayload.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_RTP_PAY (gst_lidar_rtp_pay_get_type())
G_DECLARE_FINAL_TYPE(GstLidarRtpPay, gst_lidar_rtp_pay, GST_LIDAR, RTP_PAY, GstRTPBasePayload)
GST_ELEMENT_REGISTER_DECLARE(rtplidarpay)
G_END_DECLS
