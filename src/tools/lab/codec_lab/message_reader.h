// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads messages from recordings. The messages are in CDR, as ROS 2 writes them.
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

/// Reads the messages of a recording. All functions throw std::runtime_error with a message for the
/// user.
class MessageReader {
 public:
  virtual ~MessageReader() = default;
  /// Returns the topics that have CDR messages. A topic may be listed more than once.
  virtual std::vector<RecordedTopic> Topics() const = 0;
  /// Makes Next() return the messages of this topic, beginning with the first one.
  virtual void Select(const std::string& topic) = 0;
  /// Returns the next message. Returns nothing at the end, or if no topic is selected.
  virtual std::optional<RecordedMessage> Next() = 0;
};

std::unique_ptr<MessageReader> OpenMcap(const std::string& path);
/// Opens a database of the storage "sqlite3" of ROS 2.
std::unique_ptr<MessageReader> OpenBagDatabase(const std::string& path);

bool IsRecordingFile(const std::string& path);
/// Opens an MCAP file, a database, or a folder. The folder contains the parts of a recording, which
/// are all of one of these kinds and have the numbers that `ros2 bag record` gives them.
std::unique_ptr<MessageReader> OpenMessages(const std::string& path);

}  // namespace lidar::tools
