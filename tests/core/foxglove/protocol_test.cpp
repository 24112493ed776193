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

TEST(Advertise, TellsWhatAStreamOfSlicesIs) {
  SliceStreamInfo stream;
  stream.has_ranges = true;
  stream.fields = "x:F32:0,y:F32:4,z:F32:8";
  stream.framerate_n = 10;
  stream.sensor_model = {1, 2, 3};
  stream.frame_id = "os1";
  stream.clouds = "/points";
  Channel channel{3, "/points/slices", Schema::kSlice, DescribeSlices(stream)};
  const auto text = json::parse(Advertise({channel}))["channels"][0];
  EXPECT_EQ(text["schemaName"], "lidar.Slice");
  EXPECT_EQ(text["encoding"], "lidar-slice");
  EXPECT_EQ(text["schemaEncoding"], "json");
  EXPECT_EQ(json::parse(text["schema"].get<std::string>()),
            json::parse(R"({"geometry":"range","fields":"x:F32:0,y:F32:4,z:F32:8",
              "framerate":[10,1],"sensorModel":"AQID","frameId":"os1","clouds":"/points",
              "recording":false})"));
}

TEST(Advertise, TellsOfAStreamWithoutRangesAndOfItsRecording) {
  SliceStreamInfo stream;
  stream.framerate_n = 30'000;
  stream.framerate_d = 1'001;
  stream.recording = true;
  const auto text = json::parse(DescribeSlices(stream));
  EXPECT_EQ(text["geometry"], "xyz");
  EXPECT_EQ(text["framerate"], json::parse("[30000, 1001]"));
  EXPECT_EQ(text["recording"], true);
}

TEST(Advertise, SurvivesTextsThatAreNone) {
  SliceStreamInfo stream;
  stream.fields = "x\xff\xfe\"}]";
  stream.frame_id = std::string("\0\n", 2);
  Channel channel{3, "/\xff\"<script>", Schema::kSlice, DescribeSlices(stream)};
  const auto text = json::parse(Advertise({channel}))["channels"][0];
  EXPECT_NE(text["topic"].get<std::string>().find("\"<script>"), std::string::npos);
  EXPECT_EQ(json::parse(text["schema"].get<std::string>())["frameId"], stream.frame_id);
}

TEST(SliceHead, HasTheLayoutOfThePage) {
  const SliceHead head =
      HeadOfSlice({{0x01020304, 5}, 16, 1023, true, 0x0203, true}, 0x0807060504030201);
  const SliceHead expected = {1,    3, 5, 0, 16, 0, 3, 2, 4, 3, 2, 1,
                              0xFF, 3, 0, 0, 1,  2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(head, expected);
}

TEST(Requests, SayWhatAViewerHasDrawnAndLacks) {
  const Request drawn =
      ParseRequest(R"({"op":"drawn","subscriptionId":7,"scan":4294967295,"slice":5})");
  ASSERT_EQ(drawn.kind, Kind::kDrawn);
  EXPECT_EQ(drawn.subscription, 7U);
  EXPECT_EQ(drawn.slice.scan, 4294967295U);
  EXPECT_EQ(drawn.slice.index, 5U);
  const Request lacks = ParseRequest(R"({"op":"lacksReference","subscriptionId":7})");
  ASSERT_EQ(lacks.kind, Kind::kLacksReference);
  EXPECT_EQ(lacks.subscription, 7U);
  for (const char* bad :
       {R"({"op":"drawn","subscriptionId":7,"scan":1})", R"({"op":"drawn","scan":1,"slice":1})",
        R"({"op":"lacksReference"})", R"({"op":"drawn","subscriptionId":7,"scan":-1,"slice":1})"})
    EXPECT_EQ(ParseRequest(bad).kind, Kind::kMalformed) << bad;
}

TEST(Requests, GoBackInTimeAndReturn) {
  const Request replay =
      ParseRequest(R"({"op":"replay","subscriptionId":7,"number":65535,"time":1764085200.5})");
  ASSERT_EQ(replay.kind, Kind::kReplay) << replay.error;
  EXPECT_EQ(replay.subscription, 7U);
  EXPECT_EQ(replay.number, 65535U);
  EXPECT_EQ(replay.time_ns, 1764085200500000000U);
  EXPECT_EQ(ParseRequest(R"({"op":"live","subscriptionId":7})").kind, Kind::kLive);
  for (const char* bad :
       {R"({"op":"replay","number":1,"time":1})", R"({"op":"replay","subscriptionId":7,"time":1})",
        R"({"op":"replay","subscriptionId":7,"number":0,"time":1})",
        R"({"op":"replay","subscriptionId":7,"number":65536,"time":1})",
        R"({"op":"replay","subscriptionId":7,"number":1})",
        R"({"op":"replay","subscriptionId":7,"number":1,"time":-1})",
        R"({"op":"replay","subscriptionId":7,"number":1,"time":1e300})",
        R"({"op":"replay","subscriptionId":7,"number":1,"time":"../../etc/passwd"})",
        R"({"op":"live"})"})
    EXPECT_EQ(ParseRequest(bad).kind, Kind::kMalformed) << bad;
}

TEST(Recordings, SayWhatTheyHave) {
  const auto text =
      json::parse(Describe(RecordingStatus{7, 3, 1'500'000'000, 2'000'000'000, 4, {}}));
  EXPECT_EQ(text["op"], "recording");
  EXPECT_EQ(text["subscriptionId"], 7);
  EXPECT_EQ(text["number"], 3);
  EXPECT_EQ(text["from"], 1.5);
  EXPECT_EQ(text["to"], 2.0);
  EXPECT_EQ(text["damaged"], 4);
  EXPECT_TRUE(text["end"].is_null());
  RecordingStatus ended;
  ended.end_ns = 1'250'000'000;
  EXPECT_EQ(json::parse(Describe(ended))["end"], 1.25);
}

TEST(ServerInfo, SurvivesANameThatIsNoText) {
  EXPECT_EQ(json::parse(ServerInfo("\xff", "id"))["op"], "serverInfo");
}

TEST(ErrorStatus, HasTheLevelOfAnError) {
  const auto text = json::parse(ErrorStatus("no such channel"));
  EXPECT_EQ(text["op"], "status");
  EXPECT_EQ(text["level"], 2);  // an error; 0 is information, 1 is a warning
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
