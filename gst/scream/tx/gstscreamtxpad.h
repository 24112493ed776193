// SPDX-License-Identifier: LGPL-2.1-or-later
// A sink pad of screamtx, with its stream's share and limits.
#pragma once
#include <gst/gst.h>

#include "gst/scream/tx/settings.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_SCREAM_TX_PAD (gst_lidar_scream_tx_pad_get_type())
G_DECLARE_FINAL_TYPE(GstLidarScreamTxPad, gst_lidar_scream_tx_pad, GST, LIDAR_SCREAM_TX_PAD, GstPad)
G_END_DECLS

namespace lidar::gst {
struct TxStream;

TxPadSettings PadSettings(GstPad* pad);
/// Returns the stream that screamtx keeps for `pad`. screamtx owns the stream.
TxStream* PadStream(GstPad* pad);
void SetPadStream(GstPad* pad, TxStream* stream);
}  // namespace lidar::gst
