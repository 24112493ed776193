// SPDX-License-Identifier: LGPL-2.1-or-later
// A connection, by the clock of the test: whose peer reads nothing, says nothing, or lies.
#include "ext/web/client.h"

#include <gio/gunixsocketaddress.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace lidar::web {
namespace {

constexpr gint64 kTick_us = G_USEC_PER_SEC;

class Connection : public ::testing::Test {
 protected:
  void SetUp() override {
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    peer_ = ends[1];
    const ObjectPtr<GSocket> socket(g_socket_new_from_fd(ends[0], nullptr));
    Client::Handlers handlers;
    handlers.on_text = [](Client*, const auto&) {};
    handlers.on_garbage = [](Client*) {};
    handlers.on_closed = [this](Client*) { ++closed_; };
    client_ = std::make_unique<Client>(
        ObjectPtr<GIOStream>(
            G_IO_STREAM(g_socket_connection_factory_create_connection(socket.get()))),
        std::move(handlers));
  }
  void TearDown() override {
    client_.reset();
    close(peer_);
  }
  void TickAt(gint64 seconds) { client_->Tick(start_us_ + seconds * kTick_us); }
  std::string Read() {
    std::array<char, 64> bytes{};
    const ssize_t size = recv(peer_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    return {bytes.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
  }
  /// More than the buffers of sockets hold.
  static SharedMessage Large() {
    auto message = std::make_shared<Message>();
    message->payload.resize(4 << 20);
    return message;
  }

  const gint64 start_us_ = g_get_monotonic_time();
  int peer_ = -1;
  int closed_ = 0;
  std::unique_ptr<Client> client_;
};

TEST_F(Connection, ThatSaysNothingIsAskedAndEnds) {
  TickAt(5);
  EXPECT_EQ(Read(), "");
  TickAt(11);
  EXPECT_EQ(Read(), std::string("\x89\0", 2));  // a ping, before proxies close what is idle
  TickAt(29);
  EXPECT_EQ(closed_, 0);
  TickAt(31);
  EXPECT_EQ(closed_, 1);
}

TEST_F(Connection, ThatAnswersPingsLives) {
  for (const gint64 seconds : {11, 20, 29}) {
    TickAt(seconds);
    EXPECT_EQ(Read(), std::string("\x89\0", 2));
    ASSERT_EQ(write(peer_, "\x8a\x80\0\0\0\0", 6), 6);
    while (g_main_context_iteration(nullptr, FALSE)) continue;
  }
  EXPECT_EQ(closed_, 0);
}

TEST_F(Connection, ThatReadsNothingEnds) {
  client_->Send({1, 1, Large()}, 1);
  TickAt(29);
  EXPECT_EQ(closed_, 0);
  TickAt(31);
  EXPECT_EQ(closed_, 1);
  EXPECT_EQ(client_->Send({1, 1, Large()}, 1), 0U);
}

TEST_F(Connection, ThatHasDrawnWhatItDidNotReadEnds) {
  client_->Send({1, 1, Large()}, 1);
  const auto slice = std::make_shared<const SliceMessage>();
  for (int i = 0; i < 2048; ++i) client_->SendSlice(2, 2, slice);
  EXPECT_EQ(closed_, 0);
  client_->SendSlice(2, 2, slice);
  EXPECT_EQ(closed_, 1);
}

}  // namespace
}  // namespace lidar::web
