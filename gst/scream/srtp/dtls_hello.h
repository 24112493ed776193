// SPDX-License-Identifier: LGPL-2.1-or-later
// Recognises the hello of a DTLS client (RFC 6347, 4.2), which may take several datagrams.
#pragma once
#include <string>

#include "src/base/byte_reader.h"

namespace lidar::gst {

/// Returns true for each part of a client's hello, unless its record was cut off.
bool IsOfHello(ByteView datagram);
/// Returns the first part of a hello without the record header, which differs in a repeated hello.
/// Returns an empty text for other datagrams.
std::string HelloIn(ByteView datagram);

}  // namespace lidar::gst
