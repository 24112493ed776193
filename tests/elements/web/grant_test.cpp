// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of signed tokens: which tokens are accepted, and what they allow.
#include "ext/web/grant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>

#include "src/base/base64.h"
#include "tests/elements/web/web_peer.h"

namespace {
std::atomic<gint64> ahead_us{0};
}  // namespace

/// Replaces GLib's function in this program and in the plugins that it loads.
extern "C" __attribute__((visibility("default"))) gint64 g_get_real_time() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return now / std::chrono::microseconds(1) + ahead_us;
}

namespace lidar::test {
namespace {

using web::Grant;
using web::ReadSignedToken;

const std::string kSecret = "0123456789abcdef0123456789abcdef";
constexpr std::int64_t kNow_s = 1'800'000'000;

std::string Base64Url(const std::string& text) {
  std::string coded = Base64({text.begin(), text.end()});
  std::replace(coded.begin(), coded.end(), '+', '-');
  std::replace(coded.begin(), coded.end(), '/', '_');
  while (!coded.empty() && coded.back() == '=') coded.pop_back();
  return coded;
}

std::string Sign(const std::string& claims, const std::string& header = R"({"alg":"HS256"})",
                 const std::string& secret = kSecret) {
  const std::string text = Base64Url(header) + "." + Base64Url(claims);
  const gst::StringPtr hex(
      g_compute_hmac_for_string(G_CHECKSUM_SHA256, reinterpret_cast<const guchar*>(secret.data()),
                                secret.size(), text.data(), static_cast<gssize>(text.size())));
  std::string digest;
  for (const char* p = hex.get(); *p != 0; p += 2)
    digest += static_cast<char>(std::stoi(std::string(p, 2), nullptr, 16));
  return text + "." + Base64Url(digest);
}

TEST(SignedToken, OfRfc7515IsRead) {
  // The token in appendix A.1 of RFC 7515. It expired in 2011.
  const std::string key =
      "AyM1SysPpbyDfgZld3umj1qzKObwVMkoqQ-EstJQLr_T-1qS0gZH75aKtMN3Yj0iPS4hcgUuTwjAzZr1Z9CAow";
  std::string usual = key;
  std::replace(usual.begin(), usual.end(), '-', '+');
  std::replace(usual.begin(), usual.end(), '_', '/');
  const auto bytes = FromBase64(usual);
  const std::string secret(bytes.begin(), bytes.end());
  const std::string token =
      "eyJ0eXAiOiJKV1QiLA0KICJhbGciOiJIUzI1NiJ9.eyJpc3MiOiJqb2UiLA0KICJleHAiOjEzMDA4MTkzODAsDQogIm"
      "h0dHA6Ly9leGFtcGxlLmNvbS9pc19yb290Ijp0cnVlfQ.dBjftJeZ4CVP-mB92K27uhbUJU1p1r_wW1gFWFOEjXk";
  EXPECT_TRUE(ReadSignedToken(token, secret, 1'300'819'379));
  EXPECT_FALSE(ReadSignedToken(token, secret, 1'300'819'380));
  EXPECT_FALSE(ReadSignedToken(token, kSecret, 1'300'819'379));
}

TEST(SignedToken, OpensTheTopicsThatItNames) {
  const auto grant = ReadSignedToken(Sign(R"({"exp":1800000100,"topics":["/r7/*","/statistics"]})"),
                                     kSecret, kNow_s);
  ASSERT_TRUE(grant);
  EXPECT_EQ(grant->expires_s, kNow_s + 100);
  for (const char* topic : {"/r7/points", "/r7/points/slices", "/statistics"})
    EXPECT_TRUE(grant->Allows(topic)) << topic;
  for (const char* topic : {"/r70/points", "/r8/points", "/r7", "/statistics/x", ""})
    EXPECT_FALSE(grant->Allows(topic)) << topic;
  EXPECT_TRUE(ReadSignedToken(Sign(R"({"exp":1800000100})"), kSecret, kNow_s)->Allows("/any"));
  EXPECT_TRUE(ReadSignedToken(Sign(R"({"exp":1800000100,"nbf":1800000000})"), kSecret, kNow_s))
      << "from now on";
  EXPECT_FALSE(
      ReadSignedToken(Sign(R"({"exp":1800000100,"topics":[]})"), kSecret, kNow_s)->Allows("/any"));
}

TEST(SignedToken, ThatIsDamagedOrOverIsRefused) {
  const std::string good = Sign(R"({"exp":1800000100})");
  ASSERT_TRUE(ReadSignedToken(good, kSecret, kNow_s));
  for (std::size_t i = 0; i < good.size() - 1; ++i) {
    std::string bad = good;
    bad[i] = bad[i] == 'A' ? 'B' : 'A';
    EXPECT_FALSE(ReadSignedToken(bad, kSecret, kNow_s)) << i;
    EXPECT_FALSE(ReadSignedToken(good.substr(0, i), kSecret, kNow_s)) << i;
  }
  const std::vector<std::string> tokens = {
      "",
      ".",
      "..",
      "...",
      std::string(5000, '.'),
      good + ".x",
      Sign(R"({})"),
      Sign(R"({"exp":"1800000100"})"),
      Sign(R"({"exp":-1})"),
      Sign(R"({"exp":1e300})"),
      Sign(R"({"exp":1800000100,"nbf":1800000001})"),
      Sign(R"({"exp":1800000100,"nbf":"x"})"),
      Sign(R"({"exp":1800000100,"topics":"/r7/*"})"),
      Sign(R"({"exp":1800000100,"topics":[7]})"),
      Sign("[]"),
      Sign("no json"),
      Sign(R"({"exp":1800000000})"),
      Sign(R"({"exp":1800000100})", R"({"alg":"none"})"),
      Sign(R"({"exp":1800000100})", R"({"alg":"HS512"})"),
      Sign(R"({"exp":1800000100})", R"({"alg":"HS256","crit":["exp"]})"),
      Sign(R"({"exp":1800000100})", "[]"),
      Sign(R"({"exp":1800000100})", R"({"alg":"HS256"})", kSecret + "x")};
  for (const std::string& token : tokens)
    EXPECT_FALSE(ReadSignedToken(token, kSecret, kNow_s)) << token;
}

TEST(SignedToken, ThatIsLongerThan4096LettersIsRefused) {
  bool is_long = false;
  for (std::size_t blanks = 2'900; !is_long; ++blanks) {
    const std::string token = Sign(R"({"exp":1800000100})" + std::string(blanks, ' '));
    is_long = token.size() > 4'096;
    EXPECT_EQ(ReadSignedToken(token, kSecret, kNow_s).has_value(), !is_long) << token.size();
  }
}

std::string Claims(int seconds, const std::string& topics) {
  return R"({"exp":)" + std::to_string(g_get_real_time() / G_USEC_PER_SEC + seconds) +
         R"(,"topics":)" + topics + "}";
}

TEST(SignedToken, ShowsAClientTheTopicsOfItsRobotOnly) {
  Sink sink("token-secret=" + kSecret + " sink_0::topic=/r7/points");
  sink.SetCloudCaps();
  sink.PushCloud(1);
  const std::string path = "/?token=" + Sign(Claims(1'000, R"(["/r8/*","/statistics"])"));
  Peer stranger(sink.Url("ws", path), {"foxglove.sdk.v1"});
  stranger.Channel("/statistics");
  EXPECT_EQ(stranger.channels.count("/r7/points"), 0U);
  Peer peer(sink.Url("ws", "/?token=" + Sign(Claims(1'000, R"(["/r7/*"])"))), {"foxglove.sdk.v1"});
  const std::uint32_t id = peer.Channel("/r7/points");
  EXPECT_EQ(peer.channels.count("/statistics"), 0U);
  // A client cannot subscribe to a hidden channel, even by the channel's number.
  const nlohmann::json item = {{"id", 1}, {"channelId", id}};
  stranger.SendText(nlohmann::json{{"op", "subscribe"}, {"subscriptions", {item}}}.dump());
  stranger.Sync();
  peer.Subscribe("/r7/points", 2);
  sink.PushCloud(2);
  EXPECT_EQ(peer.Next().subscription, 2U);
  stranger.Sync();
  EXPECT_TRUE(stranger.received.empty());
}

TEST(SignedToken, EndsItsConnectionWhenItIsOver) {
  Sink sink("token-secret=" + kSecret);
  Peer peer(sink.Url("ws", "/?token=" + Sign(Claims(1'000, R"(["/*"])"))), {"foxglove.sdk.v1"});
  ASSERT_TRUE(peer.connected());
  ahead_us = 1'000 * G_USEC_PER_SEC;
  EXPECT_TRUE(WaitUntil([&] { return peer.closed(); }));
  ahead_us = 0;
  EXPECT_EQ(peer.close_code(), 4401);
}

}  // namespace
}  // namespace lidar::test
