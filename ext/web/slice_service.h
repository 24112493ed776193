// SPDX-License-Identifier: LGPL-2.1-or-later
// Gives viewers the slices that their pace allows. Lives in the server's thread.
#pragma once
#include <map>

#include "ext/web/client.h"
#include "ext/web/topic.h"

namespace lidar::web {

class SliceService {
 public:
  /// 0: no limit.
  explicit SliceService(DataRate max_bitrate) : max_bitrate_(max_bitrate) {}

  void Subscribe(Client* client, const SharedTopic& topic, std::uint32_t subscription);
  void Unsubscribe(Client* client, std::uint32_t channel);
  /// The client has left, or the channel was removed.
  void Forget(const Client* client);
  void ForgetChannel(std::uint32_t channel) { streams_.erase(channel); }

  void Deliver(std::uint32_t channel, const SharedSliceMessage& slice);
  /// `request` is of the kind kDrawn or kLacksReference.
  void OnRequest(Client* client, const foxglove::Request& request);
  /// Call it regularly: sends what had to wait.
  void Tick();

  /// Returns true if the client did not draw in time: its link has no room.
  bool IsLate(Client* client) const;

  /// Scans that slow viewers missed.
  std::uint64_t scans_skipped() const { return scans_skipped_; }

 private:
  struct Viewer {
    std::uint32_t subscription = 0;
    viewer::Feed feed;
  };
  struct Stream {
    SharedTopic topic;
    viewer::RecentScans recent;
    std::map<Client*, Viewer> viewers;
  };
  void Serve(Stream* stream, Client* client, Viewer* viewer);
  void ServeAll(Stream* stream);

  const DataRate max_bitrate_;
  std::map<std::uint32_t, Stream> streams_;  // by channel, with viewers
  std::uint64_t scans_skipped_ = 0;
};

}  // namespace lidar::web
