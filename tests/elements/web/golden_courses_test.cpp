// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what foxglovesink advertises, sends and posts in scripted runs with a golden file.
#include "tests/support/golden_course.h"

#include "src/base/crc.h"
#include "tests/elements/web/web_peer.h"

namespace lidar::test {
namespace {

constexpr GstClockTime kCapturedAt = 1'500'000'000 * GST_SECOND;

/// A viewer that adds the messages that it receives to the course.
class NotedViewer {
 public:
  NotedViewer(Course* course, guint64 port)
      : course_(*course), peer_("ws://127.0.0.1:" + std::to_string(port), {"foxglove.sdk.v1"}) {}

  /// Subscribes to a topic that has a new channel, and notes the description of the channel.
  void Subscribe(const char* topic, std::uint32_t id) {
    EXPECT_TRUE(WaitUntil([&] { return peer_.Channel(topic) != noted_[topic]; }));
    noted_[topic] = peer_.Channel(topic);
    peer_.Subscribe(topic, id);
    nlohmann::json channel = peer_.channels[topic];
    std::string schema = channel.value("schema", "");
    channel["schema"] =
        Crc32({reinterpret_cast<const std::uint8_t*>(schema.data()), schema.size()});
    course_.AddLine("channel " + channel.dump());
  }
  void Unsubscribe(std::uint32_t id) {
    peer_.SendText(nlohmann::json{{"op", "unsubscribe"}, {"subscriptionIds", {id}}}.dump());
    peer_.Sync();
  }
  void Say(const std::string& text) {
    peer_.Sync();
    peer_.statuses = {""};
    peer_.SendText(text);
    peer_.Sync();
    course_.AddLine("answer " + nlohmann::json(peer_.statuses).dump());
  }
  /// Waits for `messages` messages, then sends a request, and notes all messages that arrive before
  /// its answer. The answer may overtake messages that still wait, so the number is needed.
  void NoteReceived(std::size_t messages) {
    EXPECT_TRUE(WaitUntil([&] { return peer_.received.size() >= messages; }));
    peer_.Sync();
    for (; !peer_.received.empty(); peer_.received.pop_front()) {
      const Received& r = peer_.received.front();
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(r.payload.data());
      course_.AddLine(Line("received on ", r.subscription, " of ", r.unix_ns, " size ",
                           r.payload.size(), " crc ", Crc32({bytes, r.payload.size()})));
    }
  }
  void NoteGone(const char* topic) {
    EXPECT_TRUE(WaitUntil([&] { return peer_.channels.count(topic) == 0; }));
    course_.AddLine(std::string("gone ") + topic);
  }
  Peer& peer() { return peer_; }

