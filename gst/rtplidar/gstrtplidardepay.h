// SPDX-License-Identifier: LGPL-2.1-or-later
// rtplidardepay: RTP packets back to slices of encoded clouds.
#pragma once
#include <gst/rtp/gstrtpbasedepayload.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_RTP_DEPAY (gst_lidar_rtp_depay_get_type())
G_DECLARE_FINAL_TYPE(GstLidarRtpDepay, gst_lidar_rtp_depay, GST_LIDAR, RTP_DEPAY,
                     GstRTPBaseDepayload)
GST_ELEMENT_REGISTER_DECLARE(rtplidardepay)
G_END_DECLS
