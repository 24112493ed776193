// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads a recording in pieces, from the times that viewers request.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ext/web/archive.h"
#include "ext/web/topic.h"

namespace lidar::web {

/// A recording that is read in pieces. Only one thread at a time may use it.
class Recording {
 public:
  explicit Recording(std::unique_ptr<Archive> archive) : archive_(std::move(archive)) {}

  /// A part of a recording. Times [ns] are close to capture times.
  struct Piece {
    // The times of the whole recording. Both are 0 if nothing can be read.
    std::uint64_t from_ns = 0;
    std::uint64_t to_ns = 0;
    std::vector<SharedSliceMessage> slices;  // slices and poses
    std::uint64_t last_ns = 0;               // time of the last slice
    std::uint64_t next = 0;                  // position of the next piece
    bool ended = false;                      // there are no more slices yet
    std::uint64_t damaged = 0;               // number of parts that were skipped
    std::string why;                         // text for users, if nothing can be read
  };
  /// Returns the times of the recording, without slices.
  Piece Look();
  /// Returns the two scans before `time_ns`, the slices to which they refer, and the slices that
  /// follow.
  Piece Jump(std::uint64_t time_ns);
  /// Returns the slices from `position` on.
  Piece GoOn(std::uint64_t position);
  /// Ends a running read soon. Any thread may call this function.
  void Cancel() { archive_->Cancel(); }

  /// The size of a piece [bytes], not counting the earlier slices to which the piece refers.
  static constexpr std::size_t kPiece = std::size_t{512} << 10;

 private:
  bool Open(Piece* piece);
  void Read(std::uint64_t from_ns, Piece* piece);

  const std::unique_ptr<Archive> archive_;
};

}  // namespace lidar::web
