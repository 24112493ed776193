// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of clients that read nothing, send nothing or send nonsense. They must not disturb the
// pipeline.
#include <gtest/gtest.h>

#include "src/foxglove/websocket.h"
#include "tests/elements/coders/stopped_clock.h"
#include "tests/elements/web/many_files.h"
#include "tests/elements/web/web_peer.h"
#include "tests/support/patience.h"
#include "tests/support/proto_reader.h"

namespace lidar::test {
namespace {

/// A TCP connection on which the test sends arbitrary bytes. Read() blocks.
class RawClient {
 public:
  explicit RawClient(Sink* sink, const char* from = "127.0.0.1") {
    GSocketClient* client = g_socket_client_new();
    GSocketAddress* address = g_inet_socket_address_new_from_string(from, 0);
    g_socket_client_set_local_address(client, address);
    g_object_unref(address);
    connection_ = g_socket_client_connect_to_host(
        client, "127.0.0.1", static_cast<guint16>(sink->Stat("port")), nullptr, nullptr);
    g_object_unref(client);
    EXPECT_NE(connection_, nullptr);
    g_socket_set_timeout(g_socket_connection_get_socket(connection_), kPatience.count());
  }
  ~RawClient() { g_clear_object(&connection_); }
  RawClient(RawClient&& o) noexcept : connection_(std::exchange(o.connection_, nullptr)) {}
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool Send(const std::string& bytes) {
    return g_output_stream_write_all(g_io_stream_get_output_stream(G_IO_STREAM(connection_)),
                                     bytes.data(), bytes.size(), nullptr, nullptr,
                                     nullptr) != FALSE;
  }
  /// Reads at most `size` bytes. Returns an empty string at the end of the stream.
  std::string Read(std::size_t size) {
    std::string bytes(size, 0);
    const gssize n = g_input_stream_read(g_io_stream_get_input_stream(G_IO_STREAM(connection_)),
                                         bytes.data(), size, nullptr, nullptr);
    bytes.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return bytes;
  }
  /// Reads exactly `size` bytes. Returns an empty string if the stream ends before.
  std::string ReadAll(std::size_t size) {
    std::string all;
    while (all.size() < size) {
      const std::string part = Read(size - all.size());
      if (part.empty()) return "";
      all += part;
    }
    return all;
  }
  void Upgrade() {
    Send(
        "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n");
    std::string head;
    while (head.find("\r\n\r\n") == std::string::npos) {
      const std::string byte = Read(1);
      ASSERT_FALSE(byte.empty());
      head += byte;
    }
    EXPECT_EQ(head.substr(0, 12), "HTTP/1.1 101");
  }
  void SendText(const std::string& text) {
    std::string frame(1, '\x81');
    if (text.size() < 126) {
      frame += static_cast<char>(0x80 | text.size());
    } else {
      frame += '\xFE';
      frame += static_cast<char>(text.size() >> 8);
      frame += static_cast<char>(text.size());
    }
    Send(frame + std::string(4, '\0') + text);  // the mask is zero
  }
  /// Returns the payload of the next frame that is not a ping, or an empty string if the connection
  /// ends.
  std::string ReadFrame() {
    for (;;) {
      const std::string head = ReadAll(2);
      if (head.empty()) return "";
      std::uint64_t size = static_cast<std::uint8_t>(head[1]);
      if (size >= 126) {
        const std::string more = ReadAll(size == 126 ? 2 : 8);
        size = 0;
        for (const char c : more) size = size << 8 | static_cast<std::uint8_t>(c);
      }
      const bool is_ping = (head[0] & 0x0F) == 9;
      const std::string payload = size > 0 ? ReadAll(size) : "";
      if (!is_ping) return payload;
    }
  }