 private:
  Course& course_;
  Peer peer_;
  // By topic: the id of the channel that was noted last.
  std::map<std::string, std::uint32_t> noted_;
};

/// Caps that the element refuses, because their fields are doubles.
constexpr const char* kCapsOfDoubles =
    "application/x-pointcloud2,fields=(string)\"x:F64:0,y:F64:8,z:F64:16\",point-step=24,height=1,"
    "width=1,is-bigendian=false,is-dense=false";

std::string CloudCapsOf(int width) {
  return "application/x-pointcloud2,fields=(string)\"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12\","
         "point-step=16,height=1,is-bigendian=false,is-dense=false,framerate=10/1,width=" +
         std::to_string(width);
}

gst::BufferPtr BytesAt(guint8 value, gsize size) {
  gst::BufferPtr buffer(gst_buffer_new_allocate(nullptr, size, nullptr));
  gst_buffer_memset(buffer.get(), 0, value, size);
  gst_lidar_buffer_set_capture_time(buffer.get(), kCapturedAt + value);
  return buffer;
}

gst::BufferPtr CloudWithPose(guint8 value, gsize size) {
  gst::BufferPtr buffer = BytesAt(value, size);
  const GstLidarPose pose{{4, 5, 6}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
  gst_lidar_buffer_set_pose(buffer.get(), &pose);
  return buffer;
}

/// The element and a viewer that is connected to it.
class WebScript {
 public:
  explicit WebScript(Course* course) : c_(*course) {
    c_.Hide("port=.uint.[1-9][0-9]*", "port");
    c_.Hide(", bytes-sent=.guint64.[0-9]+", "");  // changes after the last message has arrived
  }
  void Begin(const std::string& caps) {
    c_.Begin(caps);
    viewer_.emplace(&c_, c_.Stat("port"));
    c_.AwaitStat("clients", 1);
  }
  NotedViewer& viewer() { return *viewer_; }
  /// Pushes a buffer that causes the element to send `messages` messages.
  void Push(const char* what, gst::BufferPtr buffer, std::size_t messages = 1) {
    const GstFlowReturn flow = gst_pad_push(c_.harness()->srcpad, buffer.release());
    viewer_->NoteReceived(messages);
    c_.Note(std::string(what) + ": " + gst_flow_get_name(flow));
  }
  void Stop() {
    c_.Stop();
    EXPECT_TRUE(WaitUntil([&] { return viewer_->peer().closed(); }));
    c_.AddLine("closed for " + std::to_string(viewer_->peer().close_code()));
    viewer_.reset();
  }

 private:
  Course& c_;
  std::optional<NotedViewer> viewer_;
};

void CloudsCourse(Course& c) {
  WebScript web(&c);
  web.Begin(CloudCapsOf(4));
  c.Push("nobody wants", BytesAt(1, 64));
  web.viewer().Subscribe("/points", 42);
  web.Push("a cloud", BytesAt(2, 64));
  for (const gsize size : {63U, 0U}) web.Push("of another size", BytesAt(3, size), 0);
  c.SetCaps(CloudCapsOf(8));
  web.Push("wider", BytesAt(4, 128));
  web.Push("with a pose", CloudWithPose(5, 128));
  web.viewer().Subscribe("/pose", 43);
  web.viewer().Subscribe("/tf", 44);
  web.Push("with a pose", CloudWithPose(6, 128), 3);
  web.viewer().Unsubscribe(43);
  web.Push("without a viewer of poses", CloudWithPose(7, 128), 2);
  for (const char* text : {"{", R"({"op":"subscribe"})",
                           R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":999}]})",
                           R"({"op":"unsubscribe","subscriptionIds":[999]})"})
    web.viewer().Say(text);
  for (const char* value : {"true", "false"}) {
    c.Set("sync", value);
    gboolean sync = FALSE;
    g_object_get(GST_BIN_CHILDREN(c.element())->data, "sync", &sync, nullptr);
    c.AddLine(sync != FALSE ? "renders by the clock" : "renders at once");
  }
  c.Flush();
  web.Push("behind a flush", BytesAt(8, 128));
  c.Gap(0, GST_MSECOND);
  for (int i = 0; i < 2; ++i) c.SetCaps(kCapsOfDoubles);
  web.Push("of caps that are refused", BytesAt(9, 24), 0);
  c.SetCaps(CloudCapsOf(4));
  web.Push("of the first caps", BytesAt(10, 64));
  web.Stop();
  web.Begin(CloudCapsOf(4));
  web.viewer().Subscribe("/points", 1);
  web.Push("in a second run", CloudWithPose(11, 64));
  c.SetCaps(kCapsOfDoubles);
  c.SetCaps(CloudCapsOf(8));
  c.SetCaps(kCapsOfDoubles);
  c.End();
}

void KindsCourse(Course& c) {
  WebScript web(&c);
  web.Begin(CloudCapsOf(8));
  web.viewer().Subscribe("/front", 1);
  web.Push("a cloud that is thinned", BytesAt(1, 128));
  c.SetCaps("application/x-draco,geometry=xyz,alignment=slice,framerate=20/1");
  web.viewer().Subscribe("/front", 2);
  web.Push("of Draco", BytesAt(2, 5));
  c.SetCaps("application/x-odometry,frame-id=odom,child-frame-id=os");
  web.viewer().Subscribe("/front", 3);
  web.viewer().Subscribe("/tf", 4);
  web.Push("a pose", BytesAt(3, 64), 2);
  web.Push("that is short", BytesAt(4, 40), 0);
  for (const char* caps : {"video/x-h264,stream-format=byte-stream,alignment=au", "video/x-vp8"}) {
    c.SetCaps(caps);
    web.viewer().Subscribe("/front", 5);
    gst::BufferPtr delta = BytesAt(5, 6);
    GST_BUFFER_FLAG_SET(delta.get(), GST_BUFFER_FLAG_DELTA_UNIT);
    web.Push("no key frame", std::move(delta), 0);
    web.Push("a key frame", BytesAt(6, 7));
    delta = BytesAt(7, 8);
    GST_BUFFER_FLAG_SET(delta.get(), GST_BUFFER_FLAG_DELTA_UNIT);
    web.Push("the next one", std::move(delta));
  }
  web.viewer().NoteGone("/tf");
  web.Stop();
}

void PosesCourse(Course& c) {
  WebScript web(&c);
  web.Begin(CloudCapsOf(4));
  web.viewer().Subscribe("/pose", 1);
  web.Push("a cloud in the place of poses", CloudWithPose(1, 64));
  gst_child_proxy_set(GST_CHILD_PROXY(c.element()), "sink_0::topic", "/front", nullptr);
  c.SetCaps("application/x-draco,geometry=xyz,alignment=slice");
  web.Push("elsewhere", CloudWithPose(2, 5), 0);
  web.viewer().Subscribe("/front", 2);
  web.viewer().Subscribe("/pose", 3);
  web.viewer().Subscribe("/tf", 4);
  web.Push("with its pose", CloudWithPose(3, 5), 3);
  web.viewer().Unsubscribe(4);
  web.Push("without a viewer of transforms", CloudWithPose(4, 5), 2);
  web.Stop();
}

const std::size_t kWebCourses = AddGoldenCourses(
    "FoxgloveGoldenCourses",
    {{"clouds", "foxglovesink port=0 sync=false", CloudsCourse, {"sink_0", nullptr}},
     {"kinds",
      "foxglovesink port=0 sync=false max-points=3 sink_0::topic=/front sink_0::frame-id=front",
      KindsCourse,
      {"sink_0", nullptr}},
     {"poses",
      "foxglovesink port=0 sync=false sink_0::topic=/pose",
      PosesCourse,
      {"sink_0", nullptr}}},
    GOLDEN_COURSES_FOLDER);

}  // namespace
}  // namespace lidar::test
