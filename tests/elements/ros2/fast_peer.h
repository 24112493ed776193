// SPDX-License-Identifier: LGPL-2.1-or-later
// A ROS 2 node that is based on eProsima's Fast DDS and Fast CDR. It shares no code with the tested
// elements.
#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lidar::test {

struct PeerHeader {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame_id;
};
struct PeerField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 1;
};
struct PeerCloud {
  PeerHeader header;
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<PeerField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::vector<std::uint8_t> data;
  bool is_dense = false;
};
struct PeerImu {
  PeerHeader header;
  std::array<double, 4> orientation{};
  std::array<double, 9> orientation_covariance{};
  std::array<double, 3> angular_velocity{};
  std::array<double, 9> angular_velocity_covariance{};
  std::array<double, 3> linear_acceleration{};
  std::array<double, 9> linear_acceleration_covariance{};
};
struct PeerOdometry {
  PeerHeader header;
  std::string child_frame_id;
  std::array<double, 7> pose{};
  std::array<double, 36> pose_covariance{};
  std::array<double, 6> twist{};
  std::array<double, 36> twist_covariance{};
};
struct PeerTransform {
  PeerHeader header;
  std::string child_frame_id;
  std::array<double, 7> transform{};
};
struct PeerTransforms {
  std::vector<PeerTransform> transforms;
};
struct PeerGraphNode {
  std::string name_space;
  std::string name;
  std::vector<std::vector<std::uint8_t>> readers;
  std::vector<std::vector<std::uint8_t>> writers;
};
struct PeerGraph {
  std::vector<std::uint8_t> participant;
  std::vector<PeerGraphNode> nodes;
};
/// A message with its encapsulation header. Its content may be invalid.
struct PeerBytes {
  std::vector<std::uint8_t> bytes;
};

/// An endpoint of another participant, as discovery reports it.
struct PeerEndpoint {
  std::string topic;
  std::string type;
  std::string user_data;
  std::vector<std::uint8_t> guid;
};

/// A node that uses only the loopback interface.
class FastPeer {
 public:
  explicit FastPeer(std::uint32_t domain);
  ~FastPeer();

  enum class Qos { kBestEffort, kReliable, kReliableTransient };
  /// Subscribes to a topic. `type` is the name of the type in DDS, and Message is one of the
  /// structs above.
  template <class Message>
  void Subscribe(const std::string& topic, const std::string& type, Qos qos);
  template <class Message>
  void Advertise(const std::string& topic, const std::string& type, Qos qos);

  /// Waits until an endpoint of another participant matches. Returns false if that takes longer
  /// than `timeout`.
  bool WaitForMatch(std::chrono::milliseconds timeout);
  template <class Message>
  bool Publish(const Message& message);
  /// Waits for the next message. Returns false if none arrives within `timeout`.
  template <class Message>
  bool Take(Message* message, std::chrono::milliseconds timeout);

  /// Returns the writers and readers that discovery has found so far. participants() returns the
  /// user data of the participants.
  std::vector<PeerEndpoint> endpoints() const;
  std::vector<std::string> participants() const;
  std::vector<std::uint8_t> guid() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace lidar::test
