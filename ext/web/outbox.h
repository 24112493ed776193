// SPDX-License-Identifier: LGPL-2.1-or-later
// What waits for one client: of each channel the newest messages, never more.
#pragma once
#include <algorithm>
#include <deque>
#include <optional>

#include "ext/web/topic.h"

namespace lidar::web {

/// For one thread at a time.
class Outbox {
 public:
  struct Item {
    std::uint32_t channel_id = 0;
    std::uint32_t subscription_id = 0;
    SharedMessage message;
  };

  /// True where an older message of the channel gave way: `depth` of them are kept.
  bool Push(Item item, std::size_t depth) {
    const std::uint32_t channel = item.channel_id;
    items_.push_back(std::move(item));
    if (Count(channel) <= depth) return false;
    items_.erase(Find(channel));
    return true;
  }
  std::optional<Item> Pop() {
    if (items_.empty()) return std::nullopt;
    Item item = std::move(items_.front());
    items_.pop_front();
    return item;
  }
  void Forget(std::uint32_t channel) {
    while (Count(channel) > 0) items_.erase(Find(channel));
  }

 private:
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
};

}  // namespace lidar::web
