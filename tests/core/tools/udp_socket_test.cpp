// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/common/udp_socket.h"

#include <gtest/gtest.h>

#include <exception>
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

TEST(UdpAddresses, AreHostAndPortWithBracketsAroundIpv6) {
  struct Case {
    const char* text;
    const char* host;
    const char* port;
  };
  for (const auto& [text, host, port] :
       {Case{"robot:7502", "robot", "7502"}, Case{"7502", "here", "7502"},
        Case{":7502", "here", "7502"}, Case{"[fe80::1]:7502", "fe80::1", "7502"},
        Case{"[]:7502", "here", "7502"}, Case{"[a:7502", "[a", "7502"}}) {
    const HostPort parts = Split(text, "here");
    EXPECT_EQ(parts.host, host) << text;
    EXPECT_EQ(parts.port, port) << text;
  }
  EXPECT_EQ(ToString(ResolveAddress("[::1]:7502", "")), "[::1]:7502");
  EXPECT_EQ(ToString(ResolveAddress("7502", "127.0.0.1")), "127.0.0.1:7502");
}

/// Returns the text of the exception that `action` throws.
template <class Action>
std::string ErrorOf(Action action) {
  try {
    action();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "no error";
}

TEST(UdpAddresses, ThatCannotBeUsedAreNamedInTheError) {
  const auto expect_begin = [](const std::string& error, const std::string& begin) {
    EXPECT_EQ(error.substr(0, begin.size()), begin);
  };
  expect_begin(ErrorOf([] { ResolveAddress("127.0.0.1:no port", ""); }),
               "cannot resolve '127.0.0.1:no port': ");
  const UdpSocket taken = BoundSocket();
  const Address address = AddressOf(taken);
  expect_begin(ErrorOf([&] { UdpSocket::Bind(address); }),
               "cannot listen on " + ToString(address) + ": ");
  // Without the option SO_BROADCAST, a socket may not send to a broadcast address.
  expect_begin(ErrorOf([] { UdpSocket::Connect(ResolveAddress("255.255.255.255:9", "")); }),
               "cannot reach 255.255.255.255:9: ");
  expect_begin(ErrorOf([] { BoundSocket().SendMulticastFrom("nosuch0"); }),
               "cannot send multicast from nosuch0: ");
}

}  // namespace
}  // namespace lidar::tools
