// SPDX-License-Identifier: LGPL-2.1-or-later
// Congestion windows of background flows: Reno, Cubic and Prague.
#pragma once
#include <memory>

#include "src/base/time.h"

namespace lidar::scream::test {

enum class TcpKind {
  kReno,   ///< RFC 5681
  kCubic,  ///< RFC 9438
  kPrague  ///< draft-briscoe-iccrg-prague-congestion-control
};

/// A congestion window in packets. TcpSender does slow start for all kinds.
class TcpWindow {
 public:
  virtual ~TcpWindow() = default;
  /// A packet was acknowledged in congestion avoidance.
  virtual void OnAck(Time now, Duration rtt, bool ce) = 0;
  /// Packets were lost; called at most once a round trip.
  virtual void OnLoss() = 0;
  /// Acknowledgements are overdue.
  virtual void OnTimeout() = 0;
  /// The first mark ends slow start.
  virtual void OnFirstMark() { OnLoss(); }
  double window = 10;  ///< RFC 6928
};

std::unique_ptr<TcpWindow> MakeTcpWindow(TcpKind kind);

}  // namespace lidar::scream::test
