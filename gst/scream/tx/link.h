// SPDX-License-Identifier: LGPL-2.1-or-later
// The owner of a screamtx that is one of several links of a stream.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <optional>

#include "gst/scream/tx/gstscreamtx.h"
#include "src/rtcp/ccfb.h"
#include "src/scream/controller.h"

namespace lidar::gst {

/// screamtx calls the methods with its lock held, from any of its threads.
class TxLink {
 public:
  virtual ~TxLink() = default;
  /// Returns true if this link must still send the packet.
  virtual bool Wants(Time now, guint32 ssrc, guint16 seq) = 0;
  /// A packet leaves. Returns the number under which the controller counts it.
  virtual guint16 OnSent(Time now, guint32 ssrc, guint16 seq) = 0;
  /// A packet was dropped. Returns true if another link delivered it.
  virtual bool OnDropped(Time now, guint32 ssrc, guint16 seq) = 0;
  /// Converts a report to the numbers of OnSent(). Returns nothing if it names packets that this
  /// link never sent.
  virtual std::optional<rtcp::CongestionFeedback> OnFeedback(
      Time now, const rtcp::CongestionFeedback& report) = 0;
  /// Bytes at the end of each packet that are not media.
  virtual gsize trailer() const = 0;
  /// Takes the controller's statistics after each report.
  virtual void OnPath(const scream::Statistics& statistics) = 0;
};

/// Sets the owner (null: a single link). Call it below READY.
void TxSetLink(GstLidarScreamTx* tx, std::shared_ptr<TxLink> link);

}  // namespace lidar::gst
