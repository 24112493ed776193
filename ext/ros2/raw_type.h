// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages as Cyclone DDS carries them: unchecked bytes. So this plugin counts damaged messages and
// bounds what is allocated for them.
#pragma once
#include <memory>
#include <vector>

#include "src/base/byte_reader.h"

struct ddsi_serdata;
struct ddsi_sertype;

namespace lidar::dds {

/// A keyless type called `dds_name`, with no description of itself (peers of other makers take data
/// without one). Owned by the topic that is made of it. Messages of others that are larger than
/// `max_size` [bytes] are cut there, and so damaged.
ddsi_sertype* NewRawType(const char* dds_name, std::size_t max_size);

struct Release {
  void operator()(ddsi_serdata* data) const;
};
/// A message with its encapsulation header. It may outlive the domain that it came from.
using MessagePtr = std::unique_ptr<ddsi_serdata, Release>;

/// The pieces of a message, one behind the other, as DDS takes them.
MessagePtr NewMessage(const ddsi_sertype* type, const std::vector<ByteView>& pieces);
ByteView BytesOf(const ddsi_serdata* message);

}  // namespace lidar::dds
