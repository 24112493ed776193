// SPDX-License-Identifier: LGPL-2.1-or-later
// The queue of messages to a client. It keeps the newest messages of each channel.
#pragma once
#include <algorithm>
#include <deque>
#include <optional>
#include <set>

#include "ext/web/topic.h"

namespace lidar::web {

/// A queue of messages. Only one thread at a time may use it.
class Outbox {
 public:
  struct Item {
    std::uint32_t channel_id = 0;
    std::uint32_t subscription_id = 0;
    SharedMessage message;
  };

  /// Queues a message. If more than `depth` messages of its channel wait, drops the oldest of them,
  /// and also the messages that continue a dropped message. Returns the number of dropped messages,
  /// which may include the new one.
  std::size_t Push(Item item, std::size_t depth) {
    const std::uint32_t channel = item.channel_id;
    if (!item.message->continues)
      whole_.insert(channel);
    else if (whole_.count(channel) == 0)
      return 1;
    items_.push_back(std::move(item));
    return Count(channel) > depth ? DropOldest(channel) : 0;
  }
  std::optional<Item> Pop() {
    if (items_.empty()) return std::nullopt;
    Item item = std::move(items_.front());
    items_.pop_front();
    return item;
  }
  /// Notes that a message of the channel is not sent. Messages that continue it are then dropped.
  void Skip(std::uint32_t channel) { whole_.erase(channel); }
  void Forget(std::uint32_t channel) {
    Skip(channel);
    while (Count(channel) > 0) items_.erase(Find(channel));
  }

 private:
  std::size_t DropOldest(std::uint32_t channel) {
    std::size_t dropped = 0;
    for (auto it = Find(channel); it != items_.end(); it = Find(channel), ++dropped) {
      if (dropped > 0 && !it->message->continues) return dropped;
      items_.erase(it);
    }
    Skip(channel);
    return dropped;
  }
  std::deque<Item>::iterator Find(std::uint32_t channel) {
    return std::find_if(items_.begin(), items_.end(),
                        [channel](const Item& i) { return i.channel_id == channel; });
  }
  std::size_t Count(std::uint32_t channel) const {
    return static_cast<std::size_t>(
        std::count_if(items_.begin(), items_.end(),
                      [channel](const Item& i) { return i.channel_id == channel; }));
  }

  std::deque<Item> items_;
  std::set<std::uint32_t> whole_;  // channels whose last message was not dropped
};

}  // namespace lidar::web
