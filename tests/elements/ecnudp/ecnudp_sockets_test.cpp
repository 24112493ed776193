// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of sockets that an application gives to ecnudpsink and ecnudpsrc.
#include <gtest/gtest.h>

#include "gst/net/datagram.h"
#include "tests/elements/ecnudp/ecnudp_support.h"
#include "tests/support/element_bus.h"
#include "tests/support/free_ports.h"

namespace lidar::gst {
namespace {

using test::Harness;
using test::SetPlaying;

/// Returns a socket as an application would make it. It is bound to `address`, or to a free port if
/// `address` is null.
Object<GSocket> Bound(GSocketAddress* address = nullptr) {
  Object<GSocket> socket(
      g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP, nullptr));
  const Object<GInetAddress> any(g_inet_address_new_loopback(G_SOCKET_FAMILY_IPV4));
  const Object<GSocketAddress> local(g_inet_socket_address_new(any.get(), 0));
  EXPECT_TRUE(
      g_socket_bind(socket.get(), address != nullptr ? address : local.get(), FALSE, nullptr));
  return socket;
}

TEST(EcnUdpSockets, TheReceiveBufferHasTheSizeThatTheKernelGrants) {
  const auto socket = Bound();
  for (const unsigned bytes : {8'192U, 65'536U, 131'072U})
    EXPECT_EQ(lidar::net::SetReceiveBuffer(g_socket_get_fd(socket.get()), bytes), bytes);
  EXPECT_EQ(lidar::net::SetReceiveBuffer(-1, 8'192), 0U);
}

TEST(EcnUdpSockets, ASinkWhoseLocalAddressIsNotTheMachinesSaysSo) {
  const ElementPtr sink(gst_element_factory_make("ecnudpsink", nullptr));
  const test::ElementBus bus(sink.get());
  g_object_set(sink.get(), "host", "127.0.0.1", "port", 9, "bind-address", "203.0.113.9", nullptr);
  EXPECT_EQ(gst_element_set_state(sink.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const MessagePtr error = bus.Pop(GST_MESSAGE_ERROR);
  ASSERT_TRUE(error);
  EXPECT_EQ(test::MessageText(error.get()).find("Cannot open a UDP socket: Error binding"), 0U);
  EXPECT_NE(test::MessageDetails(error.get()).find("bind-address '203.0.113.9' bind-port 0"),
            std::string::npos);
  gst_element_set_state(sink.get(), GST_STATE_NULL);
}

TEST(EcnUdpSockets, AGivenSocketStaysOpenWhereAsked) {
  Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  const auto socket = Bound();
  g_object_set(src->element, "socket", socket.get(), "close-socket", FALSE, nullptr);
  SetPlaying(src.get());
  gst_element_set_state(src->element, GST_STATE_NULL);
  EXPECT_FALSE(g_socket_is_closed(socket.get()));
  g_object_set(src->element, "close-socket", TRUE, nullptr);
  SetPlaying(src.get());
  gst_element_set_state(src->element, GST_STATE_NULL);
  EXPECT_TRUE(g_socket_is_closed(socket.get()));
}

/// The application sends to a port that is still closed. The kernel reports this as an error of the
/// socket.
TEST(EcnUdpSockets, APeerThatDoesNotListenYetEndsNothing) {
  const auto socket = Bound();
  const Object<GSocketAddress> here(g_socket_get_local_address(socket.get(), nullptr));
  const Object<GSocketAddress> there(
      g_inet_socket_address_new_from_string("127.0.0.1", test::FreePort()));
  ASSERT_TRUE(g_socket_connect(socket.get(), there.get(), nullptr, nullptr));
  ASSERT_EQ(g_socket_send(socket.get(), "?", 1, nullptr, nullptr), 1);
  const Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  g_object_set(src->element, "socket", socket.get(), nullptr);
  SetPlaying(src.get());
  const auto peer = Bound(there.get());
  ASSERT_EQ(g_socket_send_to(peer.get(), here.get(), "!", 1, nullptr, nullptr), 1);
  const BufferPtr got(gst_harness_pull(src.get()));
  ASSERT_TRUE(got);
  EXPECT_EQ(Text(got.get()), "!");
}

TEST(EcnUdpSockets, ASocketThatIsReplacedWhileItIsUsedIsTreatedAsItWasGiven) {
  for (const char* factory : {"ecnudpsrc", "ecnudpsink"}) {
    const ElementPtr element(gst_element_factory_make(factory, nullptr));
    const auto first = Bound();
    const auto second = Bound();
    const auto used_between = [&](GSocket* begin, GSocket* end) {
      g_object_set(element.get(), "socket", begin, "close-socket", FALSE, nullptr);
      ASSERT_NE(gst_element_set_state(element.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
      g_object_set(element.get(), "socket", end, nullptr);
      gst_element_set_state(element.get(), GST_STATE_NULL);
    };
    used_between(first.get(), second.get());
    EXPECT_FALSE(g_socket_is_closed(first.get())) << factory;
    used_between(first.get(), nullptr);
    EXPECT_FALSE(g_socket_is_closed(first.get())) << factory;
  }
}

}  // namespace
}  // namespace lidar::gst
