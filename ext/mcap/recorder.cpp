// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/recorder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace lidar::gst {

Recorder::Recorder(const RecorderSettings& settings, mcap::FileNames names)
    : settings_(settings), names_(std::move(names)) {
  // Keeps the files of an earlier recording. The numbers of new files continue after the existing
  // numbers.
  const auto existing = names_.Existing(&listing_failed_);
  if (!names_.is_numbered() || existing.empty()) return;
  next_number_ = existing.back().first + 1;
  if (settings_.max_files > 0)
    for (const auto& [number, path] : existing) files_.push_back(path);
}

std::optional<RecorderFault> Recorder::Check() const {
  if (listing_failed_) return RecorderFault{names_.Folder(), listing_failed_.value(), true};
  const std::string path = names_.Name(next_number_);
  struct stat status {};
  const bool exists = stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return RecorderFault{path, EISDIR, true};
  if (access(exists ? path.c_str() : names_.Folder().c_str(), W_OK) == 0) return std::nullopt;
  return RecorderFault{path, errno, true};
}

std::optional<RecorderFault> Recorder::Fault() const {
  return RecorderFault{file_->path(), file_->error(), file_->opening_failed()};
}

/// Returns true if the file must end before the next message. It ends at its limit if a scan begins
/// with the message, and otherwise at 9/8 of the limit.
bool Recorder::IsOver(std::uint64_t log_time, bool begins_scan) const {
  const auto over = [&](std::uint64_t value, std::uint64_t limit) {
    return limit > 0 && value >= (begins_scan ? limit : limit + limit / 8);
  };
  const std::uint64_t age = log_time > file_start_ ? log_time - file_start_ : 0;
  return over(writer_->size(), settings_.max_file_size) ||
         over(age, static_cast<std::uint64_t>(settings_.max_file_duration.count()));
}

void Recorder::RemoveOldFiles() {
  if (settings_.max_files == 0 || !names_.is_numbered()) return;
  while (files_.size() >= settings_.max_files) {
    unlink(files_.front().c_str());
    files_.erase(files_.begin());
  }
}

void Recorder::BeginFile() {
  RemoveOldFiles();
  using Existing = OutputFile::Existing;
  file_ = std::make_unique<OutputFile>(names_.Name(next_number_++), settings_.sync,
                                       names_.is_numbered() ? Existing::kKeep : Existing::kReplace);
  if (settings_.max_files > 0) files_.push_back(file_->path());
  writer_ = std::make_unique<mcap::Writer>(
      settings_.writer, &catalogue_, [file = file_.get()](ByteView v) { return file->Append(v); });
}

std::optional<RecorderFault> Recorder::Add(const mcap::MessageHeader& header, ByteView data,
                                           bool begins_scan) {
  if (data.size > mcap::kMaxMessage) {
    const std::string path = file_ ? file_->path() : names_.Name(next_number_);
    Finish();
    return RecorderFault{path, EMSGSIZE};
  }
  if (writer_ && IsOver(header.log_time, begins_scan)) {
    if (auto fault = Finish()) return fault;
  }
  if (!writer_) {
    if (!names_.is_numbered() && next_number_ > 0)
      return RecorderFault{names_.Name(0), EEXIST, true, true};
    BeginFile();
    file_start_ = header.log_time;
  }
  if (writer_->Add(header, data)) return std::nullopt;
  const auto fault = Fault();
  Finish();
  return fault;
}

std::optional<RecorderFault> Recorder::Finish() {
  if (!writer_) return std::nullopt;
  const bool written = writer_->Finish();
  const bool closed = file_->Close();
  if (writer_->ended())
    finished_.push_back({file_->path(), writer_->statistics(), writer_->size()});
  std::optional<RecorderFault> fault;
  if (!written || !closed) fault = Fault();
  chunks_ += writer_->chunks();
  writer_.reset();
  file_.reset();
  return fault;
}

}  // namespace lidar::gst
