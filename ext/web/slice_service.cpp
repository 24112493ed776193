// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/slice_service.h"

#include <algorithm>

namespace lidar::web {
namespace {

Time Now() { return Time{std::chrono::microseconds(g_get_monotonic_time())}; }

/// The interval at which a growing recording is checked while it has viewers.
constexpr Duration kLook = std::chrono::seconds(2);

std::size_t BytesOf(const std::deque<viewer::SharedSlice>& slices) {
  std::size_t sum = 0;
  for (const viewer::SharedSlice& slice : slices)
    sum += static_cast<std::size_t>(slice->size.bytes());
  return sum;
}

}  // namespace

SliceService::SliceService(DataRate max_bitrate, std::function<void(std::string)> warn)
    : max_bitrate_(max_bitrate),
      warn_(std::move(warn)),
      reader_([this](const RecordingReader::Job& job, const Recording::Piece& piece) {
        OnPiece(job, piece);
      }) {}

void SliceService::Subscribe(Client* client, const SharedTopic& topic, std::uint32_t subscription) {
  Stream& stream = streams_[topic->channel().id];
  stream.topic = topic;
  const auto before = stream.viewers.find(client);
  if (before != stream.viewers.end()) EndReplay(&before->second);
  stream.viewers.insert_or_assign(client, Viewer{subscription, viewer::Feed(max_bitrate_)});
  Look(&stream);
}

void SliceService::Unsubscribe(Client* client, std::uint32_t channel) {
  const auto stream = streams_.find(channel);
  if (stream == streams_.end()) return;
  const auto viewer = stream->second.viewers.find(client);
  if (viewer != stream->second.viewers.end()) {
    EndReplay(&viewer->second);
    stream->second.viewers.erase(viewer);
  }
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
    using Kind = foxglove::Request::Kind;
    Viewer& asker = viewer->second;
    if (request.kind == Kind::kLacksReference) asker.feed.OnLacksReference();
    if (request.kind == Kind::kDrawn)
      asker.feed.OnDrawn(Now(), {request.slice.scan, request.slice.index});
    if (request.kind == Kind::kReplay) BeginReplay(request, stream, &asker);
    if (request.kind == Kind::kLive) EndReplay(&asker);
    return Serve(&stream, client, &asker);
  }
}

void SliceService::Look(Stream* stream) {
  if (!stream->topic->recording()) return;
  stream->looked_at = Now();
  reader_.Ask({0, stream->topic->recording(), RecordingReader::Kind::kLook, 0});
}

void SliceService::BeginReplay(const foxglove::Request& request, const Stream& stream,
                               Viewer* viewer) {
  const auto& recording = stream.topic->recording();
  if (!recording) return;
  EndReplay(viewer);
  Replay replay;
  replay.number = request.number;
  viewer->replay = std::move(replay);
  viewer->asker = next_asker_++;
  reader_.Ask({viewer->asker, recording, RecordingReader::Kind::kJump, request.time_ns});
}

void SliceService::EndReplay(Viewer* viewer) {
  if (viewer->replay) reader_.Forget(viewer->asker);
  viewer->replay.reset();
}

void SliceService::OnPiece(const RecordingReader::Job& job, const Recording::Piece& piece) {
  for (auto& [channel, stream] : streams_) {
    if (stream.topic->recording() != job.recording) continue;
    Learn(piece, &stream);
    for (auto& [client, viewer] : stream.viewers) {
      if (job.asker == 0) Describe(stream, viewer, client);
      if (!viewer.replay || viewer.asker != job.asker) continue;
      Replay& replay = *viewer.replay;
      replay.is_reading = false;
      replay.ended = piece.ended;
      replay.next = piece.next;
      replay.damaged += piece.damaged;
      replay.waiting.insert(replay.waiting.end(), piece.slices.begin(), piece.slices.end());
      if (piece.last_ns != 0) replay.last_ns = piece.last_ns;
      Describe(stream, viewer, client);
      return ServeReplay(stream, client, &viewer);
    }
  }
}

void SliceService::Learn(const Recording::Piece& piece, Stream* stream) {
  stream->from_ns = piece.from_ns;
  stream->to_ns = piece.to_ns;
  if (piece.why != stream->why && !piece.why.empty() && warn_)
    warn_("Viewers cannot go back into the recording: " + piece.why + ".");
  stream->why = piece.why;
}

void SliceService::Describe(const Stream& stream, const Viewer& viewer, Client* client) {
  foxglove::RecordingStatus status;
  status.subscription = viewer.subscription;
  status.from_ns = stream.from_ns;
  status.to_ns = stream.to_ns;
  if (viewer.replay) {
    status.number = viewer.replay->number;
    status.damaged = viewer.replay->damaged;
    if (viewer.replay->ended) status.end_ns = viewer.replay->last_ns;
  }
  client->SendText(foxglove::Describe(status));
}

void SliceService::ServeReplay(const Stream& stream, Client* client, Viewer* viewer) {
  Replay& replay = *viewer->replay;
  if (client->closed()) return;
  for (const viewer::SharedSlice& slice : viewer->feed.TakeRecorded(Now(), &replay.waiting))
    client->SendSlice(stream.topic->channel().id, viewer->subscription,
                      std::static_pointer_cast<const SliceMessage>(slice), replay.number);
  if (replay.is_reading || replay.ended || BytesOf(replay.waiting) > Recording::kPiece) return;
  replay.is_reading = true;
  reader_.Ask(
      {viewer->asker, stream.topic->recording(), RecordingReader::Kind::kGoOn, replay.next});
}

bool SliceService::IsLate(Client* client) const {
  return std::any_of(streams_.begin(), streams_.end(), [client](const auto& s) {
    const auto viewer = s.second.viewers.find(client);
    return viewer != s.second.viewers.end() && viewer->second.feed.IsLate(Now());
  });
}

void SliceService::Tick() {
  for (auto& [channel, stream] : streams_) {
    ServeAll(&stream);
    if (Now() - stream.looked_at > kLook) Look(&stream);
  }
}

void SliceService::Serve(Stream* stream, Client* client, Viewer* viewer) {
  if (viewer->replay) return ServeReplay(*stream, client, viewer);
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
    wants_recoded = wants_recoded || (!viewer.replay && viewer.feed.wants_recoded());
  }
  stream->topic->set_wants_recoded(wants_recoded);
}

}  // namespace lidar::web
