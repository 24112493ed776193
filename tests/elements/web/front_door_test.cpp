// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the code that accepts connections, on a test clock.
#include "ext/web/front_door.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <set>
#include <vector>

#include "ext/web/archive.h"
#include "ext/web/client.h"
#include "ext/web/handshakes.h"
#include "ext/web/recording.h"
#include "ext/web/server.h"
#include "ext/web/slice_service.h"
#include "tests/elements/web/web_peer.h"
#include "tests/support/files.h"

namespace lidar::web {
namespace {

constexpr gint64 kSecond_us = G_USEC_PER_SEC;

/// Connects to a port of this machine. Returns the client's end of the connection.
ObjectPtr<GSocketConnection> Connect(guint16 port, const char* from = "127.0.0.1") {
  const ObjectPtr<GSocketClient> client(g_socket_client_new());
  const ObjectPtr<GSocketAddress> address(g_inet_socket_address_new_from_string(from, 0));
  g_socket_client_set_local_address(client.get(), address.get());
  return ObjectPtr<GSocketConnection>(
      g_socket_client_connect_to_host(client.get(), "127.0.0.1", port, nullptr, nullptr));
}

/// Returns true if the other end has closed the connection.
bool HasEnded(const ObjectPtr<GSocketConnection>& connection) {
  GSocket* socket = g_socket_connection_get_socket(connection.get());
  return (g_socket_condition_check(socket, G_IO_IN) & G_IO_IN) != 0;
}

TEST(FrontDoor, EndsAfterAMinuteWhatAsksForNothing) {
  const ObjectPtr<SoupServer> server(
      SOUP_SERVER(g_object_new(SOUP_TYPE_SERVER, "server-header", "test", nullptr)));
  FrontDoor door(server.get(), nullptr, {});
  const ObjectPtr<GInetAddress> address(g_inet_address_new_from_string("127.0.0.1"));
  std::string error;
  const guint16 port = door.Listen(address.get(), 0, &error);
  ASSERT_NE(port, 0) << error;
  const auto silent = Connect(port);
  ASSERT_TRUE(silent);
  const gint64 begin = g_get_monotonic_time();
  // The minute begins when `door` notices the connection, which may be later than `begin`.
  EXPECT_TRUE(test::WaitUntil([&] {
    door.Tick(begin + 55 * kSecond_us);
    EXPECT_EQ(door.evicted(), 0U);
    door.Tick(g_get_monotonic_time() + 61 * kSecond_us);
    return door.evicted() == 1;
  }));
  EXPECT_TRUE(test::WaitUntil([&] { return HasEnded(silent); }));
}

TEST(FrontDoor, SaysWhyItCannotListen) {
  const ObjectPtr<SoupServer> server(
      SOUP_SERVER(g_object_new(SOUP_TYPE_SERVER, "server-header", "test", nullptr)));
  FrontDoor first(server.get(), nullptr, {});
  FrontDoor second(server.get(), nullptr, {});
  const ObjectPtr<GInetAddress> address(g_inet_address_new_from_string("127.0.0.1"));
  std::string error;
  const guint16 port = first.Listen(address.get(), 0, &error);
  EXPECT_EQ(error, "");
  EXPECT_EQ(second.Listen(address.get(), port, &error), 0);
  EXPECT_NE(error, "");
}

TEST(FrontDoor, EndsTheOldestConnectionOfAllWhereThereAreTooMany) {
  const ObjectPtr<SoupServer> server(
      SOUP_SERVER(g_object_new(SOUP_TYPE_SERVER, "server-header", "test", nullptr)));
  FrontDoor door(server.get(), nullptr, {3, 2});
  const ObjectPtr<GInetAddress> address(g_inet_address_new_from_string("127.0.0.1"));
  std::string error;
  const guint16 port = door.Listen(address.get(), 0, &error);
  ASSERT_NE(port, 0) << error;
  std::vector<ObjectPtr<GSocketConnection>> peers;
  const auto ended_after = [&](const char* from, guint64 evicted) {
    peers.push_back(Connect(port, from));
    EXPECT_TRUE(test::WaitUntil([&] { return door.evicted() >= evicted; }));
    for (int i = 0; i < 50; ++i) g_main_context_iteration(nullptr, FALSE);
    std::string ended;
    for (const auto& peer : peers) ended += HasEnded(peer) ? '1' : '0';
    return ended;
  };
  EXPECT_EQ(ended_after("127.0.0.2", 0), "0");
  EXPECT_EQ(ended_after("127.0.0.3", 0), "00");
  EXPECT_EQ(ended_after("127.0.0.3", 0), "000");
  EXPECT_EQ(ended_after("127.0.0.3", 1), "0100") << "the oldest of an address that has too many";
  EXPECT_EQ(ended_after("127.0.0.4", 2), "11000") << "the oldest of all";
  EXPECT_EQ(door.evicted(), 2U);
}

/// A fixture whose peers connect from several addresses. Each peer begins a TLS handshake, but does
/// not continue it.
class SomeAddresses : public test::FolderTest {
 protected:
  void SetUp() override {
    const std::string make = "cd " + folder_ +
                             " && openssl req -x509 -newkey ec -pkeyopt "
                             "ec_paramgen_curve:prime256v1 -nodes -keyout key.pem -out cert.pem "
                             "-subj /CN=x -days 2 2>/dev/null";
    if (std::system(make.c_str()) != 0) GTEST_SKIP() << "openssl is not installed";
    certificate_.reset(g_tls_certificate_new_from_files((folder_ + "/cert.pem").c_str(),
                                                        (folder_ + "/key.pem").c_str(), nullptr));
    listener_.reset(g_socket_listener_new());
    port_ = g_socket_listener_add_any_inet_port(listener_.get(), nullptr, nullptr);
  }

