// SPDX-License-Identifier: LGPL-2.1-or-later
// A channel of the server, as its publisher and the server's thread share it.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "src/foxglove/protocol.h"

namespace lidar::web {

/// A message, as all clients get it.
struct Message {
  std::uint64_t unix_ns = 0;
  std::vector<std::uint8_t> payload;
};
using SharedMessage = std::shared_ptr<const Message>;

class Topic {
 public:
  explicit Topic(foxglove::Channel channel) : channel_(std::move(channel)) {}
  const foxglove::Channel& channel() const { return channel_; }
  /// How many messages may wait for a slow client; the oldest give way.
  std::size_t depth() const { return depth_; }
  void set_depth(std::size_t depth) { depth_ = depth > 0 ? depth : 1; }
  /// Whether anybody listens: else a message need not be made.
  bool wanted() const { return subscribers_ > 0; }
  void AddSubscribers(int n) { subscribers_ += n; }

 private:
  const foxglove::Channel channel_;
  std::atomic<std::size_t> depth_{1};
  std::atomic<int> subscribers_{0};
};
using SharedTopic = std::shared_ptr<Topic>;

}  // namespace lidar::web
