// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads a recording in pieces, at the times that viewers request.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ext/web/archive.h"
#include "ext/web/topic.h"

namespace lidar::web {

/// For one thread at a time.
class Recording {
 public:
  explicit Recording(std::unique_ptr<Archive> archive) : archive_(std::move(archive)) {}

  /// Times [ns] are close to capture times.
  struct Piece {
    std::uint64_t from_ns = 0;  // of the whole recording; 0, as is to_ns, if nothing can be read
    std::uint64_t to_ns = 0;
    std::vector<SharedSliceMessage> slices;  // and poses
    std::uint64_t last_ns = 0;               // of the last slice
    std::uint64_t next = 0;                  // position of the next piece
    bool ended = false;                      // no more slices follow yet
    std::uint64_t damaged = 0;               // parts that were left out
    std::string why;                         // for a user, if nothing can be read
  };
  /// Returns the times of the recording, without slices.
  Piece Look();
  /// Returns the two scans before `time_ns`, the slices that they refer to, and those that follow.
  Piece Jump(std::uint64_t time_ns);
  /// Returns the slices from a position on.
  Piece GoOn(std::uint64_t position);
  /// Ends reading soon. Any thread may call it.
  void Cancel() { archive_->Cancel(); }

  /// Size of a piece [bytes], without the earlier slices that it refers to.
  static constexpr std::size_t kPiece = std::size_t{512} << 10;

 private:
  bool Open(Piece* piece);
  void Read(std::uint64_t from_ns, Piece* piece);

  const std::unique_ptr<Archive> archive_;
};

}  // namespace lidar::web