  void Begin(const char* from) {
    peers_.push_back(Connect(port_, from));
    ASSERT_TRUE(peers_.back());
    g_output_stream_write(g_io_stream_get_output_stream(G_IO_STREAM(peers_.back().get())), "\x16",
                          1, nullptr, nullptr);
    handshakes_.Begin(ObjectPtr<GSocketConnection>(
                          g_socket_listener_accept(listener_.get(), nullptr, nullptr, nullptr)),
                      certificate_.get());
  }
  std::size_t Ended() const {
    return static_cast<std::size_t>(std::count_if(peers_.begin(), peers_.end(), HasEnded));
  }
  /// Runs the main context, so that `handshakes_` notices new connections.
  static void Notice() {
    for (int i = 0; i < 50; ++i) g_main_context_iteration(nullptr, FALSE);
  }
  /// Tells `handshakes_` a time at which all handshakes that run now have timed out.
  void EndThoseThatRun() { handshakes_.Tick(g_get_monotonic_time() + 11 * kSecond_us); }

  ObjectPtr<GTlsCertificate> certificate_;
  ObjectPtr<GSocketListener> listener_;
  guint16 port_ = 0;
  Handshakes handshakes_{[](GSocketConnection*, GIOStream*) {}};
  std::vector<ObjectPtr<GSocketConnection>> peers_;
};

TEST_F(SomeAddresses, ShareTheTurnsOfHandshakesAndEachEndBeginsAnother) {
  for (int i = 0; i < 9; ++i) Begin("127.0.0.2");
  Begin("127.0.0.1");
  Notice();  // must come before running handshakes end
  EndThoseThatRun();
  EXPECT_TRUE(test::WaitUntil([this] { return HasEnded(peers_.back()); }))
      << "three of the other address run, and this one";
  EXPECT_LE(Ended(), 4U);
  EXPECT_TRUE(test::WaitUntil([this] {
    EndThoseThatRun();
    return Ended() == peers_.size();
  }));
}

TEST_F(SomeAddresses, TheOneWithTheFewestHandshakesIsNext) {
  for (const char* from : {"127.0.0.2", "127.0.0.3", "127.0.0.4"})
    for (int i = 0; i < 3; ++i) Begin(from);
  Notice();  // eight handshakes run, and one of the third address waits
  Begin("127.0.0.1");
  Notice();
  g_socket_shutdown(g_socket_connection_get_socket(peers_[0].get()), FALSE, TRUE, nullptr);
  ASSERT_TRUE(test::WaitUntil([this] { return HasEnded(peers_[0]); }));
  EndThoseThatRun();
  EXPECT_TRUE(test::WaitUntil([this] { return Ended() >= 9; }));
  EXPECT_TRUE(HasEnded(peers_.back())) << "it came last, and is alone of its address";
}

TEST(Server, SharesATopicOfOneSchemaExceptOneOfSlices) {
  using foxglove::Schema;
  std::string error;
  const auto server = Server::Start({}, &error);
  ASSERT_TRUE(server) << error;
  EXPECT_FALSE(server->Open(kStatisticsTopic, Schema::kPointCloud));
  std::set<std::uint32_t> ids;
  for (const Schema schema : {Schema::kPointCloud, Schema::kCompressedPointCloud,
                              Schema::kCompressedVideo, Schema::kPose, Schema::kSlice}) {
    const Schema other = schema == Schema::kPose ? Schema::kSlice : Schema::kPose;
    const SharedTopic topic = server->Open("/a", schema);
    ASSERT_TRUE(topic);
    EXPECT_TRUE(ids.insert(topic->channel().id).second) << "a channel of its own";
    EXPECT_EQ(topic->channel().schema, schema);
    EXPECT_FALSE(server->Open("/a", other));
    const bool is_shared = schema != Schema::kSlice;
    EXPECT_EQ(server->Open("/a", schema), is_shared ? topic : nullptr);
    if (is_shared) server->Close(topic);
    EXPECT_FALSE(server->Open("/a", other)) << "it is open still";
    server->Close(topic);
  }
}

class EmptyArchive final : public Archive {
 public:
  std::optional<Times> Look(std::string*) override { return {}; }
  void Seek(std::uint64_t) override {}
  void GoOn(std::uint64_t) override {}
  std::optional<Item> Next() override { return {}; }
  void Rest() override {}
  std::uint64_t damaged() const override { return 0; }
};

/// A viewer that is subscribed to a topic with a recording. `socket` is the viewer's end of the
/// connection.
struct RecordingViewer {
  explicit RecordingViewer(std::unique_ptr<Archive> archive,
                           std::function<void(std::string)> warn = nullptr)
      : service(DataRate(), std::move(warn)) {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    socket = ends[1];
    const ObjectPtr<GSocket> other(g_socket_new_from_fd(ends[0], nullptr));
    client = std::make_unique<Client>(
        ObjectPtr<GIOStream>(
            G_IO_STREAM(g_socket_connection_factory_create_connection(other.get()))),
        Client::Handlers{[](Client*, const auto&) {}, [](Client*) {}, [](Client*) {}});
    foxglove::Channel channel;
    channel.id = 7;
    topic = std::make_shared<Topic>(channel, std::make_shared<Recording>(std::move(archive)));
    service.Subscribe(client.get(), topic, 1);
  }
  ~RecordingViewer() {
    service.Forget(client.get());
    close(socket);
  }
  void Request(foxglove::Request::Kind kind) {
    foxglove::Request request;
    request.kind = kind;
    request.subscription = 1;
    request.number = 1;
    service.OnRequest(client.get(), request);
  }