 private:
  GSocketConnection* connection_;
};

/// Returns a client that is subscribed to /points.
RawClient SubscribedClient(Sink* sink) {
  RawClient client(sink);
  client.Upgrade();
  const auto advertise = [&] {
    for (;;) {
      const auto text = nlohmann::json::parse(client.ReadFrame());
      if (text["op"] != "advertise") continue;
      for (const auto& channel : text["channels"])
        if (channel["topic"] == "/points") return channel["id"].get<int>();
    }
  };
  const int id = advertise();
  client.SendText(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":)" +
                  std::to_string(id) + "}]}");
  client.SendText(R"({"op":"nothing"})");
  client.ReadFrame();  // the answer shows that the client is subscribed now
  return client;
}

/// Returns a client that is subscribed to /points but has not read any clouds. The sockets' buffers
/// are full, so further clouds wait or are dropped.
RawClient StalledClient(Sink* sink) {
  constexpr guint kColumns = 100'000;
  sink->SetCloudCaps(kColumns);
  sink->PushCloud(1, kColumns);
  RawClient slow = SubscribedClient(sink);
  for (int i = 1; i <= 12; ++i) sink->PushCloud(static_cast<float>(i), kColumns);
  EXPECT_TRUE(WaitUntil([&] { return sink->Stat("messages-dropped") > 2; }));
  return slow;
}

float XOf(const std::string& frame) {
  const ProtoMessage cloud(
      {reinterpret_cast<const std::uint8_t*>(frame.data()) + 13, frame.size() - 13});
  float x = 0;
  std::memcpy(&x, cloud.Text(6).data(), sizeof x);
  return x;
}

/// The sink closes a connection that reads nothing for 30 s, so the clock stands still.
class SlowClient : public ::testing::Test {
  const StoppedClock clock_;
};

TEST_F(SlowClient, GetsTheNewestAndHoldsUpNobody) {
  constexpr guint kColumns = 100'000;  // 1.6 MB for each cloud
  constexpr int kClouds = 16;
  Sink sink;
  sink.SetCloudCaps(kColumns);
  sink.PushCloud(1, kColumns);
  RawClient slow = SubscribedClient(&sink);
  Peer quick(&sink);
  quick.Subscribe("/points", 1);
  for (int i = 1; i <= kClouds; ++i) {
    ASSERT_EQ(sink.PushCloud(static_cast<float>(i), kColumns), GST_FLOW_OK);
    quick.Next();
  }
  // The slow client receives the clouds that were in the sockets' buffers, and after them the last
  // cloud.
  ASSERT_TRUE(WaitUntil([&] { return sink.Stat("messages-dropped") > kClouds / 2; }));
  int got = 0;
  float newest = 0;
  while (newest < kClouds && got < kClouds) {
    const std::string frame = slow.ReadFrame();
    ASSERT_FALSE(frame.empty());
    newest = XOf(frame);
    ++got;
  }
  EXPECT_EQ(newest, static_cast<float>(kClouds));
  EXPECT_LT(got, kClouds / 2);
  EXPECT_LE(sink.Stat("messages-dropped") + static_cast<guint64>(got), guint64{kClouds});
}

TEST_F(SlowClient, GetsNothingThatWaitedOnceItUnsubscribed) {
  Sink sink;
  RawClient slow = StalledClient(&sink);
  slow.SendText(R"({"op":"unsubscribe","subscriptionIds":[1]})");
  slow.SendText(R"({"op":"nothing"})");
  // Skips the messages that were in the sockets' buffers. The answer comes after them.
  std::string frame;
  do {
    frame = slow.ReadFrame();
    ASSERT_FALSE(frame.empty());
  } while (frame[0] != '{');
  slow.SendText(R"({"op":"nothing"})");
  EXPECT_EQ(slow.ReadFrame()[0], '{');
}

TEST_F(SlowClient, GetsNothingThatWaitedOnceItsTopicIsGone) {
  Sink sink;
  RawClient slow = StalledClient(&sink);
  gst_harness_set_src_caps_str(sink.harness(), "application/x-draco,geometry=xyz,alignment=slice");
  std::string frame;
  do {
    frame = slow.ReadFrame();
    ASSERT_FALSE(frame.empty());
  } while (frame[0] != '{');
  EXPECT_EQ(nlohmann::json::parse(frame)["op"], "unadvertise");
  EXPECT_EQ(nlohmann::json::parse(slow.ReadFrame())["op"], "advertise");
  slow.SendText(R"({"op":"nothing"})");
  EXPECT_EQ(slow.ReadFrame()[0], '{');
}

TEST_F(SlowClient, MissesWholeScansButNoSliceOfThoseThatItGets) {
  constexpr guint kColumns = 20'000;
  constexpr guint kSlices = 4;
  Sink sink;
  sink.SetCloudCaps(kColumns);
  sink.PushCloud(1, kColumns);
  RawClient slow = SubscribedClient(&sink);
  std::vector<float> points(kColumns * 4, 1);
  for (guint i = 0; i < 40 * kSlices; ++i) {
    points[0] = static_cast<float>(i);
    GstBuffer* buffer = gst_buffer_new_memdup(points.data(), points.size() * sizeof(float));
    const GstLidarSlice slice = {i / kSlices, i % kSlices, kSlices, 0};
    gst_lidar_buffer_set_slice(buffer, &slice);
    ASSERT_EQ(gst_harness_push(sink.harness(), buffer), GST_FLOW_OK);
  }
  std::vector<int> got;
  while (got.empty() || got.back() < static_cast<int>(40 * kSlices - 1)) {
    const std::string frame = slow.ReadFrame();
    ASSERT_FALSE(frame.empty());
    got.push_back(static_cast<int>(XOf(frame)));
  }
  ASSERT_GE(got.size(), kSlices);
  for (guint i = 1; i <= kSlices; ++i)
    EXPECT_EQ(got[got.size() - i], static_cast<int>(40 * kSlices - i));
}

TEST(SilentConnections, ByTheThousandGiveWayToThoseThatAsk) {
  const ManyFiles files(4096);
  const std::size_t count = files.granted() >= 4096 ? 2000 : 200;
  Sink sink;
  sink.SetCloudCaps();
  Peer early(&sink);
  std::vector<RawClient> silent;
  for (std::size_t i = 0; i < count; ++i) {
    silent.emplace_back(&sink);
    if (i % 2 == 0) silent.back().Send("GET / HT");
    while (g_main_context_iteration(nullptr, FALSE)) continue;  // `early` answers pings
  }
  Peer peer(&sink);
  ASSERT_TRUE(peer.connected());
  EXPECT_EQ(HttpGet(sink.Url("http")).status, 200U);
  EXPECT_TRUE(WaitUntil([&] { return sink.Stat("connections-evicted") >= count - 50; }));
  ASSERT_FALSE(early.closed()) << "a viewer that says nothing is no silent connection";
  for (Peer* viewer : {&early, &peer}) viewer->Subscribe("/points", 1);
  sink.PushCloud(1);
  for (Peer* viewer : {&early, &peer}) EXPECT_EQ(viewer->Next().subscription, 1U);
}

TEST(SilentConnections, OfOneAddressGiveWayToNoneOfAnother) {
  Sink sink;
  RawClient first(&sink, "127.0.0.2");
  std::vector<RawClient> silent;
  for (std::size_t i = 0; i < 60; ++i) silent.emplace_back(&sink);
  EXPECT_TRUE(WaitUntil([&] { return sink.Stat("connections-evicted") >= 25; }));
  first.Send("GET /nothing HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(first.ReadAll(8), "HTTP/1.1");
}

struct Named {
  const char* host;
  const char* status;
};
class HostName : public ::testing::TestWithParam<Named> {};
/// The owner of a DNS name can make it point to 127.0.0.1. For a browser, a page from that name and
/// this server then have the same origin.
TEST_P(HostName, OfAnotherSiteReadsNothing) {
  Sink sink;
  for (const std::string request : {"GET /session HTTP/1.1\r\n", "GET / HTTP/1.1\r\n"}) {
    RawClient client(&sink);
    const bool is_socket = request.find("session") == std::string::npos;
    const std::string host = GetParam().host;
    client.Send(request + "Host: " + host + "\r\nOrigin: http://" + host + "\r\n" +
                (is_socket ? "Upgrade: websocket\r\nConnection: Upgrade\r\n"
                             "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                             "Sec-WebSocket-Version: 13\r\n"
                             "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
                           : "\r\n"));
    const std::string status = client.ReadAll(12).substr(9);
    EXPECT_EQ(status,
              is_socket && GetParam().status == std::string("200") ? "101" : GetParam().status);
  }
}
INSTANTIATE_TEST_SUITE_P(All, HostName,
                         ::testing::Values(Named{"127.0.0.1:8765", "200"}, Named{"[::1]", "200"},
                                           Named{"localhost:1", "200"},
                                           Named{"evil.example", "403"},
                                           Named{"127.0.0.1.evil.example:8765", "403"},
                                           Named{"localhost.evil.example", "403"},
                                           Named{"0x7f000001.example", "403"}));

struct Nonsense {
  const char* name;
  bool upgrade;
  std::string bytes;
  guint64 malformed = 0;  // expected value of the server's counter
};

class NonsenseClient : public ::testing::TestWithParam<Nonsense> {};

TEST_P(NonsenseClient, IsDisconnectedAndOthersAreServed) {
  Sink sink;
  sink.SetCloudCaps();
  Peer peer(&sink);
  peer.Subscribe("/points", 1);
  {
    RawClient client(&sink);
    if (GetParam().upgrade) client.Upgrade();
    client.Send(GetParam().bytes);
    for (int i = 0; i < 1000 && !client.Read(65'536).empty(); ++i) continue;
  }
  ASSERT_TRUE(WaitUntil([&] { return sink.Stat("clients") == 1; }));
  EXPECT_EQ(sink.Stat("malformed"), GetParam().malformed);
  sink.PushCloud(1);
  EXPECT_EQ(peer.Next().subscription, 1U);
}

INSTANTIATE_TEST_SUITE_P(
    All, NonsenseClient,
    ::testing::Values(
        Nonsense{"not_http", false, std::string(1000, '\x16') + "\r\n\r\n"},
        Nonsense{"endless_header", false, "GET / HTTP/1.1\r\nX: " + std::string(300'000, 'a')},
        Nonsense{"unmasked_frame", true, "\x81\x02hi", 1},
        Nonsense{"huge_frame", true,
                 "\x82\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF"
                 "1234",
                 1},
        Nonsense{"garbage_frames", true, std::string(100'000, '\xAA'), 1},
        Nonsense{"data_and_close", true, std::string("\x82\x80\0\0\0\0\x88\x80\0\0\0\0", 12), 1},
        Nonsense{"close", true, std::string("\x88\x80\0\0\0\0", 6)}),
    [](const auto& bad) { return std::string(bad.param.name); });

TEST(Flood, OfPingsIsAnsweredWithoutAQueue) {
  Sink sink;
  RawClient client(&sink);
  client.Upgrade();
  std::string pings;
  for (int i = 0; i < 2000; ++i)
    pings += std::string("\x89\xFD\0\0\0\0", 6) + std::string(125, 'p');
  for (int i = 0; i < 40; ++i) {
    if (!client.Send(pings)) break;
  }
  EXPECT_EQ(HttpGet(sink.Url("http")).status, 200U);
}

TEST(Flood, OfRequestsThatNobodyReadsTheAnswersOfEndsTheClient) {
  Sink sink;
  RawClient client(&sink);
  client.Upgrade();
  std::string requests;
  const std::string one = R"({"op":"x"})";
  for (int i = 0; i < 5000; ++i)
    requests +=
        '\x81' + std::string(1, static_cast<char>(0x80 | one.size())) + std::string(4, '\0') + one;
  bool ended = false;
  for (int i = 0; i < 100 && !ended; ++i) ended = !client.Send(requests);
  EXPECT_TRUE(ended);
  EXPECT_TRUE(WaitUntil([&] { return sink.Stat("clients") == 0; }));
}

}  // namespace
}  // namespace lidar::test
