// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends the packets of a simulated sensor when they are due.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "src/base/time.h"
#include "src/tools/bench/ouster_replay/faults.h"
#include "src/tools/bench/ouster_replay/options.h"
#include "src/tools/bench/ouster_replay/packet_stream.h"
#include "src/tools/bench/ouster_replay/sensor.h"
#include "src/tools/common/udp_socket.h"

namespace lidar::tools {

/// Returns the time on the sensor's clock when the sensor starts to scan.
std::uint64_t ClockAtStart(const std::string& timestamp_mode, Time now);

class Player {
 public:
  using MakeStream = std::function<std::unique_ptr<PacketStream>(const ouster::Metadata&)>;

  /// Makes the first stream by `make_stream`. Throws std::runtime_error if that fails.
  Player(const ReplayOptions& options, const ouster::Metadata& metadata, Sensor* sensor,
         MakeStream make_stream);

  /// Sends the packets that are due, but only a few of them if many are due. Returns the time of
  /// the next call, or nothing at the end of the stream.
  std::optional<Time> Pump(Time now);
  /// Sends the packet that was held back for reordering, if there is one.
  void Finish() { SendHeld(sensor_.destination()); }
  /// May be called from any thread.
  FaultCounts counts() const;

 private:
  void Start(const ouster::Metadata& metadata, Time now);
  void RunEvents(Time now);
  void Send(const Sensor::Destination& to, const std::vector<OutPacket>& packets);
  void SendHeld(const Sensor::Destination& to);
  void CopyCounts();
  void SetDestination(const Sensor::Destination& to);

  const ReplayOptions options_;
  Sensor& sensor_;
  MakeStream make_stream_;
  std::unique_ptr<PacketStream> stream_;
  std::optional<UdpSocket> socket_;  // set once there is a destination
  Sensor::Destination destination_;
  Address lidar_address_;
  Address imu_address_;
  Time began_{};   // time at which the player was made
  Time origin_{};  // time 0 of the stream
  Time boots_until_{};
  std::optional<OutPacket> next_;
  std::size_t next_event_ = 0;
  FaultInjector injector_;
  mutable std::mutex mutex_;  // guards counts_
  FaultCounts counts_;
};

}  // namespace lidar::tools
