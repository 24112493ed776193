// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/foxglove/protocol.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace lidar::foxglove {
namespace {

using nlohmann::json;
using Kind = Request::Kind;

TEST(Advertise, TellsSchemaAndEncodingOfEachChannel) {
  const auto text = json::parse(
      Advertise({{3, "/points", Schema::kPointCloud}, {4, "/statistics", Schema::kStatistics}}));
  EXPECT_EQ(text["op"], "advertise");
  EXPECT_EQ(text["channels"][0]["id"], 3);
  EXPECT_EQ(text["channels"][0]["schemaName"], "foxglove.PointCloud");
  EXPECT_EQ(text["channels"][0]["encoding"], "protobuf");
  EXPECT_EQ(text["channels"][1]["schemaEncoding"], "jsonschema");
  const auto schema = json::parse(text["channels"][1]["schema"].get<std::string>());
  EXPECT_EQ(schema["type"], "object");
  EXPECT_TRUE(schema["properties"].contains("target_bitrate"));
}

TEST(ServerInfo, SurvivesANameThatIsNoText) {
  EXPECT_EQ(json::parse(ServerInfo("\xff", "id"))["op"], "serverInfo");
}

TEST(ErrorStatus, HasTheLevelOfAnError) {
  const auto text = json::parse(ErrorStatus("no such channel"));
  EXPECT_EQ(text["op"], "status");
  EXPECT_EQ(text["level"], 2);  // 0: information, 1: warning
  EXPECT_EQ(text["message"], "no such channel");
}

TEST(Unadvertise, NamesTheChannels) {
  const auto text = json::parse(Unadvertise({3, 5}));
  EXPECT_EQ(text["op"], "unadvertise");
  EXPECT_EQ(text["channelIds"], (std::vector<int>{3, 5}));
}

TEST(ServerInfo, HasNameAndSession) {
  const auto text = json::parse(ServerInfo("robot", "7"));
  EXPECT_EQ(text["name"], "robot");
  EXPECT_EQ(text["sessionId"], "7");
}

TEST(Requests, SubscribeAndUnsubscribe) {
  const Request subscribe = ParseRequest(
      R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":3},{"id":0,"channelId":4}]})");
  ASSERT_EQ(subscribe.kind, Kind::kSubscribe);
  ASSERT_EQ(subscribe.subscriptions.size(), 2U);
  EXPECT_EQ(subscribe.subscriptions[0].id, 7U);
  EXPECT_EQ(subscribe.subscriptions[1].channel_id, 4U);
  const Request unsubscribe = ParseRequest(R"({"op":"unsubscribe","subscriptionIds":[7]})");
  ASSERT_EQ(unsubscribe.kind, Kind::kUnsubscribe);
  EXPECT_EQ(unsubscribe.unsubscribed, std::vector<std::uint32_t>{7});
}

TEST(Requests, OfOtherKindsAreUnsupported) {
  EXPECT_EQ(ParseRequest(R"({"op":"getParameters"})").kind, Kind::kUnsupported);
}

class MalformedRequest : public ::testing::TestWithParam<std::string> {};

TEST_P(MalformedRequest, IsToldApart) {
  const Request request = ParseRequest(GetParam());
  EXPECT_EQ(request.kind, Kind::kMalformed);
  EXPECT_FALSE(request.error.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Texts, MalformedRequest,
    ::testing::Values("", "garbage", "[]", "null", "{}", R"({"op":3})", R"({"op":"subscribe"})",
                      R"({"op":"subscribe","subscriptions":7})",
                      R"({"op":"subscribe","subscriptions":[7]})",
                      R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":3}]})",
                      R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":3}]})",
                      R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":3}]})",
                      R"({"op":"unsubscribe","subscriptionIds":["7"]})", std::string(30'000, '['),
                      std::string("\0\xff\xfe", 3)));

TEST(MessageHead, IsLittleEndian) {
  const MessageHead head = HeadOf(0x01020304, 0x1112131415161718);
  EXPECT_EQ(head, (MessageHead{1, 4, 3, 2, 1, 0x18, 0x17, 0x16, 0x15, 0x14, 0x13, 0x12, 0x11}));
}

}  // namespace
}  // namespace lidar::foxglove
