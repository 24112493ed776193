// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/playback.h"

#include <algorithm>
#include <utility>

#include "src/mcap/input_file.h"

namespace lidar::mcap {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<Reader> OpenReader(const std::string& path, const FileIndex& known,
                                   const std::atomic<bool>* cancelled, std::string* why) {
  auto input = InputFile::Open(path, why, cancelled);
  return input ? Reader::Open(std::move(input), why, known) : nullptr;
}

}  // namespace

std::unique_ptr<Playback> Playback::Open(const std::string& location,
                                         const std::atomic<bool>* cancelled, std::string* why) {
  auto names = FileNames::Parse(location, why);
  if (!names) return nullptr;
  std::unique_ptr<Playback> playback(new Playback(*std::move(names), cancelled));
  return playback->Refresh(why) ? std::move(playback) : nullptr;
}

bool Playback::Refresh(std::string* why) {
  std::error_code failed;
  const auto existing = names_.Existing(&failed);
  if (existing.empty()) *why = "there is no such file";
  if (failed && failed != std::errc::no_such_file_or_directory) *why = failed.message();
  Seek(0);
  std::vector<File> before = std::exchange(files_, {});
  unclosed_files_ = unreadable_files_ = start_time_ = end_time_ = 0;
  for (const auto& [number, path] : existing) {
    const auto known = std::find_if(before.begin(), before.end(),
                                    [&name = path](const File& f) { return f.path == name; });
    File file;
    if (known != before.end()) file = std::move(*known);
    file.path = path;
    if (!Read(&file, why)) {
      ++unreadable_files_;
      continue;
    }
    start_time_ = files_.empty() ? file.start_time : std::min(start_time_, file.start_time);
    end_time_ = std::max(end_time_, file.end_time);
    unclosed_files_ += file.complete ? 0 : 1;
    files_.push_back(std::move(file));
  }
  return !files_.empty();
}

/// Reads the index of the file if the file's size or modification time has changed.
bool Playback::Read(File* file, std::string* why) {
  std::error_code failed;
  const auto size = fs::file_size(file->path, failed);
  const auto written = fs::last_write_time(file->path, failed);
  if (!failed && file->size == size && file->written == written) return true;
  const auto reader = OpenReader(file->path, file->known, cancelled_, why);
  if (reader == nullptr) return false;
  const FileIndex& index = reader->index();
  if (index.empty()) {
    *why = "it holds no messages";
    return false;
  }
  *file = {file->path, size, written, index.start_time(), index.end_time(), index.complete};
  if (!index.complete) file->known = index;
  Learn(index);
  return true;
}

void Playback::Learn(const FileIndex& index) {
  for (const auto& [id, channel] : index.channels) {
    const auto schema = index.schemas.find(channel.schema_id);
    if (schema != index.schemas.end() && topic_names_.insert(channel.topic).second)
      topics_.push_back({schema->second, channel});
  }
}

std::uint64_t Playback::damaged_chunks() const {
  return damaged_before_ + (reader_ ? reader_->damaged_chunks() : 0);
}

void Playback::Seek(std::uint64_t begin, std::uint64_t end) {
  damaged_before_ = damaged_chunks();
  begin_ = begin;
  end_ = end;
  next_file_ = 0;
  reader_.reset();
}

bool Playback::OpenNextFile() {
  damaged_before_ = damaged_chunks();
  reader_.reset();
  while (next_file_ < files_.size()) {
    const File& file = files_[next_file_++];
    if (file.end_time < begin_ || file.start_time >= end_) continue;
    reader_ = OpenReader(file.path, file.known, cancelled_, &why_unreadable_);
    if (reader_ == nullptr) {
      ++unreadable_files_;
      files_.erase(files_.begin() + static_cast<std::ptrdiff_t>(--next_file_));
      continue;
    }
    reader_->Seek(begin_);
    return true;
  }
  return false;
}

std::optional<Playback::Item> Playback::Next() {
  while (reader_ || OpenNextFile()) {
    const auto message = reader_->Next();
    if (!message || message->header.log_time >= end_) {
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
