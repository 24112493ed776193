// SPDX-License-Identifier: LGPL-2.1-or-later
// A channel of the server, which its publisher and the server's thread share.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "src/codec/slice_links.h"
#include "src/foxglove/protocol.h"
#include "src/viewer/feed.h"

namespace lidar::web {

/// A message that is the same for all clients.
struct Message {
  std::uint64_t unix_ns = 0;
  std::vector<std::uint8_t> payload;
  // If true, the message is useless without the message before it, as a video frame that is not a
  // key frame.
  bool continues = false;
};
using SharedMessage = std::shared_ptr<const Message>;

/// A coded slice for viewers. In a replay it may also be a pose between two slices.
struct SliceMessage final : viewer::Slice {
  std::uint64_t unix_ns = 0;
  std::uint32_t first_column = 0;
  // If true, the payload is a foxglove.FrameTransform, and `id` is the id of the slice before it.
  bool is_pose = false;
  std::vector<std::uint8_t> payload;

  /// Sets `size`, and the links to other slices, from the payload. Returns false if no decoder
  /// accepts the payload.
  bool ReadLinks(bool has_ranges) {
    size = DataSize::Bytes(static_cast<std::int64_t>(payload.size()));
    if (!has_ranges) return true;
    auto links = codec::LinksOf({payload.data(), payload.size()});
    if (!links) return false;
    blocks = *std::move(links);
    return true;
  }
};
using SharedSliceMessage = std::shared_ptr<const SliceMessage>;

class Recording;

class Topic {
 public:
  /// Viewers may request earlier slices from `recording`. If it is null, there is no recording.
  explicit Topic(foxglove::Channel channel, std::shared_ptr<Recording> recording = {})
      : channel_(std::move(channel)), recording_(std::move(recording)) {}
  const foxglove::Channel& channel() const { return channel_; }
  const std::shared_ptr<Recording>& recording() const { return recording_; }
  /// Returns the number of messages that may wait for a slow client. If there are more, the oldest
  /// are dropped.
  std::size_t depth() const { return depth_; }
  void set_depth(std::size_t depth) { depth_ = depth > 0 ? depth : 1; }
  /// Returns true if the topic has subscribers.
  bool wanted() const { return subscribers_ > 0; }
  void AddSubscribers(int n) {
    subscribers_ += n;
    if (n > 0) TellOfWish();
  }
  /// Returns true if a viewer needs slices that can be decoded without other slices.
  bool wants_recoded() const { return wants_recoded_; }
  void set_wants_recoded(bool wanted) {
    if (wants_recoded_.exchange(wanted) != wanted && wanted) TellOfWish();
  }
  /// Sets a function that the server's thread calls when a subscriber is added, or when a viewer
  /// begins to need recoded slices. Null removes the function.
  void set_on_wish(std::function<void()> tell) {
    const std::lock_guard lock(mutex_);
    on_wish_ = std::move(tell);
  }

 private:
  void TellOfWish() {
    const std::lock_guard lock(mutex_);
    if (on_wish_) on_wish_();
  }

  const foxglove::Channel channel_;
  const std::shared_ptr<Recording> recording_;
  std::mutex mutex_;
  std::function<void()> on_wish_;
  std::atomic<std::size_t> depth_{1};
  std::atomic<int> subscribers_{0};
  std::atomic<bool> wants_recoded_{false};
};
using SharedTopic = std::shared_ptr<Topic>;

/// Returns a text for users that says why the topic cannot be opened.
inline std::string TopicInUse(const std::string& name) {
  return "the topic \"" + name +
         "\" is already used for other data; set the property topic of one of its pads";
}

}  // namespace lidar::web
