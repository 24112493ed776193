// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/slice_service.h"

#include <algorithm>

namespace lidar::web {
namespace {

Time Now() { return Time{std::chrono::microseconds(g_get_monotonic_time())}; }

}  // namespace

void SliceService::Subscribe(Client* client, const SharedTopic& topic, std::uint32_t subscription) {
  Stream& stream = streams_[topic->channel().id];
  stream.topic = topic;
  stream.viewers.insert_or_assign(client, Viewer{subscription, viewer::Feed(max_bitrate_)});
}

void SliceService::Unsubscribe(Client* client, std::uint32_t channel) {
  const auto stream = streams_.find(channel);
  if (stream == streams_.end()) return;
  stream->second.viewers.erase(client);
  if (!stream->second.viewers.empty()) return;
  stream->second.topic->set_wants_recoded(false);
  streams_.erase(stream);
}

void SliceService::Forget(const Client* client) {
  for (auto it = streams_.begin(); it != streams_.end();) {
    const auto channel = (it++)->first;
    Unsubscribe(const_cast<Client*>(client), channel);
  }
}

void SliceService::Deliver(std::uint32_t channel, const SharedSliceMessage& slice) {
  const auto stream = streams_.find(channel);
  if (stream == streams_.end()) return;
  stream->second.recent.Add(slice);
  ServeAll(&stream->second);
}

void SliceService::OnRequest(Client* client, const foxglove::Request& request) {
  for (auto& [channel, stream] : streams_) {
    const auto viewer = stream.viewers.find(client);
    if (viewer == stream.viewers.end() || viewer->second.subscription != request.subscription)
      continue;
    if (request.kind == foxglove::Request::Kind::kLacksReference)
      viewer->second.feed.OnLacksReference();
    else
      viewer->second.feed.OnDrawn(Now(), {request.slice.scan, request.slice.index});
    return Serve(&stream, client, &viewer->second);
  }
}

bool SliceService::IsLate(Client* client) const {
  return std::any_of(streams_.begin(), streams_.end(), [client](const auto& s) {
    const auto viewer = s.second.viewers.find(client);
    return viewer != s.second.viewers.end() && viewer->second.feed.IsLate(Now());
  });
}

void SliceService::Tick() {
  for (auto& [channel, stream] : streams_) ServeAll(&stream);
}

void SliceService::Serve(Stream* stream, Client* client, Viewer* viewer) {
  const std::uint64_t before = viewer->feed.scans_skipped();
  for (const viewer::SharedSlice& slice : viewer->feed.Take(Now(), stream->recent))
    client->SendSlice(stream->topic->channel().id, viewer->subscription,
                      std::static_pointer_cast<const SliceMessage>(slice));
  scans_skipped_ += viewer->feed.scans_skipped() - before;
}

void SliceService::ServeAll(Stream* stream) {
  bool wants_recoded = false;
  for (auto& [client, viewer] : stream->viewers) {
    if (client->closed()) continue;
    Serve(stream, client, &viewer);
    wants_recoded = wants_recoded || viewer.feed.wants_recoded();
  }
  stream->topic->set_wants_recoded(wants_recoded);
}

}  // namespace lidar::web
