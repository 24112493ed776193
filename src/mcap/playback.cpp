// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/playback.h"

#include <algorithm>
#include <utility>

#include "src/mcap/file_names.h"
#include "src/mcap/input_file.h"

namespace lidar::mcap {
namespace {

std::unique_ptr<Reader> OpenReader(const std::string& path, const std::atomic<bool>* cancelled,
                                   std::string* why) {
  auto input = InputFile::Open(path, why, cancelled);
  return input ? Reader::Open(std::move(input), why) : nullptr;
}

}  // namespace

std::unique_ptr<Playback> Playback::Open(const std::string& location,
                                         const std::atomic<bool>* cancelled, std::string* why) {
  const auto names = FileNames::Parse(location, why);
  if (!names) return nullptr;
  std::error_code failed;
  const auto existing = names->Existing(&failed);
  if (existing.empty()) *why = "there is no such file";
  if (failed && failed != std::errc::no_such_file_or_directory) *why = failed.message();
  std::unique_ptr<Playback> playback(new Playback(cancelled));
  for (const auto& [number, path] : existing) {
    const auto reader = OpenReader(path, cancelled, why);
    if (reader != nullptr && !reader->index().empty()) {
      playback->Add(path, reader->index());
      continue;
    }
    if (reader != nullptr) *why = "it holds no messages";
    ++playback->unreadable_files_;
  }
  return playback->files_.empty() ? nullptr : std::move(playback);
}

void Playback::Add(const std::string& path, const FileIndex& index) {
  start_time_ = files_.empty() ? index.start_time() : std::min(start_time_, index.start_time());
  end_time_ = std::max(end_time_, index.end_time());
  unclosed_files_ += index.complete ? 0 : 1;
  files_.push_back({path, index.start_time(), index.end_time()});
  for (const auto& [id, channel] : index.channels) {
    const auto schema = index.schemas.find(channel.schema_id);
    if (schema != index.schemas.end() && names_.insert(channel.topic).second)
      topics_.push_back({schema->second, channel});
  }
}

std::uint64_t Playback::damaged_chunks() const {
  return damaged_before_ + (reader_ ? reader_->damaged_chunks() : 0);
}

void Playback::Seek(std::uint64_t log_time) {
  damaged_before_ = damaged_chunks();
  from_ = log_time;
  next_file_ = 0;
  reader_.reset();
}

bool Playback::OpenNextFile() {
  damaged_before_ = damaged_chunks();
  reader_.reset();
  while (next_file_ < files_.size()) {
    const File& file = files_[next_file_++];
    std::string why;
    if (file.end_time < from_) continue;
    reader_ = OpenReader(file.path, cancelled_, &why);
    if (reader_ == nullptr) {
      ++unreadable_files_;
      continue;
    }
    reader_->Seek(from_);
    return true;
  }
  return false;
}

std::optional<Playback::Item> Playback::Next() {
  while (reader_ || OpenNextFile()) {
    const auto message = reader_->Next();
    if (!message) {
      if (!OpenNextFile()) return std::nullopt;
      continue;
    }
    const FileIndex& index = reader_->index();
    Item item;
    item.message = *message;
    item.channel = &index.channels.at(message->header.channel_id);
    const auto schema = index.schemas.find(item.channel->schema_id);
    if (schema == index.schemas.end()) continue;
    item.schema = &schema->second;
    return item;
  }
  return std::nullopt;
}

}  // namespace lidar::mcap
