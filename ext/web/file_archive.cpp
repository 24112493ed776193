// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/file_archive.h"

#include <algorithm>
#include <utility>

#include "ext/web/poses.h"
#include "gst/common/caps_text.h"
#include "src/cdr/coded_slice.h"
#include "src/cdr/messages.h"
#include "src/cdr/ros_types.h"
#include "src/codec/slice_links.h"

namespace lidar::web {
namespace {

constexpr std::size_t kMostKnownCaps = 64;

/// Reads a pose. Returns null if the message is damaged.
std::shared_ptr<SliceMessage> ReadPose(const mcap::Message& message) {
  const auto odometry = cdr::ReadOdometry(message.data);
  if (!odometry) return nullptr;
  return PoseMessage({message.header.log_time, odometry->header.frame_id}, odometry->child_frame_id,
                     {odometry->position, odometry->orientation});
}

}  // namespace

std::optional<Archive::Times> FileArchive::Look(std::string* why) {
  const bool good =
      playback_ ? playback_->Refresh(why)
                : (playback_ = mcap::Playback::Open(location_, &cancelled_, why)) != nullptr;
  if (!good) return std::nullopt;
  for (const auto& topic : playback_->topics())
    if (topic_.empty() && IsOurs(topic.schema, topic.channel)) topic_ = topic.channel.topic;
  if (!topic_.empty()) return Times{playback_->start_time(), playback_->end_time()};
  *why = "it holds no slices of this stream";
  return std::nullopt;
}

void FileArchive::Seek(std::uint64_t time_ns) {
  ahead_.reset();
  playback_->Seek(time_ns);
  damaged_ = playback_->damaged_chunks();
}

/// The position is a time, so a piece must not end between two items with the same time. Reads one
/// item ahead to compare the times.
std::optional<Archive::Item> FileArchive::Next() {
  auto item = ahead_ ? std::exchange(ahead_, std::nullopt) : Read();
  damaged_ = playback_->damaged_chunks();
  if (!item) return item;
  ahead_ = Read();
  item->may_end_piece = !ahead_ || ahead_->time_ns != item->time_ns;
  return item;
}

std::optional<Archive::Item> FileArchive::Read() {
  const auto message = playback_->Next();
  if (!message) return std::nullopt;
  Item item;
  item.time_ns = message->message.header.log_time;
  item.position = item.time_ns + 1;
  item.read = message->message.data.size;
  const bool is_pose = message->schema->name == cdr::InfoOf(cdr::RosType::kOdometry).name &&
                       message->channel->message_encoding == "cdr";
  if (is_pose)
    item.slice = ReadPose(message->message);
  else if (message->channel->topic == topic_ && IsOurs(*message->schema, *message->channel))
    item.slice = ReadSlice(message->message);
  else
    return item;
  item.is_damaged = !item.slice;
  return item;
}

bool FileArchive::IsOurs(const mcap::Schema& schema, const mcap::Channel& channel) {
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

/// Reads a slice. Returns null if the message is damaged.
std::shared_ptr<SliceMessage> FileArchive::ReadSlice(const mcap::Message& message) const {
  const auto coded = cdr::ReadCodedSlice(message.data);
  if (!coded || coded->data.size == 0) return nullptr;
  auto slice = std::make_shared<SliceMessage>();
  slice->id = {coded->scan_id, coded->slice_index};
  slice->count = std::max(coded->slice_count, 1U);
  slice->first_column = coded->first_column;
  slice->unix_ns = message.header.log_time;
  slice->payload.assign(coded->data.begin(), coded->data.end());
  return slice->ReadLinks(caps_.about.has_ranges) ? slice : nullptr;
}

}  // namespace lidar::web
