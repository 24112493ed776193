// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of who can reach foxglovesink: its page, its token and its port.
#include <gtest/gtest.h>

#include <utility>

#include "ext/web/admission.h"
#include "tests/elements/coders/stopped_clock.h"
#include "tests/elements/web/web_peer.h"
#include "tests/support/element_bus.h"
#include "tests/support/ipv6.h"

namespace lidar::test {
namespace {

TEST(FoxgloveSink, ServesItsPageAndNothingElse) {
  Sink sink("token=secret");
  const HttpAnswer page = HttpGet(sink.Url("http"));
  EXPECT_EQ(page.status, 200U);
  EXPECT_EQ(page.type, "text/html; charset=utf-8");
  EXPECT_NE(page.policy.find("default-src 'self'"), std::string::npos);
  EXPECT_NE(page.body.find("<title>"), std::string::npos);
  EXPECT_EQ(HttpGet(sink.Url("http", "/etc/passwd")).status, 404U);
  EXPECT_EQ(HttpGet(sink.Url("http", "/..%2f..%2fetc/passwd")).status, 400U);
  const HttpAnswer head = HttpGet(sink.Url("http"), "HEAD");
  EXPECT_EQ(head.status, 200U);
  EXPECT_EQ(head.type, page.type);
  EXPECT_EQ(head.body, "");
  EXPECT_EQ(sink.Stat("malformed"), 0U);
  const HttpAnswer posted = HttpGet(sink.Url("http"), "POST");
  EXPECT_EQ(posted.status, 405U);
  EXPECT_EQ(posted.allow, "GET, HEAD");
  EXPECT_EQ(sink.Stat("malformed"), 1U);
}

TEST(FoxgloveSink, NamesTheTypeOfEachFileOfItsPage) {
  Sink sink;
  for (const auto& [file, type] : {std::pair("/page.js", "text/javascript; charset=utf-8"),
                                   std::pair("/page.css", "text/css; charset=utf-8"),
                                   std::pair("/lidar_decoder.wasm", "application/wasm"),
                                   std::pair("/licenses.txt", "text/plain; charset=utf-8")})
    EXPECT_EQ(HttpGet(sink.Url("http", file)).type, type) << file;
}

TEST(FoxgloveSink, AdmitsOnlyWhoKnowsTheToken) {
  Sink sink("token=secret");
  for (const char* path : {"/", "/?token=wrong!", "/?token=", "/?token=secre", "/?token=secrets"}) {
    Peer peer(sink.Url("ws", path), {"foxglove.sdk.v1"});
    EXPECT_FALSE(peer.connected()) << path;
    EXPECT_EQ(peer.status(), 401U) << path;
  }
  const HttpAnswer refused = HttpGet(sink.Url("http", "/session"));
  EXPECT_EQ(refused.status, 401U);
  EXPECT_EQ(refused.challenge, "Bearer");
  EXPECT_EQ(refused.body, "A token is needed.\n");
  EXPECT_EQ(HttpGet(sink.Url("http", "/session?token=secre")).body,
            "The token is wrong, or has expired.\n");
  EXPECT_EQ(HttpGet(sink.Url("http", "/session?token=secret")).status, 200U);
  EXPECT_TRUE(Peer(sink.Url("ws", "/?token=secret"), {"foxglove.sdk.v1"}).connected());
  EXPECT_EQ(sink.Stat("clients-refused"), 5U) << "a page that asks why is no other client";
  const auto status = [&](const char* path, const char* authorization) {
    return HttpGet(sink.Url("http", path), "GET", authorization).status;
  };
  EXPECT_EQ(status("/session", "Bearer secret"), 200U);
  EXPECT_EQ(status("/session", "bearer secret"), 200U);
  EXPECT_EQ(status("/session", "Bearer secrets"), 401U);
  EXPECT_EQ(status("/session", "Basic secret"), 401U);
  EXPECT_EQ(status("/session?token=wrong", "Bearer secret"), 401U) << "the query goes first";
}

TEST(FoxgloveSink, AdmitsNoMoreThanMaxClientsAtATime) {
  Sink sink("max-clients=1");
  {
    const Peer first(&sink);
    ASSERT_TRUE(first.connected());
    const Peer second(&sink);
    EXPECT_FALSE(second.connected());
    EXPECT_EQ(second.status(), 503U);
  }
  ASSERT_TRUE(WaitUntil([&] { return sink.Stat("clients") == 0; }));
  EXPECT_TRUE(Peer(&sink).connected());
}

/// Starts foxglovesink with these properties, and returns the text of its error.
std::string ErrorOf(const std::string& properties) {
  const gst::ElementPtr element(gst_parse_launch(("foxglovesink " + properties).c_str(), nullptr));
  const ElementBus bus(element.get());
  const bool failed =
      gst_element_set_state(element.get(), GST_STATE_READY) == GST_STATE_CHANGE_FAILURE;
  const std::string text = bus.Text(GST_MESSAGE_ERROR);
  EXPECT_EQ(failed, !text.empty());
  gst_element_set_state(element.get(), GST_STATE_NULL);
  return text;
}

TEST(FoxgloveSink, NeedsATokenWhereOthersCanReachIt) {
  EXPECT_NE(ErrorOf("port=0 bind-address=0.0.0.0").find("set a token"), std::string::npos);
  EXPECT_EQ(ErrorOf("port=0 bind-address=0.0.0.0 token=t"), "");
  if (HasIpv6()) {
    EXPECT_EQ(ErrorOf("port=0 bind-address=::1"), "");
  }
  EXPECT_NE(ErrorOf("port=0 bind-address=robot").find("is not an IP address"), std::string::npos);
}

TEST(FoxgloveSink, RefusesSecretsThatCannotProtect) {
  EXPECT_NE(ErrorOf("port=0 token-secret=short").find("32 bytes"), std::string::npos);
  EXPECT_NE(ErrorOf("port=0 tls-certificate=a.pem").find("must be set together"),
            std::string::npos);
  EXPECT_EQ(ErrorOf("port=0 bind-address=0.0.0.0 token-secret=" + std::string(32, 's')), "");
}

struct Asks {
  const char* origin;
  bool enters;
};
class Origins : public ::testing::TestWithParam<Asks> {};
TEST_P(Origins, OfOtherSitesNeedATokenOrToBeAllowed) {
  Sink open("allowed-origins=\"https://a.example, https://app.foxglove.dev, \"");
  Peer peer(open.Url("ws"), {"foxglove.sdk.v1"}, GetParam().origin);
  EXPECT_EQ(peer.connected(), GetParam().enters);
  if (!GetParam().enters) {
    EXPECT_EQ(peer.status(), 403U);
  }
  Sink guarded("token=secret");
  EXPECT_TRUE(Peer(guarded.Url("ws", "/?token=secret"), {"foxglove.sdk.v1"}, GetParam().origin)
                  .connected());
}
INSTANTIATE_TEST_SUITE_P(All, Origins,
                         ::testing::Values(Asks{nullptr, true}, Asks{"http://127.0.0.1:1", true},
                                           Asks{"https://app.foxglove.dev", true},
                                           Asks{"https://app.foxglove.dev.evil.example", false},
                                           Asks{"http://evil.example", false},
                                           Asks{"http://127.0.0.1.evil.example:8765", false},
                                           Asks{"null", false}));

TEST(FoxgloveSink, StopsListeningToAnAddressThatGuessesTokens) {
  Sink sink("token=secret");
  const StoppedClock clock;  // a wrong token is forgiven after 6 s
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(HttpGet(sink.Url("http", "/session?token=no")).status, 401U);
  const HttpAnswer refused = HttpGet(sink.Url("http", "/session?token=no"));
  EXPECT_EQ(refused.status, 429U);
  EXPECT_EQ(refused.body, "Too many wrong tokens came from this address: wait a minute.\n");
  EXPECT_EQ(HttpGet(sink.Url("http", "/session?token=secret")).status, 429U);
  EXPECT_EQ(HttpGet(sink.Url("http")).status, 200U);
}

TEST(FoxgloveSink, AsksForATokenHoweverOftenNoneComes) {
  Sink sink("token=secret");
  for (int i = 0; i < 20; ++i) {
    const HttpAnswer refused =
        HttpGet(sink.Url("http", i % 2 == 0 ? "/session" : "/session?token="));
    EXPECT_EQ(refused.status, 401U);
    EXPECT_EQ(refused.body, "A token is needed.\n");
  }
  EXPECT_EQ(HttpGet(sink.Url("http", "/session?token=secret")).status, 200U);
}

TEST(WrongTokens, AreForgivenOneByOneAndRememberedOfTheNewestAddresses) {
  web::WrongTokens wrong;
  gint64 now_us = 0;
  for (std::size_t i = 0; i < web::WrongTokens::kMostAddresses; ++i)
    wrong.Note(std::to_string(i), ++now_us);
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(wrong.MayTry("a", now_us)) << i;
    wrong.Note("a", ++now_us);
  }
  EXPECT_FALSE(wrong.MayTry("a", now_us)) << "it is the newest";
  EXPECT_FALSE(wrong.MayTry("a", now_us + web::WrongTokens::kForgive_us - 100));
  now_us += web::WrongTokens::kForgive_us;
  EXPECT_TRUE(wrong.MayTry("a", now_us));
  wrong.Note("a", now_us);
  EXPECT_FALSE(wrong.MayTry("a", now_us));
  now_us += 100 * web::WrongTokens::kForgive_us;
  for (int i = 0; i < 10; ++i) wrong.Note("a", now_us);
  EXPECT_FALSE(wrong.MayTry("a", now_us)) << "who waited long has no more tries";
}

TEST(WrongTokens, OfTheOldestAddressAreForgottenWhereThereAreTooMany) {
  web::WrongTokens wrong;
  gint64 now_us = 0;
  for (const char* address : {"old", "newer"})
    for (int i = 0; i < 11; ++i) wrong.Note(address, ++now_us);
  for (std::size_t i = 0; i < web::WrongTokens::kMostAddresses - 1; ++i)
    wrong.Note(std::to_string(i), ++now_us);
  EXPECT_TRUE(wrong.MayTry("old", now_us));
  EXPECT_FALSE(wrong.MayTry("newer", now_us));
}

TEST(ClientAddress, IsTheLastThatAProxyOfThisMachineNames) {
  const auto address = [](const char* peer, const char* forwarded) {
    GInetAddress* inet = g_inet_address_new_from_string(peer);
    const std::string text = web::AddressOf(inet, forwarded);
    g_object_unref(inet);
    return text;
  };
  EXPECT_EQ(address("127.0.0.1", ""), "127.0.0.1");
  EXPECT_EQ(address("127.0.0.1", "10.0.0.7"), "10.0.0.7");
  EXPECT_EQ(address("::1", "10.0.0.6,10.0.0.7"), "10.0.0.7");
  EXPECT_EQ(address("127.0.0.1", "10.0.0.5,10.0.0.6,10.0.0.7"), "10.0.0.7");
  EXPECT_EQ(address("127.0.0.1", std::string(100, 'x').c_str()), std::string(64, 'x'));
  EXPECT_EQ(address("10.0.0.5", "10.0.0.7"), "10.0.0.5") << "anyone may write that";
}

TEST(FoxgloveSink, SaysThatItsPortIsInUse) {
  Sink sink;
  const std::string port = std::to_string(sink.Stat("port"));
  EXPECT_NE(ErrorOf("port=" + port).find("Cannot serve on port " + port), std::string::npos);
}

}  // namespace
}  // namespace lidar::test
