// SPDX-License-Identifier: LGPL-2.1-or-later
// The slices of a stream in the files that mcapsink has written, or still writes.
#pragma once
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ext/web/slice_caps.h"
#include "ext/web/topic.h"
#include "src/mcap/playback.h"

namespace lidar::web {

/// The element's user names the files; nothing that a viewer sends does. One thread reads at a
/// time.
class Recording {
 public:
  /// `location` is that of mcapsink; `caps` those of the stream.
  Recording(std::string location, SliceCaps caps)
      : location_(std::move(location)), caps_(std::move(caps)) {}

  /// Times are log times [ns], which are close to capture times.
  struct Piece {
    std::uint64_t from_ns = 0;  // of the whole recording; both are 0 if nothing can be read
    std::uint64_t to_ns = 0;
    std::vector<SharedSliceMessage> slices;
    std::uint64_t next_ns = 0;  // begin of the next piece
    bool ended = false;         // no more slices follow yet
    std::uint64_t damaged = 0;  // chunks and messages that were left out
    std::string why;            // for a user, if nothing can be read
  };
  /// Returns the times of the recording, without slices.
  Piece Look();
  /// Returns the two scans before `time_ns`, the slices that they refer to, and those that follow.
  Piece Jump(std::uint64_t time_ns);
  /// Returns the slices from `next_ns` on.
  Piece GoOn(std::uint64_t next_ns);
  /// Ends reading soon. Any thread may call it.
  void Cancel() { cancelled_ = true; }

  /// Size of a piece, without referred slices.
  static constexpr std::size_t kPiece = std::size_t{512} << 10;

 private:
  bool Open(Piece* piece);
  void Read(std::uint64_t first_ns, std::uint64_t from_ns, Piece* piece);
  SharedSliceMessage ReadSlice(const mcap::Message& message) const;
  bool IsOurs(const mcap::Schema& schema, const mcap::Channel& channel);

  const std::string location_;
  const SliceCaps caps_;
  std::atomic<bool> cancelled_{false};
  std::unique_ptr<mcap::Playback> playback_;
  std::map<std::string, bool> known_caps_;  // as text; true: of our stream
  std::string topic_;                       // the first one of our stream
};

}  // namespace lidar::web
