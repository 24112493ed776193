// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/common/udp_socket.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/patience.h"

namespace lidar::tools {
namespace {

UdpSocket BoundSocket() { return UdpSocket::Bind(ResolveAddress("127.0.0.1:0", "")); }
Address AddressOf(const UdpSocket& socket) {
  return ResolveAddress("127.0.0.1:" + std::to_string(socket.LocalPort()), "");
}

TEST(UdpSocket, LosesNoPacketToTheRefusalOfAnEarlierOne) {
  const std::uint8_t byte = 7;
  UdpSocket sender = UdpSocket::Connect(AddressOf(BoundSocket()));
  EXPECT_TRUE(sender.Send({&byte, 1}, 0, nullptr)) << "nobody receives it";
  UdpSocket receiver = BoundSocket();
  const Address to = AddressOf(receiver);
  EXPECT_TRUE(sender.Send({&byte, 1}, 0, &to));
  int received = 0;
  EXPECT_TRUE(test::Eventually([&] {
    receiver.ReceiveAll([&](const Datagram&) { ++received; });
    return received > 0;
  }));
}

}  // namespace
}  // namespace lidar::tools
