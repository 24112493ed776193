// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/base/scalar_caps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lidar {
namespace {

constexpr const char* kSlice = "application/x-lidar-slice, alignment=(string)slice";

std::string With(const std::string& field) { return "application/x-a, " + field; }

TEST(ScalarCaps, AnOwnTextComesBackAsItWas) {
  const std::string text =
      "application/x-lidar-slice, alignment=(string)slice, "
      "fields=(string)\"x:F32:0\\,y:F32:4\\,z:F32:8\", framerate=(fraction)10/1, "
      "sensor-model=(buffer)01000200ff, columns=(int)-5, is-dense=(boolean)true";
  const auto caps = ScalarCaps::Parse(text);
  ASSERT_TRUE(caps);
  EXPECT_EQ(caps->media_type, "application/x-lidar-slice");
  ASSERT_EQ(caps->fields.size(), 6U);
  EXPECT_EQ(*caps->Find("alignment"), ScalarCaps::Value("slice"));
  EXPECT_EQ(*caps->Find("fields"), ScalarCaps::Value("x:F32:0,y:F32:4,z:F32:8"));
  EXPECT_EQ(*caps->Find("framerate"), ScalarCaps::Value(ScalarCaps::Fraction{10, 1}));
  EXPECT_EQ(*caps->Find("sensor-model"), ScalarCaps::Value(ScalarCaps::Bytes{1, 0, 2, 0, 255}));
  EXPECT_EQ(*caps->Find("columns"), ScalarCaps::Value(std::int32_t{-5}));
  EXPECT_EQ(*caps->Find("is-dense"), ScalarCaps::Value(true));
  EXPECT_EQ(caps->Find("columnss"), nullptr);
  EXPECT_EQ(caps->ToText(), text);
}

TEST(ScalarCaps, EachTypeComesBackAtItsLimits) {
  ScalarCaps caps;
  caps.media_type = "application/x-a";
  caps.fields = {{"a", std::string()},
                 {"b", std::string("NULL")},
                 {"c", std::string("r\xC3\xBC"
                                   "ck \"\\\xF4\x8F\xBF\xBF")},
                 {"least-of_3.bytes", std::string("\xE0\xA0\x80 \xE2\x82\xAC")},
                 {"least-of_4.bytes", std::string("\xF0\x90\x80\x80 \xF0\x9F\x9A\x97")},
                 {"d", false},
                 {"e", std::numeric_limits<std::int32_t>::min()},
                 {"f", std::numeric_limits<std::uint32_t>::max()},
                 {"g", std::numeric_limits<std::int64_t>::min()},
                 {"h", std::numeric_limits<std::uint64_t>::max()},
                 {"i", std::numeric_limits<float>::denorm_min()},
                 {"j", std::numeric_limits<double>::max()},
                 {"k", ScalarCaps::Fraction{-2'147'483'647, 2'147'483'647}},
                 {"l", ScalarCaps::Bytes()},
                 {"m", ScalarCaps::Doubles(16, -1.0 / 3)},
                 {"n", ScalarCaps::Doubles{0.5}},
                 {"Zz-aA_0.9", std::string("AZaz09_-+/:.")}};
  const auto text = caps.ToText();
  ASSERT_TRUE(text);
  EXPECT_EQ(ScalarCaps::Parse(*text), caps);
}

TEST(ScalarCaps, DifferInTypeOfMediaNameTypeOrValueOfAField) {
  const auto caps = ScalarCaps::Parse("application/x-a, n=(fraction)10/1");
  EXPECT_EQ(caps, ScalarCaps::Parse("application/x-a, n=(fraction)10/1"));
  for (const char* other :
       {"application/x-b, n=(fraction)10/1", "application/x-a", "application/x-a, m=(fraction)10/1",
        "application/x-a, n=(int)10", "application/x-a, n=(fraction)20/1",
        "application/x-a, n=(fraction)10/2", "application/x-a, n=(fraction)10/1, m=(int)1"})
    EXPECT_FALSE(caps == ScalarCaps::Parse(other)) << other;
}

class OutsideOfTheGrammar : public ::testing::TestWithParam<std::string> {};
TEST_P(OutsideOfTheGrammar, IsRefused) { EXPECT_FALSE(ScalarCaps::Parse(GetParam())); }
INSTANTIATE_TEST_SUITE_P(Text, OutsideOfTheGrammar,
                         ::testing::Values("", "ANY", "video/x-raw", "application/x-",
                                           "application/x-1a", "application/x-a(memory:GLMemory)",
                                           "application/x-a; application/x-b", "application/x-a ",
                                           "application/x-a, ", "application/x-a, n",
                                           "application/x-a, n=", "application/x-a, n=1",
                                           "application/x-a, =(int)1", "application/x-a, 1n=(int)1",
                                           "application/x-a, n:m=(int)1",
                                           "application/x-a, n=(int)1, n=(int)2"));
INSTANTIATE_TEST_SUITE_P(
    Values, OutsideOfTheGrammar,
    ::testing::Values(With("n=(int)"), With("n=(int){ 1, 2 }"), With("n=(int)[ 1, 2 ]"),
                      With("n=(int)< 1 >"), With("n=(structure)a"), With("n=(int)2147483648"),
                      With("n=(int)1x"), With("n=(uint)-1"), With("n=(boolean)yes"),
                      With("n=(double)inf"), With("n=(double)nan"), With("n=(float)1e39"),
                      With("n=(fraction)1"), With("n=(fraction)x/1"), With("n=(fraction)1/x"),
                      With("n=(fraction)1/0"), With("n=(fraction)1/-1"),
                      With("n=(fraction)-2147483648/1"), With("n=(buffer)abc"),
                      With("n=(buffer)ag"), With("n=(buffer)\"ab\"")));
INSTANTIATE_TEST_SUITE_P(Arrays, OutsideOfTheGrammar,
                         ::testing::Values(With("n=(double)<"), With("n=(double)<  >"),
                                           With("n=(double)< 1"), With("n=(double)< 1, >"),
                                           With("n=(double)< 1 2 >"), With("n=(double)< nan >"),
                                           With("n=(double)< < 1 > >"), With("n=(float)< 1 >"),
                                           With("n=(string)< a >")));
INSTANTIATE_TEST_SUITE_P(
    Strings, OutsideOfTheGrammar,
    ::testing::Values(
        With("n=(string)"), With("n=(string)NULL"), With("n=(string)\""), With("n=(string)\"a"),
        With("n=(string)\"a\\"), With("n=(string)\"\\1\""), With("n=(string)\"\\189\""),
        With("n=(string)\"\\777\""), With("n=(string)\"\\000\""), With("n=(string)\"\\012\""),
        With("n=(string)\"\\177\""), With("n=(string)\"\\300\\200\""),
        With("n=(string)\"\\355\\240\\200\""), With("n=(string)\"\\364\\220\\200\\200\""),
        With("n=(string)\"\\303\""), With("n=(string)\"\\360\\237\\232\""),
        With("n=(string)\"\\303a\""), With("n=(string)\"\\340\\200\\200\""),
        With("n=(string)\"\\360\\200\\200\\200\""), With("n=(string)\"\\355\\277\\277\""),
        With("n=(string)\"\\370\\220\\200\\200\""), With("n=(string)\"\\608\""),
        With("n=(string)[a]"), With("n=(string)\"a\"b"), With("n=(string)\"\xC3\xBC\"")));

TEST(ScalarCaps, AnArrayHasAtMostSixteenDoubles) {
  const auto text = [](std::size_t count) {
    std::string values = "1";
    for (std::size_t i = 1; i < count; ++i) values += ", 1";
    return With("n=(double)< " + values + " >");
  };
  const auto caps = ScalarCaps::Parse(text(16));
  ASSERT_TRUE(caps);
  EXPECT_EQ(*caps->Find("n"), ScalarCaps::Value(ScalarCaps::Doubles(16, 1)));
  EXPECT_FALSE(ScalarCaps::Parse(text(17)));
}

TEST(ScalarCaps, NestingIsRefusedHoweverDeep) {
  // With each level, the time of gst_caps_from_string() would double.
  for (const std::string level : {"[[ a, b={", "{", "\"", "("}) {
    std::string text = std::string(kSlice) + ", a=";
    for (int i = 0; i < 10'000; ++i) text += level;
    EXPECT_FALSE(ScalarCaps::Parse(text)) << level;
  }
}

TEST(ScalarCaps, NamesFieldsAndTextAreBounded) {
  const auto many = [](std::size_t count) {
    std::string text = "application/x-a";
    for (std::size_t i = 0; i < count; ++i) text += ", f" + std::to_string(i) + "=(int)1";
    return text;
  };
  EXPECT_TRUE(ScalarCaps::Parse(many(64)));
  EXPECT_FALSE(ScalarCaps::Parse(many(65)));
  EXPECT_TRUE(ScalarCaps::Parse(With(std::string(64, 'n') + "=(int)1")));
  EXPECT_FALSE(ScalarCaps::Parse(With(std::string(65, 'n') + "=(int)1")));
  EXPECT_TRUE(ScalarCaps::Parse("application/x-" + std::string(50, 'a')));
  EXPECT_FALSE(ScalarCaps::Parse("application/x-" + std::string(51, 'a')));
  const std::string most = With("s=(string)" + std::string((128U << 10) - 27, 's'));
  EXPECT_TRUE(ScalarCaps::Parse(most));
  EXPECT_FALSE(ScalarCaps::Parse(most + "s"));
}

TEST(ScalarCaps, WhatCannotBeWrittenSaysWhy) {
  const auto why = [](const char* media_type, ScalarCaps::Field field) {
    ScalarCaps caps;
    caps.media_type = media_type;
    caps.fields.push_back(std::move(field));
    std::string reason;
    EXPECT_FALSE(caps.ToText(&reason));
    return reason;
  };
  EXPECT_EQ(why("video/x-raw", {"n", 1}), "video/x-raw does not begin with application/x-");
  EXPECT_EQ(
      why("application/x-a", {"a:b", 1}),
      "the field name a:b must begin with a letter and have only letters, digits, -, _ and .");
  EXPECT_EQ(why("application/x-a", {"n", std::numeric_limits<double>::infinity()}),
            "the field n is not finite");
  EXPECT_EQ(why("application/x-a", {"n", std::numeric_limits<float>::infinity()}),
            "the field n is not finite");
  EXPECT_EQ(why("application/x-a", {"n", ScalarCaps::Fraction{1, 0}}),
            "the field n is not a fraction");
  for (const auto count : {0U, 17U})
    EXPECT_EQ(why("application/x-a", {"n", ScalarCaps::Doubles(count)}),
              "the field n must have 1 to 16 values");
  EXPECT_EQ(why("application/x-a", {"n", ScalarCaps::Doubles{1, std::nan("")}}),
            "the field n is not finite");
  EXPECT_EQ(why("application/x-a", {"n", std::string("a\nb")}),
            "the field n has characters that cannot be printed");
  EXPECT_EQ(why("application/x-a", {"n", std::string(1U << 20, 'a')}),
            "the text of the caps has more than 131072 bytes");
  ScalarCaps many;
  many.media_type = "application/x-a";
  for (int i = 0; i < 64; ++i) many.fields.push_back({"n" + std::to_string(i), i});
  std::string reason;
  EXPECT_TRUE(many.ToText(&reason)) << reason;
  many.fields.push_back({"n", 64});
  EXPECT_FALSE(many.ToText(&reason));
  EXPECT_EQ(reason, "the caps have more than 64 fields");
}

}  // namespace
}  // namespace lidar
