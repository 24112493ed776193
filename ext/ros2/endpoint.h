// SPDX-License-Identifier: LGPL-2.1-or-later
// A publisher or a subscription of a ROS 2 node, which uses Cyclone DDS.
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
  std::string topic;  // name of the topic in DDS
  cdr::RosType type = cdr::RosType::kPointCloud2;
  bool reliable = false;
  bool transient = false;  // publishers keep messages for later subscribers
  unsigned depth = 5;      // number of messages that are kept
  std::size_t gid_size = 16;
  bool tells_type_hash = true;
};

/// A DDS participant with one ROS 2 node that has one endpoint. The node is announced to ROS 2.
class Node {
 public:
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

 protected:
  Node() = default;
  /// Creates the participant and the topic. Returns false and sets `why` if DDS refuses.
  bool Open(const EndpointOptions& options, std::string* why);
  bool Announce(const EndpointOptions& options, bool writes, std::string* why);

  std::unique_ptr<Domain> domain_;
  std::int32_t participant_ = 0;  // DDS entities; the participant deletes the others
  std::int32_t topic_ = 0;
  std::int32_t endpoint_ = 0;
  const ddsi_sertype* type_ = nullptr;  // type of the topic
};

class Reader : public Node {
 public:
  static std::unique_ptr<Reader> Create(const EndpointOptions& options, std::string* why);

  enum class Event {
    kMessage,
    kWoken,
    kIncompatible,  // a publisher's reliability is incompatible
    kOtherType,     // a publisher of this topic has the type other_type()
    kFailed,
  };
  /// Waits for the next event. Only one thread may wait.
  Event Wait();
  /// Makes Wait() return at once until Wake(false) is called. Any thread may call this function.
  void Wake(bool on);

  /// Returns the message after kMessage. Returns null if DDS only reports that a publisher left.
  MessagePtr Take();
  const std::string& other_type() const { return other_type_; }
  /// Return the number of messages that DDS lost, and the number of present publishers.
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
  std::int32_t messages_ = 0;      // a condition that is true while there are messages
  std::int32_t publications_ = 0;  // reads the announcements of publishers
};

class Writer : public Node {
 public:
  static std::unique_ptr<Writer> Create(const EndpointOptions& options, std::string* why);

  enum class Result { kSent, kTimeout, kFailed };
  /// Publishes a message. Waits for slow reliable subscribers, but at most for kMaxBlockingNs.
  Result Publish(const std::vector<ByteView>& pieces);
  unsigned subscribers() const;
  /// The kind of QoS setting that a subscriber requests and that this writer does not offer.
  enum class Want { kNothing, kReliability, kOther };
  /// Returns what the last incompatible subscriber requested, or kNothing if there is no new one.
  Want TakeIncompatible();

  static constexpr std::int64_t kMaxBlockingNs = 100'000'000;  // the same as in ROS 2
};

}  // namespace lidar::dds
