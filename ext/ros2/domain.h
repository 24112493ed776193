// SPDX-License-Identifier: LGPL-2.1-or-later
// The DDS domains of this process. Cyclone has one of each number, so elements share them.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

namespace lidar::dds {

/// Each owner of entities in a domain holds an object of this class.
class Domain {
 public:
  /// Returns null if Cyclone refuses its configuration; `why` has the reason. The fault may be the
  /// user's: CYCLONEDDS_URI is read after our configuration, which only allows large messages.
  static std::unique_ptr<Domain> Join(std::uint32_t id, std::string* why);
  ~Domain();
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

  std::uint32_t id() const { return id_; }

  static constexpr std::uint32_t kReceiveBuffer = 4u << 20;  // bytes
  static constexpr std::uint32_t kMaxMessage = 256u << 20;   // bytes
  /// The part of kReceiveBuffer that the kernel grants [bytes].
  static std::uint32_t GrantedReceiveBuffer();

 private:
  explicit Domain(std::uint32_t id) : id_(id) {}

  std::uint32_t id_;
};

}  // namespace lidar::dds
