// SPDX-License-Identifier: LGPL-2.1-or-later
// Reports that reach screamtx in another form than RTCP.
#pragma once
#include "gst/scream/tx/gstscreamtx.h"
#include "src/scream/feedback/ccfb.h"

namespace lidar::gst {

/// As if it had come in RTCP, but with the whole resolution of its times. For any thread.
void TxTakeReport(GstLidarScreamTx* tx, const scream::CongestionFeedback& report);

}  // namespace lidar::gst
