// SPDX-License-Identifier: LGPL-2.1-or-later
// One robot's receiver: a pipeline of its own, so that what it does harms no other.
#pragma once
#include <gst/gst.h>

#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "gst/common/refs.h"
#include "src/tools/edge/edge_config.h"
#include "src/tools/edge/exposition.h"

namespace lidar::edge {

/// Used by one thread.
class Receiver {
 public:
  using Clock = std::chrono::steady_clock;

  /// Throws std::runtime_error where an element is missing or a setting is wrong.
  Receiver(const EdgeConfig& config, const RobotConfig& robot);
  ~Receiver();
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  /// Reads what the pipeline says, and ends or begins it. To be called several times a second.
  void Poll(Clock::time_point now);

  const RobotConfig& robot() const { return robot_; }
  nlohmann::json Statistics() const;
  void AddTo(Exposition* exposition) const;

 private:
  enum class State { kWaiting, kReceiving, kResting };

  void Begin();
  void End();
  /// Nothing comes in for as long.
  void Rest(Clock::time_point now, std::chrono::seconds pause, const std::string& why);
  bool ReadBus(Clock::time_point now);
  void Watch(Clock::time_point now);
  guint64 BytesReceived() const;
  gst::StructurePtr StatsOf(const char* element) const;

  const EdgeConfig& config_;
  const RobotConfig& robot_;
  gst::ElementPtr pipeline_;
  State state_ = State::kWaiting;
  Clock::time_point begin_at_{};               // of a rest's end
  std::optional<Clock::time_point> watch_at_;  // the rate is taken then
  Clock::time_point heard_at_{};
  guint64 bytes_ = 0;  // when the rate was last taken
  int fast_seconds_ = 0;
  std::uint64_t sessions_ = 0;
  std::uint64_t failures_ = 0;
  std::uint64_t penalties_ = 0;
  std::string last_error_;
};

}  // namespace lidar::edge
