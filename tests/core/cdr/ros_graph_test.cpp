// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/ros_graph.h"

#include <gtest/gtest.h>

#include "src/cdr/cdr_reader.h"

namespace lidar::cdr {
namespace {

TEST(RosGraph, TopicsHaveTheirPrefixInDds) {
  EXPECT_EQ(ToDdsTopic("/ouster/points"), "rt/ouster/points");
  EXPECT_EQ(ToDdsTopic("points_2"), "rt/points_2");
  for (const char* bad : {"", "/", "//a", "a//b", "a/", "a b", "/1a", "a/2", "a-b", "~/x", "\xC3"})
    EXPECT_FALSE(ToDdsTopic(bad)) << bad;
  EXPECT_FALSE(ToDdsTopic(std::string(300, 'a')));
}

TEST(RosGraph, NodesHaveANamespace) {
  const auto plain = ParseNodeName("lidar");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->name_space, "/");
  EXPECT_EQ(plain->name, "lidar");
  const auto nested = ParseNodeName("/robot/front/lidar");
  ASSERT_TRUE(nested);
  EXPECT_EQ(nested->name_space, "/robot/front");
  EXPECT_EQ(nested->name, "lidar");
  EXPECT_FALSE(ParseNodeName("robot 1"));
}

TEST(RosGraph, AnyTextBecomesANodesName) {
  EXPECT_EQ(ToNodeName("ros2src0"), "ros2src0");
  EXPECT_EQ(ToNodeName("my-src 1"), "my_src_1");
  EXPECT_EQ(ToNodeName("1st"), "_1st");
  EXPECT_EQ(ToNodeName(""), "_");
}

class Gids : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Gids, AreAsLongAsTheDistributionHasThem) {
  ParticipantEntities entities;
  entities.participant.fill(0xA1);
  entities.node = {"/robot", "lidar"};
  entities.readers.resize(1);
  entities.readers[0].fill(0xB2);
  const auto bytes = WriteParticipantEntities(entities, GetParam());
  CdrReader r({bytes.data(), bytes.size()});
  const ByteView participant = r.Bytes(GetParam());
  EXPECT_EQ(participant.data[15], 0xA1);
  EXPECT_EQ(participant.data[GetParam() - 1], GetParam() > 16 ? 0 : 0xA1);
  EXPECT_EQ(r.U32(), 1u);
  EXPECT_EQ(r.Text(), "/robot");
  EXPECT_EQ(r.Text(), "lidar");
  EXPECT_EQ(r.U32(), 1u);
  EXPECT_EQ(r.Bytes(GetParam()).data[0], 0xB2);
  EXPECT_EQ(r.U32(), 0u);
  EXPECT_TRUE(r.ok());
  EXPECT_EQ(r.remaining(), 0u);
}

INSTANTIATE_TEST_SUITE_P(HumbleAndLater, Gids, ::testing::Values(24u, 16u));

}  // namespace
}  // namespace lidar::cdr
