// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of HTTPS and WSS, which the element itself serves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "ext/web/certificate.h"
#include "tests/elements/web/many_files.h"
#include "tests/elements/web/web_peer.h"
#include "tests/support/element_bus.h"
#include "tests/support/files.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

namespace fs = std::filesystem;

class Tls : public FolderTest {
 protected:
  void SetUp() override {
    if (!Make("robot")) GTEST_SKIP() << "openssl is not installed";
  }

  /// Makes a certificate for `name`. It replaces the previous certificate.
  bool Make(const std::string& name, const char* days = "2") {
    const std::string make =
        "cd " + folder_ +
        " && openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes "
        "-keyout new-key.pem -out new.pem -subj /CN=" +
        name + " -days " + days + " 2>/dev/null && mv new-key.pem key.pem && mv new.pem cert.pem";
    return std::system(make.c_str()) == 0;
  }
  /// Makes a certificate that was valid only in January 2020.
  bool MakeOld() {
    const std::string make =
        "cd " + folder_ +
        " && touch index && echo 01 > serial && printf "
        "'[ca]\\ndefault_ca=d\\n[d]\\ndatabase=index\\n"
        "serial=serial\\nnew_certs_dir=.\\npolicy=p\\ndefault_md=sha256\\n[p]\\n"
        "commonName=supplied\\n' > ca.cnf && openssl req -new -newkey ec -pkeyopt "
        "ec_paramgen_curve:prime256v1 -nodes -keyout key.pem -out request.pem -subj /CN=old "
        "2>/dev/null && openssl ca -batch -notext -selfsign -config ca.cnf -keyfile key.pem -in "
        "request.pem -out cert.pem -startdate 20200101000000Z -enddate 20200131120000Z 2>/dev/null";
    return std::system(make.c_str()) == 0;
  }
  std::string Properties() {
    return "tls-certificate=" + folder_ + "/cert.pem" + " tls-private-key=" + folder_ + "/key.pem";
  }
};

TEST_F(Tls, ServesThePageAndItsSockets) {
  Sink sink(Properties());
  sink.SetCloudCaps();
  EXPECT_EQ(HttpGet(sink.Url("https")).status, 200U);
  Peer peer(sink.Url("wss"), {"foxglove.sdk.v1"});
  ASSERT_TRUE(peer.connected());
  EXPECT_EQ(peer.certificate(), "CN=robot");
  peer.Subscribe("/points", 1);
  for (int i = 0; i < 10; ++i) {
    sink.PushCloud(1);
    EXPECT_EQ(peer.Next().subscription, 1U);
  }
}

TEST_F(Tls, CarriesCloudsOfMegabytes) {
  constexpr guint kColumns = 200'000;
  Sink sink(Properties());
  sink.SetCloudCaps(kColumns);
  Peer peer(sink.Url("wss"), {"foxglove.sdk.v1"});
  peer.Subscribe("/points", 1);
  for (int i = 0; i < 3; ++i) {
    sink.PushCloud(1, kColumns);
    EXPECT_GT(peer.Next().payload.size(), kColumns * 16U);
  }
}

TEST_F(Tls, TakesARenewedCertificateForNewConnections) {
  Sink sink(Properties());
  Peer old(sink.Url("wss"), {"foxglove.sdk.v1"});
  EXPECT_EQ(old.certificate(), "CN=robot");
  ASSERT_TRUE(Make("renewed"));
  EXPECT_TRUE(WaitUntil([&] {
    Peer peer(sink.Url("wss"), {"foxglove.sdk.v1"});
    return peer.connected() && peer.certificate() == "CN=renewed";
  }));
  EXPECT_FALSE(old.closed());
}

TEST_F(Tls, KeepsACertificateWhoseRenewalIsDamaged) {
  Sink sink(Properties());
  const ElementBus bus(sink.element());
  ASSERT_EQ(std::system(("echo damaged > " + folder_ + "/cert.pem").c_str()), 0);
  EXPECT_TRUE(WaitUntil([&] { return bus.Pop(GST_MESSAGE_WARNING) != nullptr; }));
  EXPECT_EQ(HttpGet(sink.Url("https")).status, 200U);
}

