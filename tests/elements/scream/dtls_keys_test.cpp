// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of DTLS handshakes between two ends. The test carries their datagrams.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "gst/scream/srtp/dtls_keys.h"
#include "tests/elements/scream/frozen_clock.h"
#include "tests/elements/scream/rtp_support.h"
#include "tests/support/patience.h"
#include "tests/support/test_certificates.h"

namespace lidar::gst {
namespace {

using test::FromBytes;
using test::frozen_at;
using test::ToBytes;
using Bytes = std::vector<std::uint8_t>;

// Position of the record's length, which has two bytes.
constexpr std::size_t kLengthOfRecord = 11;
constexpr std::size_t kRandomOfHello = 13 + 12 + 2;  // position after the headers and the version

/// A datagram between a client and the server. `port` is the client's port: the server receives the
/// datagram from this port, or sends it to this port.
struct Carried {
  guint16 port;
  Bytes bytes;
};

/// A queue of datagrams that the test has not carried yet.
class Wire {
 public:
  void Put(Carried datagram) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(datagram));
  }
  std::vector<Carried> Take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(waiting_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<Carried> waiting_;
};

class DtlsEnds : public ::testing::Test {
 protected:
  ~DtlsEnds() override { frozen_at = 0; }

  std::unique_ptr<DtlsKeys> Make(bool is_client, Wire* out, std::atomic<unsigned>* keys,
                                 const char* edge = "edge") {
    static const test::TestCertificates papers({"robot", "edge", "stranger"});
    Certificates certificates;
    std::string error;
    EXPECT_TRUE(ReadCertificates(papers.WithKey(is_client ? "robot" : edge),
                                 papers.Public(is_client ? "edge" : "robot"), &certificates,
                                 &error))
        << error;
    DtlsKeys::Calls calls;
    calls.send = [out, is_client](GstBuffer* datagram, const DtlsKeys::Addresses& to) {
      if (is_client) out->Put({0, ToBytes(datagram)});
      for (const SocketAddressPtr& address : to)
        out->Put({g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(address.get())),
                  ToBytes(datagram)});
    };
    calls.on_key = [this, is_client, keys](const SrtpKey& key) {
      (is_client ? client_key_ : server_key_) = key;
      if (!is_client) g_usleep(server_key_takes_);
      ++*keys;
    };
    calls.traffic = [this, is_client] {
      if (is_client) ++looks_for_answer_;
      return SrtpTraffic{sent_, passed_};
    };
    calls.warn = [this](const char* what, const char*) {
      warning_ = what;
      ++warnings_;
    };
    return std::make_unique<DtlsKeys>(certificates, is_client, calls);
  }
  void StartClient() {
    client_ = Make(true, &up_, &client_keys_);
    client_->Start();
  }
  void StartServer() {
    server_ = Make(false, &down_, &server_keys_);
    server_->Start();
  }

