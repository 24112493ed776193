// SPDX-License-Identifier: LGPL-2.1-or-later
// Reports that reach screamtx in another form than RTCP.
#pragma once
#include "gst/scream/tx/gstscreamtx.h"
#include "src/rtcp/ccfb.h"

namespace lidar::gst {

/// Handles a report as if it had arrived in RTCP, but with the full resolution of its times. Any
/// thread may call it.
void TxTakeReport(GstLidarScreamTx* tx, const rtcp::CongestionFeedback& report);

}  // namespace lidar::gst