TEST_F(Tls, NamesTheDateOnWhichItsCertificateRanOut) {
  ASSERT_TRUE(MakeOld());
  const gst::ElementPtr element(
      gst_parse_launch(("foxglovesink port=0 " + Properties()).c_str(), nullptr));
  const ElementBus bus(element.get());
  EXPECT_EQ(gst_element_set_state(element.get(), GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
  const std::string text = bus.Text(GST_MESSAGE_WARNING);
  EXPECT_NE(text.find("expired on 2020-01-31 12:00 UTC"), std::string::npos) << text;
  gst_element_set_state(element.get(), GST_STATE_NULL);
}

TEST_F(Tls, SaysOnceThatACertificateRunsOutMeanwhile) {
  web::Certificate certificate(folder_ + "/cert.pem", folder_ + "/key.pem");
  std::string why;
  ASSERT_TRUE(certificate.Load(&why)) << why;
  const gint64 now_s = g_get_real_time() / G_USEC_PER_SEC;
  EXPECT_EQ(certificate.NoticeOfEnd(now_s), "");
  EXPECT_NE(certificate.NoticeOfEnd(now_s + 3 * 86'400), "");
  EXPECT_EQ(certificate.NoticeOfEnd(now_s + 4 * 86'400), "");
  ASSERT_TRUE(Make("renewed"));
  ASSERT_TRUE(certificate.Renew(&why)) << why;
  EXPECT_EQ(certificate.NoticeOfEnd(now_s), "");
  EXPECT_NE(certificate.NoticeOfEnd(now_s + 3 * 86'400), "");
}

TEST_F(Tls, KeepsItsCertificateAndSaysOnceWhyARenewalIsNone) {
  web::Certificate certificate(folder_ + "/cert.pem", folder_ + "/key.pem");
  std::string why;
  ASSERT_TRUE(certificate.Load(&why)) << why;
  for (const std::string file : {"/cert.pem", "/key.pem"}) {
    GTlsCertificate* const before = certificate.get();
    ASSERT_EQ(std::system(("echo damaged > " + folder_ + file).c_str()), 0);
    why.clear();
    EXPECT_FALSE(certificate.Renew(&why)) << file;
    EXPECT_NE(why, "");
    EXPECT_TRUE(certificate.Renew(&why)) << "nothing has changed since";
    EXPECT_EQ(certificate.get(), before);
    ASSERT_TRUE(Make("renewed"));
    EXPECT_TRUE(certificate.Renew(&why)) << why;
    EXPECT_NE(certificate.get(), before);
  }
}

/// Connects from the local address `address`, for example 127.0.0.7.
GSocketConnection* ConnectFrom(const std::string& address, guint port) {
  GSocketClient* client = g_socket_client_new();
  GSocketAddress* local = g_inet_socket_address_new_from_string(address.c_str(), 0);
  g_socket_client_set_local_address(client, local);
  GSocketConnection* connection = g_socket_client_connect_to_host(
      client, "127.0.0.1", static_cast<guint16>(port), nullptr, nullptr);
  g_object_unref(local);
  g_object_unref(client);
  return connection;
}

TEST_F(Tls, LetsAThousandHalfHandshakesHoldUpTheirOwn) {
  const ManyFiles files(4096);
  const int count = files.granted() >= 4096 ? 1000 : 200;
  Sink sink(Properties());
  std::vector<GSocketConnection*> silent;
  for (int i = 0; i < count; ++i) {
    auto* connection =
        ConnectFrom("127.0.0." + std::to_string(2 + i % 20), static_cast<guint>(sink.Stat("port")));
    ASSERT_NE(connection, nullptr);
    g_output_stream_write(g_io_stream_get_output_stream(G_IO_STREAM(connection)), "\x16", 1,
                          nullptr, nullptr);
    silent.push_back(connection);
  }
  // While other connections wait, a handshake must finish within a second. A busy machine may need
  // longer, so the request is repeated.
  EXPECT_TRUE(Eventually([&] { return HttpGet(sink.Url("https")).status == 200U; }));
  // The server updates this counter once per second.
  const auto evicted = static_cast<guint64>(std::max(0, count - 20 * 32) / 2);
  EXPECT_TRUE(Eventually([&] { return sink.Stat("connections-evicted") >= evicted; }));
  for (GSocketConnection* connection : silent) g_object_unref(connection);
}

TEST_F(Tls, LetsSilentConnectionsHoldUpNobody) {
  Sink sink(Properties());
  std::vector<GSocketConnection*> silent;
  GSocketClient* client = g_socket_client_new();
  for (int i = 0; i < 20; ++i) {
    silent.push_back(g_socket_client_connect_to_host(
        client, "127.0.0.1", static_cast<guint16>(sink.Stat("port")), nullptr, nullptr));
    // Sends the first byte of a handshake, and nothing more.
    if (i < 2)
      g_output_stream_write(g_io_stream_get_output_stream(G_IO_STREAM(silent.back())), "\x16", 1,
                            nullptr, nullptr);
  }
  g_object_unref(client);
  EXPECT_EQ(HttpGet(sink.Url("https")).status, 200U);
  EXPECT_NE(HttpGet(sink.Url("http")).status, 200U);
  for (GSocketConnection* connection : silent) g_object_unref(connection);
}

TEST_F(Tls, SaysWhatIsWrongWithItsFiles) {
  const std::string missing =
      "tls-certificate=" + folder_ + "/none.pem" + " tls-private-key=" + folder_ + "/key.pem";
  const gst::ElementPtr element(
      gst_parse_launch(("foxglovesink port=0 " + missing).c_str(), nullptr));
  const ElementBus bus(element.get());
  EXPECT_EQ(gst_element_set_state(element.get(), GST_STATE_READY), GST_STATE_CHANGE_FAILURE);
  const gst::MessagePtr message = bus.Pop(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  const std::string details = MessageDetails(message.get());
  EXPECT_NE(details.find("none.pem"), std::string::npos) << details;
  gst_element_set_state(element.get(), GST_STATE_NULL);
}

}  // namespace
}  // namespace lidar::test
