// SPDX-License-Identifier: LGPL-2.1-or-later
// Recognises the ClientHello of DTLS (RFC 6347, 4.2), which may be split over several datagrams.
#pragma once
#include <string>

#include "src/base/byte_reader.h"

namespace lidar::gst {

/// Returns true if the datagram is a part of a ClientHello and contains its whole record.
bool IsOfHello(ByteView datagram);
/// Returns the first part of a ClientHello, without the record header, which is different each time
/// the client repeats its hello. Returns an empty text for any other datagram.
std::string HelloIn(ByteView datagram);

}  // namespace lidar::gst
