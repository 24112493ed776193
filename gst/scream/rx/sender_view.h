// SPDX-License-Identifier: LGPL-2.1-or-later
// The sender's last report about itself and the path.
#pragma once
#include <gst/gst.h>

#include "gst/common/refs.h"
#include "src/base/time.h"
#include "src/rtcp/sender_report.h"

namespace lidar::gst {

class SenderView {
 public:
  /// Stores the report if it is newer than the last one.
  void OnReport(Time now, const rtcp::SenderReport& report);
  /// Adds the fields sender-... to `stats`; all are 0 before the first report.
  void AddStats(Time now, GstStructure* stats) const;
  void Reset() { *this = {}; }

 private:
  rtcp::SenderReport newest_;
  Time arrived_{};
  guint64 reports_ = 0;
};

}  // namespace lidar::gst
