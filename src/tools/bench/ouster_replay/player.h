// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends a sensor's packets when they are due.
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

/// Returns the reading of the sensor's clock at the time when it starts to scan.
std::uint64_t ClockAtStart(const std::string& timestamp_mode, Time now);

class Player {
 public:
  using MakeStream = std::function<std::unique_ptr<PacketStream>(const ouster::Metadata&)>;

  /// Throws std::runtime_error.
  Player(const ReplayOptions& options, const ouster::Metadata& metadata, Sensor* sensor,
         MakeStream make_stream);

  /// Sends what is due; returns the time of the next call, or nothing at the end.
  std::optional<Time> Pump(Time now);
  /// Sends the packet that is held back to be reordered, if there is one.
  void Finish() { SendHeld(sensor_.destination()); }
  /// Any thread may call this.
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
  std::optional<UdpSocket> socket_;  // once there is a destination
  Sensor::Destination destination_;
  Address lidar_address_;
  Address imu_address_;
  Time began_{};   // of the program
  Time origin_{};  // of the stream
  Time boots_until_{};
  std::optional<OutPacket> next_;
  std::size_t next_event_ = 0;
  FaultInjector injector_;
  mutable std::mutex mutex_;  // guards counts_
  FaultCounts counts_;
};

}  // namespace lidar::tools
