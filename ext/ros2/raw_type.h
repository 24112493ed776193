// SPDX-License-Identifier: LGPL-2.1-or-later
// DDS messages as unchecked bytes, so that this plugin can count damaged ones and bound their
// memory.
#pragma once
#include <memory>
#include <vector>

#include "src/base/byte_reader.h"

struct ddsi_serdata;
struct ddsi_sertype;

namespace lidar::dds {

/// Creates a keyless type `dds_name` without a type description (other implementations of DDS
/// accept that). The topic that uses the type owns it. Received messages larger than `max_size`
/// [bytes] are cut there, and so damaged.
ddsi_sertype* NewRawType(const char* dds_name, std::size_t max_size);

struct Release {
  void operator()(ddsi_serdata* data) const;
};
/// A message with its encapsulation header. It may outlive the domain that it came from.
using MessagePtr = std::unique_ptr<ddsi_serdata, Release>;

/// Joins the pieces of a message in the form that DDS takes.
MessagePtr NewMessage(const ddsi_sertype* type, const std::vector<ByteView>& pieces);
ByteView BytesOf(const ddsi_serdata* message);

}  // namespace lidar::dds
