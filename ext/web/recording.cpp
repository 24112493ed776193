// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/recording.h"

#include <algorithm>
#include <utility>

#include "gst/common/caps_text.h"
#include "src/cdr/coded_slice.h"
#include "src/codec/slice_links.h"

namespace lidar::web {
namespace {

constexpr std::uint64_t kSecond_ns = 1'000'000'000;
/// lidarenc codes each sector anew within 10 s, its key-interval.
constexpr std::uint64_t kRewind_ns = 11 * kSecond_ns;
/// Two scans of a sensor at 10 Hz, and a half.
constexpr std::uint64_t kPicture_ns = 250'000'000;
/// 11 s of a recording that has clouds, too.
constexpr std::size_t kMostRead = std::size_t{512} << 20;
/// 11 s of 12 Mbit/s.
constexpr std::size_t kMostKept = std::size_t{16} << 20;
constexpr std::size_t kMostKnownCaps = 64;

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
  const std::uint64_t first = time - std::min(time, kRewind_ns);
  Read(first, time - std::min(time, kPicture_ns), &piece);
  return piece;
}

Recording::Piece Recording::GoOn(std::uint64_t next_ns) {
  Piece piece;
  if (Open(&piece)) Read(next_ns, next_ns, &piece);
  return piece;
}

bool Recording::Open(Piece* piece) {
  const bool good =
      playback_
          ? playback_->Refresh(&piece->why)
          : (playback_ = mcap::Playback::Open(location_, &cancelled_, &piece->why)) != nullptr;
  piece->ended = !good;
  if (!good) return false;
  piece->from_ns = playback_->start_time();
  piece->to_ns = playback_->end_time();
  for (const auto& topic : playback_->topics())
    if (topic_.empty() && IsOurs(topic.schema, topic.channel)) topic_ = topic.channel.topic;
  if (!topic_.empty()) return true;
  *piece = {};
  piece->ended = true;
  piece->why = "it holds no slices of this stream";
  return false;
}

/// Reads from `first_ns` on. Slices before `from_ns` stay only if later ones refer to them. The
/// file is open only meanwhile.
void Recording::Read(std::uint64_t first_ns, std::uint64_t from_ns, Piece* piece) {
  std::vector<viewer::SharedSlice> slices;
  std::size_t before = 0;  // slices before from_ns
  std::size_t kept = 0;    // bytes of all slices
  std::size_t wanted = 0;  // bytes of slices from from_ns on
  std::size_t read = 0;    // bytes of all messages
  const std::uint64_t damaged = playback_->damaged_chunks();
  piece->next_ns = first_ns;
  playback_->Seek(first_ns);
  while (wanted < kPiece && read < kMostRead) {
    const auto item = playback_->Next();
    piece->ended = !item;
    if (!item) break;
    const std::uint64_t time = item->message.header.log_time;
    read += item->message.data.size;
    piece->next_ns = std::max(piece->next_ns, time + 1);
    if (item->channel->topic != topic_ || !IsOurs(*item->schema, *item->channel)) continue;
    auto slice = ReadSlice(item->message);
    if (!slice) {
      ++piece->damaged;
      continue;
    }
    // Slices of one byte each would take memory, too.
    const std::size_t size = sizeof(SliceMessage) + slice->payload.size();
    kept += size;
    if (time >= from_ns) wanted += size;
    if (kept > kMostKept) {
      slices.clear();
      kept = before = 0;
    }
    if (time < from_ns) ++before;
    slices.push_back(std::move(slice));
  }
  piece->damaged += playback_->damaged_chunks() - damaged;
  playback_->Seek(0);
  for (const auto& slice : viewer::WithReferences(slices, before))
    piece->slices.push_back(std::static_pointer_cast<const SliceMessage>(slice));
}

bool Recording::IsOurs(const mcap::Schema& schema, const mcap::Channel& channel) {
  const auto text = channel.metadata.find(mcap::kCapsKey);
  if (schema.name != cdr::CodedSlice::kName || channel.message_encoding != "cdr" ||
      text == channel.metadata.end())
    return false;
  if (known_caps_.size() > kMostKnownCaps) known_caps_.clear();
  const auto [known, is_new] = known_caps_.try_emplace(text->second, false);
  if (!is_new) return known->second;
  const gst::CapsPtr caps = gst::CapsFromText(text->second);
  std::string why;
  const auto parsed = caps ? SliceCaps::Parse(caps.get(), &why) : std::nullopt;
  known->second = parsed && parsed->HasSameDecoder(caps_);
  return known->second;
}

/// Returns null if the message is damaged.
std::shared_ptr<const SliceMessage> Recording::ReadSlice(const mcap::Message& message) const {
  const auto coded = cdr::ReadCodedSlice(message.data);
  if (!coded || coded->data.size == 0) return nullptr;
  auto slice = std::make_shared<SliceMessage>();
  if (caps_.about.has_ranges) {
    auto blocks = codec::LinksOf(coded->data);
    if (!blocks) return nullptr;
    slice->blocks = *std::move(blocks);
  }
  slice->id = {coded->scan_id, coded->slice_index};
  slice->count = std::max(coded->slice_count, 1U);
  slice->first_column = coded->first_column;
  slice->unix_ns = message.header.log_time;
  slice->size = DataSize::Bytes(static_cast<std::int64_t>(coded->data.size));
  slice->payload.assign(coded->data.begin(), coded->data.end());
  return slice;
}

}  // namespace lidar::web
