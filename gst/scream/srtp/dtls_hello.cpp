// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/dtls_hello.h"

namespace lidar::gst {
namespace {

constexpr std::size_t kRecordHeader = 13;
constexpr std::size_t kHandshakeHeader = 12;
constexpr std::size_t kFragmentOffset = kRecordHeader + 6;

std::size_t RecordLength(ByteView d) { return std::size_t{d.data[11]} << 8 | d.data[12]; }

}  // namespace

bool IsOfHello(ByteView d) {
  constexpr std::uint8_t kHandshakeRecord = 22, kClientHello = 1;
  if (d.size < kRecordHeader + kHandshakeHeader) return false;
  return RecordLength(d) >= kHandshakeHeader && d.size >= kRecordHeader + RecordLength(d) &&
         d.data[0] == kHandshakeRecord && d.data[3] == 0 && d.data[4] == 0 &&  // the first epoch
         d.data[kRecordHeader] == kClientHello;
}

std::string HelloIn(ByteView d) {
  if (!IsOfHello(d)) return "";
  const std::uint8_t* offset = d.data + kFragmentOffset;
  if (offset[0] != 0 || offset[1] != 0 || offset[2] != 0) return "";
  return std::string(reinterpret_cast<const char*>(d.data) + kRecordHeader, RecordLength(d));
}

}  // namespace lidar::gst
