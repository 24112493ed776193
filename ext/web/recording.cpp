// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/recording.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace lidar::web {
namespace {

constexpr std::uint64_t kSecond_ns = 1'000'000'000;
/// lidarenc encodes each sector without references at least every 10 s (its key-interval).
constexpr std::uint64_t kRewind_ns = 11 * kSecond_ns;
/// The time of two and a half scans of a sensor at 10 Hz.
constexpr std::uint64_t kPicture_ns = 250'000'000;
/// The largest number of bytes to read. This is enough for 11 s of a recording that also has
/// clouds.
constexpr std::size_t kMostRead = std::size_t{512} << 20;
/// The largest number of bytes to keep. This is enough for 11 s at 12 Mbit/s.
constexpr std::size_t kMostKept = std::size_t{16} << 20;

}  // namespace

Recording::Piece Recording::Look() {
  Piece piece;
  Open(&piece);
  return piece;
}

Recording::Piece Recording::Jump(std::uint64_t time_ns) {
  Piece piece;
  if (!Open(&piece)) return piece;
  const std::uint64_t time = std::clamp(time_ns, piece.from_ns, piece.to_ns);
  archive_->Seek(time - std::min(time, kRewind_ns));
  Read(time - std::min(time, kPicture_ns), &piece);
  return piece;
}

Recording::Piece Recording::GoOn(std::uint64_t position) {
  Piece piece;
  if (!Open(&piece)) return piece;
  piece.next = position;
  archive_->GoOn(position);
  Read(0, &piece);
  return piece;
}

bool Recording::Open(Piece* piece) {
  const auto times = archive_->Look(&piece->why);
  piece->ended = !times;
  if (times) std::tie(piece->from_ns, piece->to_ns) = std::tie(times->from_ns, times->to_ns);
  return times.has_value();
}

/// Reads a piece. Keeps the slices before `from_ns` only if later slices refer to them. Closes the
/// archive at the end.
void Recording::Read(std::uint64_t from_ns, Piece* piece) {
  std::vector<viewer::SharedSlice> slices;
  viewer::SliceId last;
  std::size_t before = 0;  // number of slices before from_ns
  std::size_t kept = 0;    // bytes of all slices
  std::size_t wanted = 0;  // bytes of the slices that are not before from_ns
  std::size_t read = 0;    // bytes of all messages
  bool may_end = true;
  const std::uint64_t damaged = archive_->damaged();
  while ((wanted < kPiece || !may_end) && read < kMostRead) {
    auto item = archive_->Next();
    piece->ended = !item;
    if (!item) break;
    read += item->read;
    may_end = item->may_end_piece;
    piece->next = std::max(piece->next, item->position);
    if (item->is_damaged) ++piece->damaged;
    const bool is_early = item->time_ns < from_ns;
    if (!item->slice || (item->slice->is_pose && is_early)) continue;
    if (item->slice->is_pose) {
      item->slice->id = last;
    } else {
      last = item->slice->id;
      piece->last_ns = item->slice->unix_ns;
    }
    // Adds the size of a SliceMessage, because even very small slices use that much memory.
    const std::size_t size = sizeof(SliceMessage) + item->slice->payload.size();
    kept += size;
    if (!is_early) wanted += size;
    if (kept > kMostKept) {
      slices.clear();
      kept = before = 0;
    }
    if (is_early) ++before;
    slices.push_back(std::move(item->slice));
  }
  piece->damaged += archive_->damaged() - damaged;
  if (piece->ended) piece->why = archive_->error();
  if (!piece->why.empty()) piece->from_ns = piece->to_ns = 0;
  archive_->Rest();
  for (const auto& slice : viewer::WithReferences(slices, before))
    piece->slices.push_back(std::static_pointer_cast<const SliceMessage>(slice));
}

}  // namespace lidar::web
