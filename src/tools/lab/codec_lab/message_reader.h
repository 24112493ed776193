// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages of recordings, in CDR as ROS 2 writes them.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::tools {

struct RecordedTopic {
  std::string name;
  std::string type;  // such as sensor_msgs/msg/PointCloud2
};

struct RecordedMessage {
  std::uint64_t log_time_ns = 0;
  ByteView data;  // valid until the reader's next call
};

/// All functions throw std::runtime_error with a message for the user.
class MessageReader {
 public:
  virtual ~MessageReader() = default;
  /// Topics with CDR messages. A topic may be listed more than once.
  virtual std::vector<RecordedTopic> Topics() const = 0;
  /// Makes Next() return the messages of this topic, from the first on.
  virtual void Select(const std::string& topic) = 0;
  /// Returns nothing at the end, or without a selected topic.
  virtual std::optional<RecordedMessage> Next() = 0;
};

std::unique_ptr<MessageReader> OpenMcap(const std::string& path);
/// The storage "sqlite3" of ROS 2.
std::unique_ptr<MessageReader> OpenBagDatabase(const std::string& path);

bool IsRecordingFile(const std::string& path);
/// Opens an MCAP file, a database, or a folder with parts of either kind, as `ros2 bag record`
/// numbers them.
std::unique_ptr<MessageReader> OpenMessages(const std::string& path);

}  // namespace lidar::tools
