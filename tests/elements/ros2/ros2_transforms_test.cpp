// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of transforms that ros2src receives, and of clouds that pointcloudfilter moves by these
// transforms.
#include <set>

#include "src/cdr/messages.h"
#include "tests/elements/ros2/ros2_support.h"

namespace lidar::test {
namespace {

using gst::BufferPtr;
using Qos = FastPeer::Qos;

class Ros2Transforms : public Ros2Test {
 protected:
  std::unique_ptr<FastPeer> peer_;
};

constexpr const char* kTransformsType = "tf2_msgs::msg::dds_::TFMessage_";

PeerTransforms Transforms(const char* parent, const char* child, double x, std::int32_t sec) {
  return {{{{sec, 0, parent}, child, {x, 0, 0, 0, 0, 0, 1}}}};
}

TEST_F(Ros2Transforms, TakesTransformsAsTheyAre) {
  Start("ros2src", "topic=/tf type=tf qos=reliable");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Advertise<PeerTransforms>("rt/tf", kTransformsType, Qos::kReliable);
  ASSERT_TRUE(peer_->WaitForMatch(kPatience));
  ASSERT_TRUE(WaitForStat("publishers", 1));
  // A message is lost if it is sent before the two endpoints match. Therefore the test repeats it.
  ASSERT_TRUE(Eventually([&] {
    EXPECT_TRUE(peer_->Publish(PeerTransforms{}));
    g_usleep(50'000);
    return Stat("messages-empty") > 0;
  }));
  ASSERT_TRUE(peer_->Publish(Transforms("odom", "base", 2.5, 5)));
  const BufferPtr buffer = Pull();
  const auto bytes = BytesOf(buffer.get());
  const auto transforms = cdr::ReadTransforms({bytes.data(), bytes.size()});
  ASSERT_TRUE(transforms);
  ASSERT_EQ(transforms->size(), 1u);
  EXPECT_EQ((*transforms)[0].header.frame_id, "odom");
  EXPECT_EQ((*transforms)[0].child_frame_id, "base");
  EXPECT_EQ((*transforms)[0].translation[0], 2.5);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer.get()), 5 * GST_SECOND);
  EXPECT_EQ(Field("static"), "false");
}

/// Hundreds of messages may wait. Therefore a message of transforms must not be as large as a
/// cloud.
TEST_F(Ros2Transforms, WhatIsLargerThanTransformsAreIsDamaged) {
  Start("ros2src", "topic=/tf type=tf qos=reliable");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Advertise<PeerBytes>("rt/tf", kTransformsType, Qos::kReliable);
  ASSERT_TRUE(peer_->WaitForMatch(kPatience));
  ASSERT_TRUE(WaitForStat("publishers", 1));
  cdr::TransformStamped one;
  one.header.frame_id = "odom";
  one.child_frame_id = "base";
  const auto publish = [&](std::size_t count) {
    return peer_->Publish(PeerBytes{cdr::WriteTransforms(cdr::Transforms(count, one))});
  };
  // A message is lost if it is sent before the two endpoints match. Therefore the test repeats it.
  ASSERT_TRUE(Eventually([&] {
    EXPECT_TRUE(publish(15'000));
    g_usleep(50'000);
    return Stat("messages-damaged") > 0;
  }));
  const guint64 kept = Stat("bytes");
  EXPECT_LE(kept, Stat("messages") << 20);
  ASSERT_TRUE(publish(5'000));
  const BufferPtr buffer = Pull();
  ASSERT_TRUE(buffer);
  EXPECT_EQ(cdr::ReadTransforms(gst::BufferMap(buffer.get(), GST_MAP_READ).view())->size(), 5'000u);
}

TEST_F(Ros2Transforms, TakesStaticTransformsFromBeforeItWasThere) {
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Advertise<PeerTransforms>("rt/robot/tf_static", kTransformsType, Qos::kReliableTransient);
  ASSERT_TRUE(peer_->Publish(Transforms("base", "lidar", 1, 1)));
  Start("ros2src", "topic=/robot/tf_static type=tf");
  const BufferPtr buffer = Pull();
  ASSERT_TRUE(buffer);
  EXPECT_EQ(Field("static"), "true");
}

TEST_F(Ros2Transforms, TakesAllStaticTransformsOfAllThatKeepSome) {
  constexpr int kEach = 10;  // number of messages that a peer stores
  std::vector<std::unique_ptr<FastPeer>> peers;
  for (int peer = 0; peer < 3; ++peer) {
    peers.push_back(std::make_unique<FastPeer>(TestDomain()));
    peers.back()->Advertise<PeerTransforms>("rt/tf_static", kTransformsType,
                                            Qos::kReliableTransient);
    for (int i = 0; i < kEach; ++i)
      ASSERT_TRUE(peers.back()->Publish(
          Transforms("base", ("link" + std::to_string(peer * kEach + i)).c_str(), 1, 1)));
  }
  Start("ros2src", "topic=/tf_static type=tf depth=1");
  std::set<std::string> links;
  for (int i = 0; i < 3 * kEach; ++i) {
    const BufferPtr buffer = Pull();
    ASSERT_TRUE(buffer) << i;
    links.insert(cdr::ReadTransforms(gst::BufferMap(buffer.get(), GST_MAP_READ).view())
                     ->front()
                     .child_frame_id);
  }
  EXPECT_EQ(links.size(), 3U * kEach);
}

TEST_F(Ros2Transforms, TellsOfStaticTransformsThatNobodyKeeps) {
  Start("ros2src", "topic=/tf_static type=tf");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Advertise<PeerTransforms>("rt/tf_static", kTransformsType, Qos::kReliable);
  const std::string text = NextOwnComplaint();
  EXPECT_NE(text.find("transient local"), std::string::npos) << text;
}

/// A static and a moving transform together lead from the frame of the lidar to the frame "map".
TEST_F(Ros2Transforms, CloudsGoToTheFrameThatTransformsLeadTo) {
  const std::string domain = " domain-id=" + std::to_string(TestDomain());
  FastPeer fixed(TestDomain());
  FastPeer moving(TestDomain());
  fixed.Advertise<PeerTransforms>("rt/tf_static", kTransformsType, Qos::kReliableTransient);
  moving.Advertise<PeerTransforms>("rt/tf", kTransformsType, Qos::kReliable);
  ASSERT_TRUE(fixed.Publish(Transforms("base", "os_lidar", 1, 1)));
  Start("ros2src", "topic=/points qos=reliable",
        " ! pointcloudfilter name=f target-frame=map tf-timeout=60000000000 "
        "ros2src topic=/tf_static type=tf" +
            domain +
            " ! f.tf_0 "
            "ros2src topic=/tf type=tf qos=reliable" +
            domain + " ! f.tf_1");
  peer_ = std::make_unique<FastPeer>(TestDomain());
  peer_->Advertise<PeerCloud>("rt/points", kCloudType, Qos::kReliable);
  ASSERT_TRUE(peer_->WaitForMatch(kPatience));
  ASSERT_TRUE(moving.WaitForMatch(kPatience));
  ASSERT_TRUE(WaitForStat("publishers", 1));
  PeerCloud cloud = TestCloud(1, 1);
  const float x = 4;
  std::memcpy(cloud.data.data(), &x, sizeof x);
  // The cloud waits for a transform with its own time or a later one. A message is lost if it is
  // sent before the two endpoints match. Therefore the test repeats all of them.
  BufferPtr buffer;
  ASSERT_TRUE(Eventually([&] {
    EXPECT_TRUE(peer_->Publish(cloud));
    for (const int later : {0, 1})
      EXPECT_TRUE(moving.Publish(Transforms("map", "base", 100 + later, cloud.header.sec + later)));
    g_usleep(50'000);
    buffer.reset(gst_harness_try_pull(h_.get()));
    return buffer != nullptr;
  }));
  float moved = 0;
  std::memcpy(&moved, BytesOf(buffer.get()).data(), sizeof moved);
  // The moving transform is at 100 m + 0.123 s * 1 m/s.
  EXPECT_NEAR(moved, 4 + 1 + 100.123, 0.001);
  EXPECT_EQ(Field("frame-id"), "map");
}

}  // namespace
}  // namespace lidar::test
