// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends slices to viewers, live or from a recording, as fast as each viewer acknowledges them.
// Lives in the server's thread.
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
  /// `max_bitrate` 0 means no limit. `warn` is called with a text for users if a recording cannot
  /// be read.
  explicit SliceService(DataRate max_bitrate, std::function<void(std::string)> warn = {});

  void Subscribe(Client* client, const SharedTopic& topic, std::uint32_t subscription);
  void Unsubscribe(Client* client, std::uint32_t channel);
  /// Remove a client that has disconnected, or a channel that was closed.
  void Forget(const Client* client);
  void ForgetChannel(std::uint32_t channel) { streams_.erase(channel); }

  void Deliver(std::uint32_t channel, const SharedSliceMessage& slice);
  /// Handles a request about slices.
  void OnRequest(Client* client, const foxglove::Request& request);
  /// Must be called regularly. Sends the slices that had to wait.
  void Tick();

  /// Returns true if the client acknowledges drawn slices too late, which means that its link is
  /// full.
  bool IsLate(Client* client) const;

  /// Returns the number of scans that slow viewers missed.
  std::uint64_t scans_skipped() const { return scans_skipped_; }

 private:
  /// A replay that a viewer gets instead of live slices.
  struct Replay {
    std::uint16_t number = 0;                 // number of the replay, chosen by the viewer
    std::deque<viewer::SharedSlice> waiting;  // slices that were read but not yet sent
    std::uint64_t next = 0;                   // position of the next piece
    std::uint64_t last_ns = 0;                // time of the last slice that was read
    std::uint64_t damaged = 0;                // number of parts that were skipped
    bool is_reading = true;
    bool ended = false;  // there are no more slices yet
  };
  struct Viewer {
    std::uint32_t subscription = 0;
    viewer::Feed feed;
    std::optional<Replay> replay = {};
    std::uint64_t asker = 0;  // the id with which `replay` sends jobs to the reader
  };
  struct Stream {
    SharedTopic topic;
    viewer::RecentScans recent;
    std::map<Client*, Viewer> viewers;
    Time looked_at{};           // last check of the recording
    std::uint64_t from_ns = 0;  // times of the recording at the last check
    std::uint64_t to_ns = 0;
    std::string why;  // reason in the last warning
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
  std::uint64_t next_asker_ = 1;             // asker 0 reads the times for all viewers of a stream
  std::map<std::uint32_t, Stream> streams_;  // streams that have viewers, by channel
  std::uint64_t scans_skipped_ = 0;
};

}  // namespace lidar::web
