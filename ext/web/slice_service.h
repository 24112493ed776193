// SPDX-License-Identifier: LGPL-2.1-or-later
// Gives viewers the slices that their pace allows: live ones, or those of a recording. Lives in the
// server's thread.
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "ext/web/client.h"
#include "ext/web/recording_reader.h"
#include "ext/web/topic.h"

namespace lidar::web {

class SliceService {
 public:
  /// `max_bitrate` 0: no limit. `warn` gets a text for a user if a recording cannot be read.
  explicit SliceService(DataRate max_bitrate, std::function<void(std::string)> warn = {});

  void Subscribe(Client* client, const SharedTopic& topic, std::uint32_t subscription);
  void Unsubscribe(Client* client, std::uint32_t channel);
  /// Forgets a client that has left, or a channel that was removed.
  void Forget(const Client* client);
  void ForgetChannel(std::uint32_t channel) { streams_.erase(channel); }

  void Deliver(std::uint32_t channel, const SharedSliceMessage& slice);
  /// Handles a request about slices.
  void OnRequest(Client* client, const foxglove::Request& request);
  /// Call it regularly: sends what had to wait.
  void Tick();

  /// Returns true if the client acknowledges too late that it drew slices: its link has no room.
  bool IsLate(Client* client) const;

  /// Scans that slow viewers missed.
  std::uint64_t scans_skipped() const { return scans_skipped_; }

 private:
  /// What a viewer gets of a recording in place of live slices.
  struct Replay {
    std::uint16_t number = 0;                 // number of the replay, chosen by the viewer
    std::deque<viewer::SharedSlice> waiting;  // read but not sent yet
    std::uint64_t next = 0;                   // position of the next piece
    std::uint64_t last_ns = 0;                // time of the last slice that was read
    std::uint64_t damaged = 0;                // parts that were left out
    bool is_reading = true;
    bool ended = false;  // no more slices follow
  };
  struct Viewer {
    std::uint32_t subscription = 0;
    viewer::Feed feed;
    std::optional<Replay> replay = {};
    std::uint64_t asker = 0;  // id under which `replay` asks the reader
  };
  struct Stream {
    SharedTopic topic;
    viewer::RecentScans recent;
    std::map<Client*, Viewer> viewers;
    Time looked_at{};           // last look at the recording
    std::uint64_t from_ns = 0;  // times of the recording at looked_at
    std::uint64_t to_ns = 0;
    std::string why;  // of the last warning
  };
  void Serve(Stream* stream, Client* client, Viewer* viewer);
  void ServeAll(Stream* stream);
  void ServeReplay(const Stream& stream, Client* client, Viewer* viewer);

  void Look(Stream* stream);
  void BeginReplay(const foxglove::Request& request, const Stream& stream, Viewer* viewer);
  void EndReplay(Viewer* viewer);
  void OnPiece(const RecordingReader::Job& job, const Recording::Piece& piece);
  void Learn(const Recording::Piece& piece, Stream* stream);
  void Describe(const Stream& stream, const Viewer& viewer, Client* client);

  const DataRate max_bitrate_;
  const std::function<void(std::string)> warn_;
  RecordingReader reader_;
  std::uint64_t next_asker_ = 1;             // asker 0 looks for all viewers of a stream
  std::map<std::uint32_t, Stream> streams_;  // by channel, with viewers
  std::uint64_t scans_skipped_ = 0;
};

}  // namespace lidar::web
