// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what ros2sink and ros2src publish, output and post in scripted runs with golden files.
#include "tests/support/golden_course.h"

#include "src/base/crc.h"
#include "tests/elements/ros2/ros2_support.h"

namespace lidar::test {
namespace {

using PeerQos = FastPeer::Qos;

std::string CapsTextOf(const PeerCloud& cloud, const char* extra = "") {
  const gst::StringPtr text(gst_caps_to_string(CloudCaps(cloud, extra).get()));
  return text.get();
}

gst::BufferPtr BufferOf(const PeerCloud& cloud) { return gst::BufferPtr(CloudBuffer(cloud)); }

/// Waits for the next message of a subscriber, and notes it.
void NoteReceived(Course& c, FastPeer* peer) {
  PeerCloud cloud;
  ASSERT_TRUE(peer->Take(&cloud, kPatience));
  c.AddLine("received " + std::to_string(cloud.width) + "x" + std::to_string(cloud.height) +
            " at " + std::to_string(cloud.header.sec) + "." + std::to_string(cloud.header.nanosec) +
            " of " + cloud.header.frame_id + " row " + std::to_string(cloud.row_step) +
            (cloud.is_dense ? " dense" : "") + " crc " +
            std::to_string(Crc32({cloud.data.data(), cloud.data.size()})));
}

void Ros2SinkCourse(Course& c) {
  PeerCloud cloud = TestCloud(4, 2);
  c.Begin(CapsTextOf(cloud, ",frame-id=os"));
  c.Push("unread", BufferOf(cloud));
  std::unique_ptr<FastPeer> peer;
  const auto subscribe = [&] {
    peer = std::make_unique<FastPeer>(TestDomain());
    peer->Subscribe<PeerCloud>("rt/points", kCloudType, PeerQos::kReliable);
    c.AwaitStat("subscribers", 1);
  };
  subscribe();
  const auto push = [&](const char* what, gst::BufferPtr buffer) {
    c.Push(what, std::move(buffer));
    NoteReceived(c, peer.get());
  };
  push("read", BufferOf(cloud));
  c.Set("frame-id", "front");
  push("of another frame", BufferOf(cloud));
  for (int i = 0; i < 2; ++i)
    c.Push("of another size", gst::BufferPtr(gst_buffer_new_allocate(nullptr, 95, nullptr)));
  cloud = TestCloud(3, 1, 2);
  cloud.is_dense = true;
  c.SetCaps(CapsTextOf(cloud));
  push("of other caps", BufferOf(cloud));
  c.Flush();
  push("behind a flush", BufferOf(cloud));
  c.Gap(0, GST_MSECOND);
  c.End();
  c.Stop();
  // Otherwise the element could find the peer before the course notes the first statistics.
  peer.reset();
  c.Begin(CapsTextOf(cloud));
  subscribe();
  push("in a second run", BufferOf(cloud));
  c.Push("of another size", gst::BufferPtr(gst_buffer_new_allocate(nullptr, 95, nullptr)));
  for (const std::string& caps :
       {std::string("application/x-imu,fields=(string)\"x:F32:0\""), CapsTextOf(cloud)})
    c.SetCaps(caps);
  push("of the caps before", BufferOf(cloud));
}

void Ros2SrcCourse(Course& c) {
  std::unique_ptr<FastPeer> good;
  std::unique_ptr<FastPeer> bad;
  PeerBytes damaged{std::vector<std::uint8_t>(40, 0xFF)};
  // Encapsulation header: CDR, little-endian.
  damaged.bytes[0] = damaged.bytes[2] = damaged.bytes[3] = 0;
  damaged.bytes[1] = 1;
  std::size_t broken = 0;
  // The element counts first, and posts the warning later. Therefore the golden file has the
  // warning together with the next cloud.
  const auto breaks = [&] {
    EXPECT_TRUE(bad->Publish(damaged));
    c.AwaitStat("messages-damaged", ++broken);
  };
  const auto gives = [&](const char* what, const PeerCloud& cloud) {
    EXPECT_TRUE(good->Publish(cloud));
    c.Await(what, "buffer");
  };
  const auto begin = [&] {
    good.reset();
    bad.reset();
    gst_element_set_state(c.element(), GST_STATE_PLAYING);
    good = std::make_unique<FastPeer>(TestDomain());
    bad = std::make_unique<FastPeer>(TestDomain());
    good->Advertise<PeerCloud>("rt/points", kCloudType, PeerQos::kReliable);
    bad->Advertise<PeerBytes>("rt/points", kCloudType, PeerQos::kReliable);
    EXPECT_TRUE(good->WaitForMatch(kPatience) && bad->WaitForMatch(kPatience));
    c.AwaitStat("publishers", 2);
    c.Await("publishers are found", "event stream-start");
  };
  c.Ask();
  begin();
  gives("a cloud", TestCloud(4, 2));
  gives("another one", TestCloud(4, 2, 2));
  gives("wider", TestCloud(5, 2, 3));
  breaks();
  gives("behind a damaged one", TestCloud(5, 2, 4));
  breaks();
  breaks();
  gives("behind two of them", TestCloud(5, 2, 5));
  EXPECT_TRUE(good->Publish(TestCloud(0, 0, 5)));
  c.AwaitStat("messages-empty", 1);
  PeerCloud dense = TestCloud(5, 2, 6);
  dense.is_dense = true;
  gives("dense, behind an empty one", dense);
  dense.header.frame_id = "other";
  gives("of another frame", dense);
  c.Ask();
  breaks();
  c.Stop();
  broken = 0;
  begin();
  breaks();
  gives("behind a damaged one", TestCloud(4, 2, 7));
}

std::string InTestDomain(const char* launch) {
  return launch + (" topic=/points qos=reliable domain-id=" + std::to_string(TestDomain()));
}

const std::size_t kRos2Courses = AddGoldenCourses(
    "Ros2GoldenCourses",
    {{"sink", InTestDomain("ros2sink sync=false async=false"), Ros2SinkCourse, {"sink", nullptr}},
     {"src", InTestDomain("ros2src"), Ros2SrcCourse, {nullptr, "src"}}},
    GOLDEN_COURSES_FOLDER);

}  // namespace
}  // namespace lidar::test
