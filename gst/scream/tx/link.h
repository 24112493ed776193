// SPDX-License-Identifier: LGPL-2.1-or-later
// The owner of a screamtx that is one of several links of a stream.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <optional>

#include "gst/scream/tx/gstscreamtx.h"
#include "src/scream/controller.h"
#include "src/scream/feedback/ccfb.h"

namespace lidar::gst {

/// Called with the lock of screamtx held, from any of its threads.
class TxLink {
 public:
  virtual ~TxLink() = default;
  /// Whether a packet is still to be sent by this link.
  virtual bool Wants(Time now, guint32 ssrc, guint16 seq) = 0;
  /// A packet leaves; under this number the controller counts it.
  virtual guint16 OnSent(Time now, guint32 ssrc, guint16 seq) = 0;
  /// A packet was thrown away.
  virtual void OnDropped(Time now, guint32 ssrc, guint16 seq) = 0;
  /// Converts a report into these numbers; nothing if it names packets that this link never sent.
  virtual std::optional<scream::CongestionFeedback> OnFeedback(
      Time now, const scream::CongestionFeedback& report) = 0;
  /// Bytes at the end of each packet that are no media.
  virtual gsize trailer() const = 0;
  /// Gets the controller's view of the last report.
  virtual void OnPath(const scream::Statistics& statistics) = 0;
};

/// Call below READY. Null: the only link.
void TxSetLink(GstLidarScreamTx* tx, std::shared_ptr<TxLink> link);

}  // namespace lidar::gst
