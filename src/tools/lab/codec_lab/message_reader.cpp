// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/message_reader.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace lidar::tools {
namespace {

std::string ExtensionOf(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

/// Returns the parts of a recording in the order of their numbers, so that `drive_10` follows
/// `drive_9`.
std::vector<std::string> PartsOf(const std::string& folder) {
  std::vector<std::string> parts;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (IsRecordingFile(entry.path().string())) parts.push_back(entry.path().string());
  std::sort(parts.begin(), parts.end(), [](const std::string& a, const std::string& b) {
    return std::pair(a.size(), a) < std::pair(b.size(), b);
  });
  for (const std::string& part : parts)
    if (ExtensionOf(part) != ExtensionOf(parts.front()))
      throw std::runtime_error(folder + ": holds .db3 and .mcap files; name one of them");
  if (parts.empty()) throw std::runtime_error(folder + ": no .db3 or .mcap file in it");
  return parts;
}

/// Reads the parts of a recording one after another.
class BagFolder final : public MessageReader {
 public:
  explicit BagFolder(const std::string& folder) : parts_(PartsOf(folder)) {
    for (const std::string& part : parts_)
      for (RecordedTopic& topic : OpenMessages(part)->Topics()) topics_.push_back(std::move(topic));
  }

  std::vector<RecordedTopic> Topics() const override { return topics_; }
  void Select(const std::string& topic) override {
    topic_ = topic;
    next_part_ = 0;
    part_.reset();
  }
  std::optional<RecordedMessage> Next() override {
    for (;;) {
      if (part_)
        if (const auto message = part_->Next()) return message;
      if (next_part_ == parts_.size()) return std::nullopt;
      part_ = OpenMessages(parts_[next_part_++]);
      part_->Select(topic_);
    }
  }

 private:
  std::vector<std::string> parts_;
  std::vector<RecordedTopic> topics_;
  std::string topic_;
  std::size_t next_part_ = 0;
  std::unique_ptr<MessageReader> part_;
};

}  // namespace

bool IsRecordingFile(const std::string& path) {
  return ExtensionOf(path) == ".db3" || ExtensionOf(path) == ".mcap";
}

#ifndef HAVE_MCAP
std::unique_ptr<MessageReader> OpenMcap(const std::string& path) {
  throw std::runtime_error(path + ": built without MCAP, which needs libzstd and liblz4");
}
#endif
#ifndef HAVE_SQLITE
std::unique_ptr<MessageReader> OpenBagDatabase(const std::string& path) {
  throw std::runtime_error(path + ": built without databases of ROS 2, which need libsqlite3");
}
#endif

std::unique_ptr<MessageReader> OpenMessages(const std::string& path) {
  if (std::filesystem::is_directory(path)) return std::make_unique<BagFolder>(path);
  return ExtensionOf(path) == ".db3" ? OpenBagDatabase(path) : OpenMcap(path);
}

}  // namespace lidar::tools