  int socket = -1;
  std::unique_ptr<Client> client;
  std::shared_ptr<Topic> topic;
  SliceService service;
};

TEST(SliceService, WantsNothingRecodedForAViewerOfTheRecording) {
  RecordingViewer viewer(std::make_unique<EmptyArchive>());
  const auto deliver = [&](std::uint32_t scan) {
    auto slice = std::make_shared<SliceMessage>();
    slice->id.scan = scan;
    slice->blocks = {{scan, scan - 1}};  // refers to a block that the viewer lacks
    viewer.service.Deliver(7, std::move(slice));
    return viewer.topic->wants_recoded();
  };
  using Kind = foxglove::Request::Kind;
  EXPECT_TRUE(deliver(10));
  viewer.Request(Kind::kReplay);
  EXPECT_FALSE(deliver(20));
  viewer.Request(Kind::kLive);
  EXPECT_TRUE(deliver(30));
}

/// A recording on a disk that never answers. Look() returns only when the recording is cancelled.
class HangingArchive final : public Archive {
 public:
  struct State {
    std::atomic<bool> is_read{false};
    std::atomic<bool> gave_up{false};
  };
  explicit HangingArchive(State* state) : state_(state) {}
  std::optional<Times> Look(std::string*) override {
    state_->is_read = true;
    if (!test::Eventually([this] { return cancelled_.load(); })) state_->gave_up = true;
    return {};
  }
  void Seek(std::uint64_t) override {}
  void GoOn(std::uint64_t) override {}
  std::optional<Item> Next() override { return {}; }
  void Rest() override {}
  std::uint64_t damaged() const override { return 0; }

