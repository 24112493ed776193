// SPDX-License-Identifier: LGPL-2.1-or-later
// DDS messages as unchecked bytes. This lets the plugin count damaged messages and limit the memory
// for messages.
#pragma once
#include <memory>
#include <vector>

#include "src/base/byte_reader.h"

struct ddsi_serdata;
struct ddsi_sertype;

namespace lidar::dds {

/// Creates a type `dds_name` without keys and without a type description, which other
/// implementations of DDS accept. The topic that uses the type owns it. A received message that is
/// larger than `max_size` [bytes] is truncated, and is therefore damaged.
ddsi_sertype* NewRawType(const char* dds_name, std::size_t max_size);

struct Release {
  void operator()(ddsi_serdata* data) const;
};
/// A message with its encapsulation header. It may outlive the domain from which it was received.
using MessagePtr = std::unique_ptr<ddsi_serdata, Release>;

/// Makes a DDS message from `pieces`.
MessagePtr NewMessage(const ddsi_sertype* type, const std::vector<ByteView>& pieces);
ByteView BytesOf(const ddsi_serdata* message);

}  // namespace lidar::dds
