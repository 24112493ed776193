// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of a connection on a test clock. The peer reads nothing, sends nothing, or sends nonsense.
#include "ext/web/client.h"

#include <gio/gunixsocketaddress.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <utility>

namespace lidar::web {
namespace {

class Connection : public ::testing::Test {
 protected:
  void SetUp() override {
    now_us_ = 0;
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
        std::move(handlers), [] { return now_us_; });
  }
  void TearDown() override {
    client_.reset();
    close(peer_);
  }
  void TickAt(gint64 seconds) {
    now_us_ = seconds * G_USEC_PER_SEC;
    client_->Tick();
  }
  std::string Read() {
    std::array<char, 64> bytes{};
    const ssize_t size = recv(peer_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    return {bytes.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
  }
  /// Returns a message that is larger than the buffers of sockets.
  static SharedMessage Large() {
    auto message = std::make_shared<Message>();
    message->payload.resize(4 << 20);
    return message;
  }

  static inline gint64 now_us_ = 0;
  int peer_ = -1;
  int closed_ = 0;
  std::unique_ptr<Client> client_;
};

TEST_F(Connection, ThatSaysNothingIsAskedAndEnds) {
  TickAt(5);
  EXPECT_EQ(Read(), "");
  TickAt(11);
  // A ping, so that proxies do not close an idle connection.
  EXPECT_EQ(Read(), std::string("\x89\0", 2));
  for (const gint64 seconds : {12, 21, 29}) {
    TickAt(seconds);
    EXPECT_EQ(Read(), "") << "it was asked";
  }
  EXPECT_EQ(closed_, 0);
  TickAt(31);
  EXPECT_EQ(closed_, 1);
}

TEST_F(Connection, ThatThePeerBreaksOffEndsAtOnce) {
  client_->SendText("that nobody reads");
  close(std::exchange(peer_, -1));
  for (int i = 0; i < 100 && closed_ == 0; ++i) g_main_context_iteration(nullptr, FALSE);
  EXPECT_EQ(closed_, 1);
}

TEST_F(Connection, ThatAnswersPingsLives) {
  for (const gint64 seconds : {11, 22, 33, 44}) {
    TickAt(seconds);
    EXPECT_EQ(Read(), std::string("\x89\0", 2));
    ASSERT_EQ(write(peer_, "\x8a\x80\0\0\0\0", 6), 6);
    while (g_main_context_iteration(nullptr, FALSE)) continue;
  }
  EXPECT_EQ(closed_, 0);
}

/// While a large frame is being sent, the peer gets no ping and cannot answer one.
TEST_F(Connection, ThatTakesALongFrameSlowlyLivesWhileItTakesSome) {
  client_->Send({1, 1, Large()}, 1);
  std::array<char, 1 << 16> part{};
  for (const gint64 seconds : {20, 40, 60, 80}) {
    now_us_ = seconds * G_USEC_PER_SEC;
    for (int i = 0; i < 8; ++i) {
      ASSERT_GT(recv(peer_, part.data(), part.size(), MSG_DONTWAIT), 0);
      while (g_main_context_iteration(nullptr, FALSE)) continue;
    }
    TickAt(seconds);
    ASSERT_EQ(closed_, 0);
  }
  TickAt(109);
  EXPECT_EQ(closed_, 0);
  TickAt(111);
  EXPECT_EQ(closed_, 1);
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

/// A frame that the server sends.
struct ServerFrame {
  unsigned opcode = 0;
  std::string payload;
};

/// A fixture whose peer speaks the WebSocket protocol.
class Conversation : public Connection {
 protected:
  /// Returns the frames that `client_` sends, until it sends nothing more.
  std::vector<ServerFrame> Frames() {
    std::array<char, 1 << 16> bytes{};
    for (int idle = 0; idle < 3;) {
      const ssize_t size = recv(peer_, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (size > 0) read_.append(bytes.data(), static_cast<std::size_t>(size));
      if (size > 0) bytes_ += static_cast<std::uint64_t>(size);
      idle = size > 0 || g_main_context_iteration(nullptr, FALSE) ? 0 : idle + 1;
    }
    std::vector<ServerFrame> frames;
    for (;;) {
      ByteReader r(reinterpret_cast<const std::uint8_t*>(read_.data()), read_.size());
      const unsigned first = r.U8();
      std::uint64_t size = r.U8();
      if (size == 126) size = r.Be16();
      if (size == 127) size = r.Be64();
      const ByteView payload = r.Bytes(static_cast<std::size_t>(size));
      if (!r.ok()) return frames;
      EXPECT_EQ(first & 0xF0U, 0x80U) << "whole frames";
      frames.push_back({first & 0xFU, std::string(payload.begin(), payload.end())});
      read_.erase(0, r.position());
    }
  }
  /// Sends a masked frame, as a WebSocket client must. The mask is zero.
  void Say(unsigned opcode, const std::string& payload) {
    std::string frame{static_cast<char>(0x80U | opcode), static_cast<char>(0x80U | payload.size())};
    frame += std::string(4, '\0') + payload;
    ASSERT_EQ(write(peer_, frame.data(), frame.size()), static_cast<ssize_t>(frame.size()));
  }
  static SharedMessage Text(const std::string& text) {
    auto message = std::make_shared<Message>();
    message->payload.assign(text.begin(), text.end());
    return message;
  }
  static SharedSliceMessage SliceOf(const std::string& text) {
    auto slice = std::make_shared<SliceMessage>();
    slice->payload.assign(text.begin(), text.end());
    return slice;
  }
  /// Returns the last two bytes of the payload of each frame. They identify the frame in a test.
  static std::vector<std::string> EndsOf(const std::vector<ServerFrame>& frames) {
    std::vector<std::string> ends;
    for (const ServerFrame& f : frames) ends.push_back(f.payload.substr(f.payload.size() - 2));
    return ends;
  }

  std::string read_;
  std::uint64_t bytes_ = 0;
};

TEST_F(Conversation, AnswersAPingWithWhatItSaid) {
  for (const std::size_t size : {0U, 1U, 16U, 125U}) {
    const std::string said(size, static_cast<char>('a' + size % 7));
    Say(9, said);
    const auto frames = Frames();
    ASSERT_EQ(frames.size(), 1U) << size;
    EXPECT_EQ(frames[0].opcode, 10U);
    EXPECT_EQ(frames[0].payload, said);
  }
  EXPECT_EQ(client_->counters().messages, 0U);
}

TEST_F(Conversation, EndsWithTheReasonAsAnAnswer) {
  Say(8, std::string("\x03\xe9", 2));
  const auto frames = Frames();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].opcode, 8U);
  EXPECT_EQ(frames[0].payload, std::string("\x03\xe8", 2));  // close code 1000
  EXPECT_EQ(closed_, 1);
  client_->SendText("too late");
  EXPECT_TRUE(Frames().empty());
}

TEST_F(Conversation, ThatIsClosedByUsNamesTheReason) {
  client_->Close(foxglove::CloseCode::kTokenOver);
  const auto frames = Frames();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].opcode, 8U);
  EXPECT_EQ(frames[0].payload, std::string("\x11\x31", 2));  // close code 4401
  EXPECT_EQ(closed_, 1);
}

TEST_F(Conversation, CountsWhatThePeerGot) {
  client_->SendText("about");
  client_->Send({1, 1, Text("m1")}, 4);
  client_->SendSlice(2, 2, SliceOf("s1"));
  Say(9, "ping");
  client_->Send({1, 1, Large()}, 4);
  client_->Send({3, 3, Text(std::string(70'000, 'x'))}, 4);
  EXPECT_EQ(Frames().size(), 6U);
  EXPECT_EQ(client_->counters().messages, 4U) << "data only";
  EXPECT_EQ(client_->counters().bytes, bytes_);
}

/// While a large frame is being sent, all other messages wait.
TEST_F(Conversation, SendsControlsThenSlicesThenMessages) {
  client_->Send({1, 1, Large()}, 1);
  client_->Send({1, 1, Text("m1")}, 4);
  client_->SendSlice(2, 2, SliceOf("s1"));
  client_->SendText("c1");
  client_->Send({3, 3, Text("m2")}, 4);
  client_->SendSlice(2, 2, SliceOf("s2"));
  client_->SendText("c2");
  const auto ends = EndsOf(Frames());
  const std::vector<std::string> behind(ends.begin() + 1, ends.end());
  EXPECT_EQ(behind, (std::vector<std::string>{"c1", "c2", "s1", "s2", "m1", "m2"}));
}

TEST_F(Conversation, ForgetsOfAChannelAllThatWaitsAndOfOthersNothing) {
  client_->Send({1, 1, Large()}, 1);
  for (const std::uint32_t channel : {2U, 3U, 2U, 4U}) {
    const std::string number = std::to_string(channel);
    client_->SendSlice(channel, channel, SliceOf("s" + number));
    client_->Send({channel, channel, Text("m" + number)}, 4);
  }
  client_->Forget(2);
  const auto ends = EndsOf(Frames());
  const std::vector<std::string> behind(ends.begin() + 1, ends.end());
  EXPECT_EQ(behind, (std::vector<std::string>{"s3", "s4", "m3", "m4"}));
}

}  // namespace
}  // namespace lidar::web
