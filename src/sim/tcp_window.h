// SPDX-License-Identifier: LGPL-2.1-or-later
// The congestion windows of background flows: Reno, Cubic and Prague.
#pragma once
#include <memory>

#include "src/base/time.h"

namespace lidar::scream::test {

enum class TcpKind {
  kReno,   ///< RFC 5681
  kCubic,  ///< RFC 9438
  kPrague  ///< draft-briscoe-iccrg-prague-congestion-control
};

/// A congestion window in packets. TcpSender does the slow start for all kinds.
class TcpWindow {
 public:
  virtual ~TcpWindow() = default;
  /// Called when a packet is acknowledged after slow start.
  virtual void OnAck(Time now, Duration rtt, bool ce) = 0;
  /// Called when packets are lost, but at most once per round trip.
  virtual void OnLoss() = 0;
  /// Called when acknowledgements are overdue.
  virtual void OnTimeout() = 0;
  /// Called for the first mark, which ends slow start.
  virtual void OnFirstMark() { OnLoss(); }
  double window = 10;  ///< initial window of RFC 6928
};

std::unique_ptr<TcpWindow> MakeTcpWindow(TcpKind kind);

}  // namespace lidar::scream::test
