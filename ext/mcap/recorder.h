// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes messages to the files of a recording.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "ext/mcap/output_file.h"
#include "src/mcap/file_names.h"
#include "src/mcap/writer.h"

namespace lidar::gst {

struct RecorderSettings {
  mcap::WriterSettings writer;
  std::uint64_t max_file_size = 0;  // bytes; 0: no limit
  Duration max_file_duration{};     // 0: no limit
  unsigned max_files = 0;           // beyond it the oldest file is removed; 0: no limit
  bool sync = false;
};

/// The error that ends a recording.
struct RecorderFault {
  std::string path;
  int error = 0;  // errno
  bool opening = false;
  bool complete = false;  // the only file is already complete
};

struct RecordedFile {
  std::string path;
  mcap::Statistics statistics;
  std::uint64_t size = 0;  // bytes
};

class Recorder {
 public:
  Recorder(const RecorderSettings& settings, mcap::FileNames names);

  /// Returns the error that would occur when the first file is created, or nothing. Does not create
  /// the file.
  std::optional<RecorderFault> Check() const;

  mcap::Catalogue& catalogue() { return catalogue_; }
  /// Writes a message. If `begins_scan` is true, a new file may begin with the message. After a
  /// fault the recording ends. The messages before the fault are intact.
  std::optional<RecorderFault> Add(const mcap::MessageHeader& header, ByteView data,
                                   bool begins_scan);
  /// Completes the file. The next message begins another file.
  std::optional<RecorderFault> Finish();

  /// Returns the files that were completed since the last call.
  std::vector<RecordedFile> TakeFinished() { return std::exchange(finished_, {}); }
  std::uint64_t chunks() const { return chunks_ + (writer_ ? writer_->chunks() : 0); }

 private:
  bool IsOver(std::uint64_t log_time, bool begins_scan) const;
  void BeginFile();
  void RemoveOldFiles();
  std::optional<RecorderFault> Fault() const;

  const RecorderSettings settings_;
  const mcap::FileNames names_;
  mcap::Catalogue catalogue_;
  std::error_code listing_failed_;
  std::uint32_t next_number_ = 0;
  std::unique_ptr<OutputFile> file_;
  std::unique_ptr<mcap::Writer> writer_;
  std::uint64_t file_start_ = 0;  // log time of the first message in the file
  std::vector<std::string> files_;
  std::vector<RecordedFile> finished_;
  std::uint64_t chunks_ = 0;
};

}  // namespace lidar::gst
