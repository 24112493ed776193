// SPDX-License-Identifier: LGPL-2.1-or-later
// A publisher or subscription of a ROS 2 node, over Cyclone DDS.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ext/ros2/domain.h"
#include "ext/ros2/raw_type.h"
#include "src/cdr/ros_graph.h"
#include "src/cdr/ros_types.h"

namespace lidar::dds {

struct EndpointOptions {
  std::uint32_t domain = 0;
  cdr::NodeName node;
  std::string topic;  // as DDS has it
  cdr::RosType type = cdr::RosType::kPointCloud2;
  bool reliable = false;
  bool transient = false;  // publishers keep messages for later subscribers
  unsigned depth = 5;      // messages kept
  std::size_t gid_size = 16;
  bool tells_type_hash = true;
};

/// A participant with a node that has one endpoint, announced to ROS 2.
class Node {
 public:
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

 protected:
  Node() = default;
  /// Returns false and sets `why` if DDS refuses.
  bool Open(const EndpointOptions& options, std::string* why);
  bool Announce(const EndpointOptions& options, bool writes, std::string* why);

  std::unique_ptr<Domain> domain_;
  std::int32_t participant_ = 0;  // DDS entities, which are deleted with the participant
  std::int32_t topic_ = 0;
  std::int32_t endpoint_ = 0;
  const ddsi_sertype* type_ = nullptr;  // of the topic
};

class Reader : public Node {
 public:
  static std::unique_ptr<Reader> Create(const EndpointOptions& options, std::string* why);

  enum class Event {
    kMessage,
    kWoken,
    kIncompatible,  // a publisher's reliability is incompatible
    kOtherType,     // a publisher of this topic has another type: other_type()
    kFailed,
  };
  /// Blocks until an event. Only one thread may wait.
  Event Wait();
  /// Callable from any thread: Wait() returns at once until Wake(false).
  void Wake(bool on);

  /// Takes the message after kMessage. Returns null for a notice that a publisher left.
  MessagePtr Take();
  const std::string& other_type() const { return other_type_; }
  /// Counts of messages that DDS missed, and of present publishers.
  std::uint64_t lost() const;
  unsigned publishers() const;

 private:
  bool OpenReader(const EndpointOptions& options, std::string* why);
  bool FindsOtherType();

  std::string topic_name_;
  std::string type_name_;
  std::string other_type_;
  std::int32_t waitset_ = 0;
  std::int32_t guard_ = 0;
  std::int32_t messages_ = 0;      // a condition: there are messages
  std::int32_t publications_ = 0;  // reads the publications of others
};

class Writer : public Node {
 public:
  static std::unique_ptr<Writer> Create(const EndpointOptions& options, std::string* why);

  enum class Result { kSent, kTimeout, kFailed };
  /// Waits for slow reliable subscribers, but no longer than kMaxBlockingNs.
  Result Publish(const std::vector<ByteView>& pieces);
  unsigned subscribers() const;
  /// The kind of setting that a subscriber wants and this writer lacks.
  enum class Want { kNothing, kReliability, kOther };
  /// Returns what the last incompatible subscriber wants; kNothing if none is new.
  Want TakeIncompatible();

  static constexpr std::int64_t kMaxBlockingNs = 100'000'000;  // as ROS 2 has it
};

}  // namespace lidar::dds