 private:
  State* const state_;
};

TEST(SliceService, EndsThoughARecordingIsBeingRead) {
  HangingArchive::State state;
  {
    const RecordingViewer viewer(std::make_unique<HangingArchive>(&state));
    ASSERT_TRUE(test::WaitUntil([&] { return state.is_read.load(); }));
  }
  EXPECT_FALSE(state.gave_up) << "it told the recording to stop";
}

/// A recording of one slice. It reports so many bytes for the slice that a piece ends after the
/// slice.
class ShortArchive final : public Archive {
 public:
  std::optional<Times> Look(std::string*) override { return Times{kTime_ns, kTime_ns}; }
  void Seek(std::uint64_t) override { next_ = 0; }
  void GoOn(std::uint64_t position) override { next_ = position; }
  std::optional<Item> Next() override {
    if (next_++ > 0) return {};
    auto slice = std::make_shared<SliceMessage>();
    slice->unix_ns = kTime_ns;
    slice->payload = {1};
    slice->ReadLinks(false);
    return Item{kTime_ns, 1, std::size_t{1} << 30, std::move(slice), false};
  }
  void Rest() override {}
  std::uint64_t damaged() const override { return 0; }

 private:
  static constexpr std::uint64_t kTime_ns = 2'000'000'000;
  std::uint64_t next_ = 0;
};

TEST(SliceService, TellsWhenAReplayEndsThoughItsLastPieceIsEmpty) {
  RecordingViewer viewer(std::make_unique<ShortArchive>());
  viewer.Request(foxglove::Request::Kind::kReplay);
  std::string said;
  EXPECT_TRUE(test::WaitUntil([&] {
    std::array<char, 4096> bytes{};
    const ssize_t size = recv(viewer.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size > 0) said.append(bytes.data(), static_cast<std::size_t>(size));
    return said.find("\"end\":2.0") != std::string::npos;
  })) << said;
}

/// A recording that cannot be read, for the reason `why`. If `why` is empty, the recording can be
/// read, but contains nothing.
class ClosedArchive final : public Archive {
 public:
  explicit ClosedArchive(std::atomic<const char*>* why) : why_(*why) {}
  std::optional<Times> Look(std::string* why) override {
    *why = why_;
    return why->empty() ? std::optional(Times{1, 2}) : std::nullopt;
  }
  void Seek(std::uint64_t) override {}
  void GoOn(std::uint64_t) override {}
  std::optional<Item> Next() override { return {}; }
  void Rest() override {}
  std::uint64_t damaged() const override { return 0; }

 private:
  const std::atomic<const char*>& why_;
};

TEST(SliceService, WarnsOnceForEachReasonThatARecordingCannotBeRead) {
  std::atomic<const char*> why{""};
  std::vector<std::string> warnings;
  RecordingViewer viewer(std::make_unique<ClosedArchive>(&why),
                         [&](const std::string& text) { warnings.push_back(text); });
  std::string said;
  unsigned answers = 1;  // the first answer is to the subscription
  const auto warnings_of_jumps = [&](const char* reason) {
    why = reason;
    warnings.clear();
    for (int i = 0; i < 3; ++i) {
      viewer.Request(foxglove::Request::Kind::kReplay);
      ++answers;
      EXPECT_TRUE(test::WaitUntil([&] {
        std::array<char, 4096> bytes{};
        const ssize_t size = recv(viewer.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (size > 0) said.append(bytes.data(), static_cast<std::size_t>(size));
        unsigned count = 0;
        for (std::size_t at = 0; (at = said.find(R"("op":"recording")", at)) != said.npos; ++at)
          ++count;
        return count == answers;
      }));
    }
    return warnings;
  };
  using Texts = std::vector<std::string>;
  const std::string begin = "Viewers cannot go back into the recording: ";
  EXPECT_EQ(warnings_of_jumps(""), Texts{});
  EXPECT_EQ(warnings_of_jumps("it is away"), Texts{begin + "it is away."});
  EXPECT_EQ(warnings_of_jumps("it is damaged"), Texts{begin + "it is damaged."});
  EXPECT_EQ(warnings_of_jumps(""), Texts{});
  EXPECT_EQ(warnings_of_jumps("it is damaged"), Texts{begin + "it is damaged."});
}

TEST(SliceService, WantsNothingRecodedOnceTheLastViewerLeft) {
  foxglove::Channel channel;
  channel.id = 7;
  const auto topic = std::make_shared<Topic>(channel);
  SliceService service{DataRate()};
  alignas(Client) std::byte nobody[sizeof(Client)];  // only its address is used, as a key
  auto* client = reinterpret_cast<Client*>(nobody);
  service.Subscribe(client, topic, 1);
  topic->set_wants_recoded(true);
  service.Unsubscribe(client, 7);
  EXPECT_FALSE(topic->wants_recoded());
}

}  // namespace
}  // namespace lidar::web
