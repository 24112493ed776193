// SPDX-License-Identifier: LGPL-2.1-or-later
// The DDS domains of this process. Cyclone has only one domain per number, so elements share
// domains.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

namespace lidar::dds {

/// A reference to a domain. Each object that owns entities in the domain needs one.
class Domain {
 public:
  /// Joins a domain. Returns null and sets `why` if Cyclone refuses the configuration. The
  /// configuration consists of our setting, which raises the limit for the size of messages, and
  /// the user's CYCLONEDDS_URI, which may be wrong.
  static std::unique_ptr<Domain> Join(std::uint32_t id, std::string* why);
  ~Domain();
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  std::uint32_t id() const { return id_; }

  static constexpr std::uint32_t kReceiveBuffer = 4u << 20;  // bytes
  static constexpr std::uint32_t kMaxMessage = 256u << 20;   // bytes
  /// Returns the part of kReceiveBuffer that the kernel grants [bytes].
  static std::uint32_t GrantedReceiveBuffer();

 private:
  explicit Domain(std::uint32_t id) : id_(id) {}

  std::uint32_t id_;
};

}  // namespace lidar::dds