  void Give(DtlsKeys& end, const Carried& datagram) {
    const BufferPtr buffer(FromBytes(datagram.bytes));
    test::SetSource(buffer.get(), "192.0.2.1", datagram.port);
    end.Take(buffer.get());
  }
  /// Waits until the client has looked for an answer with the present time and has acted on it. The
  /// client may have read the clock for the next look already, so the one after it counts. It is
  /// over when a third look begins.
  void AwaitLooks() {
    const unsigned before = looks_for_answer_;
    EXPECT_TRUE(test::Eventually([&] { return looks_for_answer_ >= before + 3; }));
  }
  static bool IsOfHello(const Bytes& datagram) { return datagram[0] == 22 && datagram[13] == 1; }
  /// Returns the datagrams of a client's first hello.
  std::vector<Bytes> HelloOfClient() {
    std::vector<Bytes> hello;
    StartClient();
    EXPECT_TRUE(test::Eventually([&] {
      for (Carried& d : up_.Take()) hello.push_back(std::move(d.bytes));
      return hello.size() >= 2;
    }));
    client_.reset();
    hello.resize(2);  // a client that waits for a second sends its hello again
    return hello;
  }
  /// Returns the ports to which the server sends answers. Waits until there are `expected` ports,
  /// then 0.2 s more.
  std::set<guint16> Answered(std::size_t expected) {
    std::set<guint16> ports;
    const auto take = [&] {
      for (const Carried& d : down_.Take()) ports.insert(d.port);
      return ports.size() >= expected;
    };
    EXPECT_TRUE(test::Eventually(take));
    g_usleep(200'000);
    take();
    return ports;
  }

  Wire up_, down_;
  SrtpKey server_key_, client_key_;
  gulong server_key_takes_ = 0;  // time until the server uses its key [us]
  std::atomic<unsigned> server_keys_{0}, client_keys_{0};
  std::atomic<unsigned> warnings_{0};
  std::atomic<const char*> warning_{""};  // text of the last warning
  std::atomic<std::uint64_t> sent_{0}, passed_{0};
  std::atomic<unsigned> looks_for_answer_{0};  // of the client
  std::unique_ptr<DtlsKeys> server_, client_;
};

// In the next four tests the clock stands still during a handshake, so the client cannot give the
// handshake up and begin another one.

TEST_F(DtlsEnds, AgreeWhereEachOfTwoLinksLosesEveryThirdDatagram) {
  frozen_at = g_get_monotonic_time();
  StartServer();
  StartClient();
  unsigned sent = 0, received = 0;
  EXPECT_TRUE(test::Eventually([&] {
    for (const Carried& d : up_.Take())
      for (unsigned link = 0; link < 2; ++link)
        if ((sent++ / 2 + link) % 3 != 0)
          Give(*server_, {static_cast<guint16>(5'001 + link), d.bytes});
    for (const Carried& d : down_.Take())
      if (++received % 3 != 0) Give(*client_, d);
    return client_keys_ == 1 && server_keys_ == 1;
  }));
  EXPECT_EQ(client_key_, server_key_);
  EXPECT_EQ(client_key_.size(), 30U);
}

TEST_F(DtlsEnds, TheServerUsesTheKeyBeforeTheClientHasIt) {
  server_key_takes_ = 200'000;
  frozen_at = g_get_monotonic_time();
  StartServer();
  StartClient();
  EXPECT_TRUE(test::Eventually([&] {
    for (const Carried& d : up_.Take()) Give(*server_, {5'001, d.bytes});
    for (const Carried& d : down_.Take()) Give(*client_, d);
    return client_keys_ == 1;
  }));
  EXPECT_EQ(server_keys_, 1U) << "the client's first packets would be refused";
}

TEST_F(DtlsEnds, AgreeOverALinkThatLostTheHelloWhereTheOtherDies) {
  frozen_at = g_get_monotonic_time();
  StartServer();
  StartClient();
  bool died = false;
  EXPECT_TRUE(test::Eventually([&] {
    for (const Carried& d : up_.Take()) {
      died = died || !IsOfHello(d.bytes);
      Give(*server_, {static_cast<guint16>(died ? 5'002 : 5'001), d.bytes});
    }
    for (const Carried& d : down_.Take())
      if (!died || d.port == 5'002) Give(*client_, d);
    return client_keys_ == 1 && server_keys_ == 1;
  }));
}

TEST_F(DtlsEnds, AgreeAnewWhereWhatIsSentStaysWithoutAnAnswer) {
  frozen_at = g_get_monotonic_time();
  StartServer();
  StartClient();
  const auto agree = [this](unsigned keys) {
    return test::Eventually([&] {
      for (Carried& d : up_.Take()) Give(*server_, {5'001, d.bytes});
      for (const Carried& d : down_.Take()) Give(*client_, d);
      return client_keys_ == keys && server_keys_ == keys;
    });
  };
  ASSERT_TRUE(agree(1));
  const SrtpKey first = client_key_;
  frozen_at += 60 * G_USEC_PER_SEC;
  AwaitLooks();
  EXPECT_TRUE(up_.Take().empty()) << "nothing was sent, so no answer is missing";
  sent_ = 10;
  AwaitLooks();
  passed_ = 10;
  frozen_at += 60 * G_USEC_PER_SEC;
  AwaitLooks();
  EXPECT_TRUE(up_.Take().empty()) << "it was answered";
  sent_ = 20;
  AwaitLooks();
  frozen_at += 4 * G_USEC_PER_SEC;
  AwaitLooks();
  EXPECT_TRUE(up_.Take().empty()) << "an answer may still come";
  frozen_at += 2 * G_USEC_PER_SEC;
  EXPECT_TRUE(agree(2));
  EXPECT_NE(client_key_, first);
}

TEST_F(DtlsEnds, AServerAnswersToFourAddressesOfOneHello) {
  const auto hello = HelloOfClient();
  frozen_at = g_get_monotonic_time();
  StartServer();
  for (const Bytes& part : hello)
    for (guint16 port = 5'001; port <= 5'006; ++port) Give(*server_, {port, part});
  EXPECT_EQ(Answered(4), (std::set<guint16>{5'001, 5'002, 5'003, 5'004}));
}

TEST_F(DtlsEnds, WhatFollowsAHelloInItsDatagramMakesItNoOtherHello) {
  auto hello = HelloOfClient();
  frozen_at = g_get_monotonic_time();
  StartServer();
  for (guint16 port = 5'001; port <= 5'006; ++port) {
    Bytes first = hello.front();
    first.push_back(static_cast<std::uint8_t>(port));  // first byte of a second record
    Give(*server_, {port, first});
  }
  for (std::size_t n = 1; n < hello.size(); ++n) Give(*server_, {5'001, hello[n]});
  EXPECT_EQ(Answered(4), (std::set<guint16>{5'001, 5'002, 5'003, 5'004}));
}

TEST_F(DtlsEnds, AServerBeginsFiveHandshakesASecond) {
  auto hello = HelloOfClient();
  frozen_at = g_get_monotonic_time();
  StartServer();
  std::vector<Bytes> answered_hello;  // the last one
  // Sends 20 hellos, and returns the ports that get answers. Each flood has its own ports, because
  // the server repeats earlier answers until they are acknowledged.
  const auto flood = [&](guint16 first, std::size_t expected) {
    std::set<guint16> answered;
    const auto take = [&] {
      for (const Carried& d : down_.Take())
        if (d.port >= first) answered.insert(d.port);
      return answered.size();
    };
    for (guint16 port = first; port < first + 20; ++port) {
      ++hello.front()[kRandomOfHello];
      for (const Bytes& part : hello) Give(*server_, {port, part});
      // The server keeps only four open handshakes, and a new one replaces the oldest. Therefore
      // each hello is sent after the server has answered the hello before it.
      const std::size_t due = std::min<std::size_t>(expected, port - first + 1U);
      EXPECT_TRUE(test::Eventually([&] { return take() >= due; }));
      if (port < first + expected) answered_hello = hello;
    }
    // The server also answers the hello of an open handshake from another address. This answer
    // shows that the server has read the whole flood.
    const auto last = static_cast<guint16>(first + 20);
    for (const Bytes& part : answered_hello) Give(*server_, {last, part});
    EXPECT_TRUE(test::Eventually([&] { return take() > 0 && answered.count(last) > 0; }));
    answered.erase(last);
    return answered;
  };
  EXPECT_EQ(flood(5'001, 5), (std::set<guint16>{5'001, 5'002, 5'003, 5'004, 5'005}));
  EXPECT_EQ(flood(5'101, 0), std::set<guint16>{});
  frozen_at += G_USEC_PER_SEC / 5;
  EXPECT_EQ(flood(5'201, 1), std::set<guint16>{5'201});
}

/// The server also answers an address that sends the same hello as an open handshake. This shows
/// which handshakes are still open.
TEST_F(DtlsEnds, AServerForgetsTheOldestOfFiveHandshakes) {
  const auto hello = HelloOfClient();
  frozen_at = g_get_monotonic_time();
  StartServer();
  std::set<guint16> answered;
  const auto answers = [&](guint16 first, std::size_t count) {
    return test::Eventually([&] {
      for (const Carried& d : down_.Take())
        if (d.port >= first) answered.insert(d.port);
      return answered.size() >= count;
    });
  };
  const auto give = [&](guint16 port, guint16 number) {
    Bytes first = hello.front();
    first[kRandomOfHello] = static_cast<std::uint8_t>(number);
    Give(*server_, {port, first});
    for (std::size_t n = 1; n < hello.size(); ++n) Give(*server_, {port, hello[n]});
  };
  for (guint16 i = 1; i <= 5; ++i) {
    give(static_cast<guint16>(5'000 + i), i);
    ASSERT_TRUE(answers(5'001, i));
  }
  answered.clear();
  for (guint16 i = 1; i <= 5; ++i) give(static_cast<guint16>(5'010 + i), i);
  EXPECT_TRUE(answers(5'011, 4));
  EXPECT_EQ(answered, (std::set<guint16>{5'012, 5'013, 5'014, 5'015}));
}

TEST_F(DtlsEnds, AClientThatWasStoppedWarnsOfNoSilence) {
  frozen_at = g_get_monotonic_time();
  StartClient();
  EXPECT_TRUE(test::Eventually([&] { return !up_.Take().empty(); }));
  client_->Stop();
  frozen_at += 60 * G_USEC_PER_SEC;
  client_->Start();
  EXPECT_TRUE(test::Eventually([&] { return !up_.Take().empty(); })) << "another handshake";
  EXPECT_EQ(warnings_, 0U);
}

TEST_F(DtlsEnds, AKeyedClientTakesThePauseBetweenStopAndStartForNoSilence) {
  StartServer();
  StartClient();
  EXPECT_TRUE(test::Eventually([&] {
    for (Carried& d : up_.Take()) Give(*server_, {5'001, d.bytes});
    for (const Carried& d : down_.Take()) Give(*client_, d);
    return client_keys_ == 1;
  }));
  sent_ = 10;
  frozen_at = g_get_monotonic_time();
  client_->Stop();
  up_.Take();
  frozen_at += 60 * G_USEC_PER_SEC;
  server_.reset();  // the server would also read the clock
  const unsigned before = test::looks;
  client_->Start();
  // The client reads the clock twice in each check for silence. After four reads it has made two
  // checks.
  EXPECT_TRUE(test::Eventually([&] { return test::looks >= before + 4; }));
  EXPECT_TRUE(up_.Take().empty());
  frozen_at += 6 * G_USEC_PER_SEC;
  EXPECT_TRUE(test::Eventually([&] { return !up_.Take().empty(); }));
}

TEST_F(DtlsEnds, AClientTriesAStrangerOnceASecond) {
  frozen_at = g_get_monotonic_time();
  server_ = Make(false, &down_, &server_keys_, "stranger");
  server_->Start();
  StartClient();
  const auto carry = [this] {
    for (const Carried& d : up_.Take()) Give(*server_, {5'001, d.bytes});
    for (const Carried& d : down_.Take()) Give(*client_, d);
  };
  for (std::uint64_t tries = 1; tries <= 2; ++tries) {
    EXPECT_TRUE(test::Eventually([&] {
      carry();
      return client_->counts().refused == tries && warnings_ > 0;
    }));
    up_.Take();
    AwaitLooks();
    EXPECT_TRUE(up_.Take().empty());
    EXPECT_EQ(warnings_, 1U);
    EXPECT_NE(std::string(warning_).find("its certificate is not the one to trust"),
              std::string::npos)
        << warning_;
    frozen_at += G_USEC_PER_SEC;
  }
}

TEST_F(DtlsEnds, ASilenceIsToldOfOnceAndBehindAKeyAgain) {
  frozen_at = g_get_monotonic_time();
  StartClient();
  const auto tries = [this] { return test::Eventually([&] { return !up_.Take().empty(); }); };
  for (unsigned silence = 1; silence <= 2; ++silence) {
    for (int handshake = 0; handshake < 3; ++handshake) {
      ASSERT_TRUE(tries());
      frozen_at += 6 * G_USEC_PER_SEC;  // the client gives the handshake up
    }
    std::vector<Carried> hello;
    ASSERT_TRUE(test::Eventually([&] { return !(hello = up_.Take()).empty(); }));
    EXPECT_EQ(warnings_, silence);
    EXPECT_STREQ(warning_,
                 "The other end does not answer the DTLS handshake, which is tried again.");
    StartServer();
    for (const Carried& d : hello) Give(*server_, {5'001, d.bytes});
    ASSERT_TRUE(test::Eventually([&] {
      for (const Carried& d : up_.Take()) Give(*server_, {5'001, d.bytes});
      for (const Carried& d : down_.Take()) Give(*client_, d);
      return client_keys_ == silence && server_keys_ == silence;
    }));
    server_.reset();
    up_.Take();
    ++sent_;  // the server does not answer this packet
    frozen_at += 6 * G_USEC_PER_SEC;
  }
}

TEST_F(DtlsEnds, AServerLooksAtNoClockBeforeSomethingComes) {
  StartServer();
  EXPECT_TRUE(test::Eventually([] {
    const unsigned before = test::looks;
    g_usleep(500'000);
    return test::looks == before;
  }));
}

TEST_F(DtlsEnds, DatagramsThatComeTooFastAreCounted) {
  server_ = Make(false, &down_, &server_keys_);
  for (std::size_t n = 0; n < DtlsKeys::kMaxWaiting + 7; ++n) Give(*server_, {5'001, Bytes(30)});
  EXPECT_EQ(server_->counts().dropped, 7U);
}

TEST_F(DtlsEnds, AServerAnswersToNothingButAHello) {
  const auto hello = HelloOfClient();
  StartServer();
  for (std::size_t size = 0; size < 30; ++size)
    Give(*server_, {5'001, Bytes(hello.front().data(), hello.front().data() + size)});
  for (std::size_t n = 1; n < hello.size(); ++n) Give(*server_, {5'001, hello[n]});
  for (std::uint8_t type = 20; type < 64; ++type) {
    Bytes other = hello.front();
    other[0] = type;
    if (type != 22) Give(*server_, {5'001, other});
  }
  EXPECT_EQ(Answered(0), std::set<guint16>{});
}

TEST_F(DtlsEnds, ARecordWithoutAMessageBeginsNoHandshake) {
  const auto hello = HelloOfClient();
  frozen_at = g_get_monotonic_time();
  StartServer();
  Bytes empty = hello.front();
  empty[kLengthOfRecord] = empty[kLengthOfRecord + 1] = 0;
  for (int i = 0; i < 20; ++i) {
    ++empty[kRandomOfHello];
    Give(*server_, {5'001, empty});
  }
  for (const Bytes& part : hello) Give(*server_, {5'001, part});
  EXPECT_EQ(Answered(1), std::set<guint16>{5'001});
}

}  // namespace
}  // namespace lidar::gst
