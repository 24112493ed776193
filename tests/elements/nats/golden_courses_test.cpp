// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what natssink and natssrc publish, output and post in scripted runs with golden files.
#include "tests/support/golden_course.h"

#include <initializer_list>
#include <map>
#include <optional>

#include "ext/nats/jetstream.h"
#include "ext/nats/stream_format.h"
#include "gst/common/history_query.h"
#include "src/base/crc.h"
#include "tests/elements/nats/nats_client.h"
#include "tests/elements/nats/nats_pipeline.h"

namespace lidar::test {
namespace {

constexpr const char* kSampleCaps = "application/x-imu,sample-size=(int)32";
constexpr const char* kTwoPointCaps =
    "application/x-pointcloud2,width=2,height=1,point-step=12,fields=(string)\"x:F32:0,y:F32:4,"
    "z:F32:8\",is-bigendian=false,is-dense=true,frame-id=os";
constexpr GstClockTime kCaptured = 1'500'000'000 * GST_SECOND;

gst::BufferPtr Sample(guint8 value, gsize size = 32) {
  gst::BufferPtr buffer(gst_buffer_new_allocate(nullptr, size, nullptr));
  gst_buffer_memset(buffer.get(), 0, value, size);
  gst_lidar_buffer_set_capture_time(buffer.get(), kCaptured + value);
  return buffer;
}

/// Returns a sample whose buffer has all metadata and flags that a buffer may have.
gst::BufferPtr FullSample(gsize size) {
  gst::BufferPtr buffer = Sample(9, size);
  const GstLidarSlice slice{7, 1, 4, 512};
  GstLidarPose pose{{1, 2, 3}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_LOST, {}};
  gst_lidar_buffer_set_slice(buffer.get(), &slice);
  gst_lidar_buffer_set_pose(buffer.get(), &pose);
  GST_BUFFER_DURATION(buffer.get()) = 11 * GST_MSECOND;
  GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT);
  return buffer;
}

nats::StreamFormat::Ptr FormatOf(const char* text) {
  std::string why;
  const gst::CapsPtr caps(gst_caps_from_string(text));
  return nats::StreamFormat::FromCaps(caps.get(), &why);
}

/// Converts messages to text. The run numbers of a sink are random, so they are replaced by
/// letters.
class MessageTexts {
 public:
  std::string Of(natsMsg* message) {
    const auto size = static_cast<gsize>(natsMsg_GetDataLength(message));
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(natsMsg_GetData(message));
    std::string line = Line("published on ", natsMsg_GetSubject(message), " size ", size, " crc ",
                            Crc32({bytes, size}));
    for (const char* name : {"Lidar-Caps", "Lidar-Place", "Lidar-Capture-Time", "Lidar-Duration",
                             "Lidar-Slice", "Lidar-Pose", "Lidar-Discont", "Nats-Msg-Id"}) {
      const char* value = nullptr;
      if (natsMsgHeader_Get(message, name, &value) == NATS_OK)
        line += Line(", ", name + std::string(name).find('-') + 1, " ",
                     *name == 'N' || std::string(name) == "Lidar-Place" ? Place(value) : value);
    }
    return line;
  }

 private:
  std::string Place(const std::string& value) {
    const auto blank = value.find(' ');
    const auto letter = static_cast<char>('A' + runs_.size());
    return runs_.emplace(value.substr(0, blank), letter).first->second + value.substr(blank);
  }
  std::map<std::string, char> runs_;
};

/// A server, and a client that publishes and subscribes as another program would.
class Fleet {
 public:
  explicit Fleet(Course* course) : course_(*course) {
    course_.Hide("message warning No NATS server answers at nats://localhost.*", "");
    course_.Stop();  // GstHarness has already started the element if it is a sink
    server_.Start();
    g_object_set(course_.element(), "url", server_.url().c_str(), nullptr);
    // JetStream is ready a little later than its server.
    course_.Hide(
        "message warning (JetStream delivers no messages|The stream box cannot be created or "
        "updated).*",
        "");
    course_.Hide("127[.]0[.]0[.]1:[0-9]+", "the server");
    Connect();
  }
  Fleet(const Fleet&) = delete;
  Fleet& operator=(const Fleet&) = delete;

  jsCtx* js() const { return client_->js(); }
  /// Waits until the server has the element's subscription, or if `is_there` is false, until the
  /// server no longer has it.
  void AwaitSubscription(bool is_there) const {
    EXPECT_TRUE(Eventually([&] { return (server_.Subscriptions("r1.imu") > 0) == is_there; }));
  }
  /// Makes the JetStream stream "box", which stores all published messages.
  void MakeBox() const {
    std::string why;
    EXPECT_TRUE(Eventually([&] {
      return nats::EnsureStream(js(), {"box", Duration::zero(), 0, 1, ""},
                                {"r1.imu", "r1.imu.config.*"}, &why);
    })) << why;
  }
  /// Kills the server, and waits until the element has posted that the server is gone.
  void Kill() {
    messages_.reset();
    client_.reset();
    server_.Kill();
    course_.AwaitStat("connected", 0);
    EXPECT_TRUE(Eventually([&] { return course_.trace()->Count("message nats-conn") > 0; }));
    course_.Await("no server", "message warning No NATS");
  }
  /// Restarts the server, and waits until each of the element's `statistics` has the value
  /// `wanted`.
  void Restart(std::initializer_list<const char*> statistics, guint64 wanted) {
    server_.Restart();
    course_.AwaitStat("connected", 1);
    for (const char* statistic : statistics) course_.AwaitStat(statistic, wanted);
    course_.Await("a server again", "message nats-connection-changed");
    Connect();
  }
  void AwaitAcknowledged(const char* durable) const {
    EXPECT_TRUE(Eventually([&] {
      jsConsumerInfo* found = nullptr;
      if (js_GetConsumerInfo(&found, js(), "box", durable, nullptr, nullptr) != NATS_OK)
        return false;
      const nats::ConsumerInfoPtr info(found);
      return info->NumPending == 0 && info->NumAckPending == 0;
    }));
  }
  void Publish(const char* subject, const std::string& bytes,
               const std::vector<std::pair<const char*, std::string>>& headers = {}) const {
    natsMsg* raw = nullptr;
    natsMsg_Create(&raw, subject, nullptr, bytes.data(), static_cast<int>(bytes.size()));
    const nats::MessagePtr message(raw);
    for (const auto& [name, value] : headers) natsMsgHeader_Set(raw, name, value.c_str());
    EXPECT_EQ(natsConnection_PublishMsg(client_->get(), raw), NATS_OK);
    natsConnection_FlushTimeout(client_->get(), NatsClient::kPatienceMs);
  }
  void PublishCaps(const nats::StreamFormat& format) const {
    Publish(("r1.imu.config." + format.id()).c_str(), format.text());
  }
  void PublishSample(const nats::StreamFormat& format, const std::string& place,
                     std::size_t size = 32, const char* more = nullptr,
                     const char* value = "") const {
    std::vector<std::pair<const char*, std::string>> headers = {{"Lidar-Caps", format.id()},
                                                                {"Lidar-Place", place}};
    if (more != nullptr) headers.emplace_back(more, value);
    Publish("r1.imu", std::string(size, static_cast<char>(place.back())), headers);
  }
  /// Notes all messages up to and including the next sample, but skips caps that were published
  /// before.
  void NotePublished() {
    for (bool is_caps = true; is_caps;) {
      const nats::MessagePtr message = Next();
      if (!message) return;
      const std::string subject = natsMsg_GetSubject(message.get());
      is_caps = subject != "r1.imu";
      if (is_caps && std::exchange(last_caps_, subject) == subject) continue;
      course_.AddLine(texts_.Of(message.get()));
    }
  }
  /// Requests the caps, as a natssrc without the caps does, and notes the answer.
  void Ask() {
    natsConnection_Publish(client_->get(), "r1.imu.get-config", nullptr, 0);
    for (const char* begin : {"r1.imu.get-config", "r1.imu.config."})
      while (const nats::MessagePtr message = Next())
        if (std::string(natsMsg_GetSubject(message.get())).rfind(begin, 0) == 0) break;
    course_.AddLine("asked for " + last_caps_);
  }

 private:
  void Connect() {
    messages_.reset();
    client_.emplace(server_.url());
    messages_ = client_->Subscribe("r1.>");
  }
  nats::MessagePtr Next() {
    natsMsg* raw = nullptr;
    EXPECT_EQ(natsSubscription_NextMsg(&raw, messages_.get(), NatsClient::kPatienceMs), NATS_OK);
    return nats::MessagePtr(raw);
  }

  Course& course_;
  NatsServer server_;
  std::optional<NatsClient> client_;
  nats::SubscriptionPtr messages_;
  MessageTexts texts_;
  std::string last_caps_;
};

/// A natssink, and a script of samples that are pushed to it.
class SinkScript {
 public:
  SinkScript(Course* course, Fleet* fleet) : c_(*course), fleet_(*fleet) {}

  /// Starts the element, and sends the first events of the stream once the element is connected.
  void Begin(const char* caps) {
    sent_ = 0;
    gst_element_set_state(c_.element(), GST_STATE_PLAYING);
    c_.AwaitStat("connected", 1);
    c_.Begin(caps);
  }
  void Push(const char* what, gst::BufferPtr buffer) {
    EXPECT_EQ(gst_pad_push(c_.harness()->srcpad, buffer.release()), GST_FLOW_OK) << what;
    fleet_.NotePublished();
    c_.AwaitStat("messages", ++sent_);
    c_.AwaitStat("messages-waiting", 0);
    c_.Note(what);
  }
  void PushOfAnotherSize() {
    for (const gsize size : {0U, 33U}) c_.Push("of another size", Sample(1, size));
  }
  void PushTooLarge() {
    constexpr gsize kMost = 1'048'576;  // maximum size of a message with its headers
    EXPECT_EQ(gst_pad_push(c_.harness()->srcpad, Sample(1, kMost).release()), GST_FLOW_OK);
    c_.AwaitStat("messages-too-large", 1);
    c_.Await("too large", "message warning A buffer is larger");
  }

 private:
  Course& c_;
  Fleet& fleet_;
  guint64 sent_ = 0;
};

void SinkCourse(Course& c) {
  Fleet fleet(&c);
  SinkScript sink(&c, &fleet);
  sink.Begin(kSampleCaps);
  sink.Push("a sample", Sample(1));
  sink.Push("of all kinds", FullSample(32));
  sink.Push("three in one", Sample(2, 96));
  fleet.Ask();
  sink.PushOfAnotherSize();
  c.SetCaps(kTwoPointCaps);
  sink.Push("a cloud", Sample(3, 24));
  c.Push("two clouds", Sample(1, 48));
  for (int i = 0; i < 2; ++i) c.SetCaps("text/x-raw,format=utf8");
  c.Push("refused", Sample(1));
  c.SetCaps(kSampleCaps);
  sink.Push("of the first caps", Sample(4));
  c.Flush();
  sink.Push("behind a flush", Sample(5));
  c.Gap(0, GST_MSECOND);
  sink.PushTooLarge();
  sink.Push("behind it", Sample(7));
  c.End();
  c.Stop();
  c.Set("buffer-size", "65536");
  sink.Begin(kSampleCaps);
  sink.Push("in a second run", Sample(8));
  sink.PushOfAnotherSize();
  for (const char* caps :
       {"text/x-raw,format=utf8", kTwoPointCaps, "text/x-raw,format=utf8", kSampleCaps})
    c.SetCaps(caps);
  fleet.Kill();
  for (int i = 0; i < 3; ++i) c.Push("that waits", Sample(1, 32'000));
  c.Set("drain-timeout", "1");
  c.End();
  c.Stop();
  c.Begin(kSampleCaps);
  c.Push("that waits for nobody", Sample(1));
  c.End();
}

/// Notes the properties of the stream "box" and all messages in it.
void NoteBox(Course& c, const Fleet& fleet, guint64 messages) {
  jsStreamInfo* found = nullptr;
  ASSERT_EQ(js_GetStreamInfo(&found, fleet.js(), "box", nullptr, nullptr), NATS_OK);
  const nats::StreamInfoPtr info(found);
  c.AddLine(Line("box for ", info->Config->MaxAge, " of ", info->Config->MaxBytes, " on ",
                 info->Config->Subjects[0], " and ", info->Config->SubjectsLen - 1, " more"));
  natsSubscription* raw = nullptr;
  jsSubOptions options;
  jsSubOptions_Init(&options);
  options.Config.DeliverPolicy = js_DeliverAll;
  ASSERT_EQ(js_SubscribeSync(&raw, fleet.js(), "r1.imu", nullptr, &options, nullptr), NATS_OK);
  const nats::SubscriptionPtr kept(raw);
  MessageTexts texts;
  for (guint64 i = 0; i < messages; ++i) {
    natsMsg* message = nullptr;
    ASSERT_EQ(natsSubscription_NextMsg(&message, raw, NatsClient::kPatienceMs), NATS_OK);
    const nats::MessagePtr owner(message);
    c.AddLine(texts.Of(message));
  }
}

void KeptSinkCourse(Course& c) {
  Fleet fleet(&c);
  SinkScript sink(&c, &fleet);
  sink.Begin(kSampleCaps);
  sink.Push("a sample", Sample(1));
  sink.PushTooLarge();
  sink.Push("behind it", Sample(2));
  c.SetCaps(kTwoPointCaps);
  sink.Push("a cloud", FullSample(24));
  fleet.Kill();
  for (guint8 i = 4; i < 6; ++i) c.Push("that waits", Sample(i, 24));
  // An acknowledgement may arrive before the message is counted, so the test waits for both
  // counters.
  fleet.Restart({"messages-acknowledged", "messages"}, 5);
  c.End();
  c.Stop();
  sink.Begin(kSampleCaps);
  sink.Push("in a second run", Sample(6));
  c.End();
  NoteBox(c, fleet, 6);
}

/// A natssrc, and a client that publishes messages for it as another program would.
class SourceScript {
 public:
  SourceScript(Course* course, Fleet* fleet) : c_(*course), fleet_(*fleet) {}

  void Play(const char* what) {
    fleet_.AwaitSubscription(false);  // waits until the previous run's subscription is gone
    gst_element_set_state(c_.element(), GST_STATE_PLAYING);
    c_.AwaitStat("connected", 1);
    fleet_.AwaitSubscription(true);
    c_.Note(what);
    damaged_ = 0;
  }
  void Give(const char* what, const char* place, std::size_t size = 32, const char* more = nullptr,
            const char* value = "") {
    fleet_.PublishSample(*format_, place, size, more, value);
    c_.Await(what, "buffer");
  }
  /// Publishes a message that the source drops. The golden file shows this only together with the
  /// next message that the source outputs.
  void GiveDamaged(const char* place, std::size_t size, const char* more = nullptr,
                   const char* value = "") {
    fleet_.PublishSample(*format_, place, size, more, value);
    c_.AwaitStat("messages-damaged", ++damaged_);
  }
  void GiveAgain(const char* what, const char* place, guint64 again) {
    fleet_.PublishSample(*format_, place);
    c_.AwaitStat("messages-again", again);
    c_.Note(what);
  }
  void SetFormat(nats::StreamFormat::Ptr format) {
    format_ = std::move(format);
    fleet_.PublishCaps(*format_);
  }

 private:
  Course& c_;
  Fleet& fleet_;
  nats::StreamFormat::Ptr format_;
  guint64 damaged_ = 0;
};

void SourceCourse(Course& c) {
  Fleet fleet(&c);
  SourceScript source(&c, &fleet);
  c.Ask();
  source.Play("play");
  source.SetFormat(FormatOf(kSampleCaps));
  source.Give("a sample", "1 0");
  source.Give("captured", "1 1", 32, "Lidar-Capture-Time", "1500000000000000001");
  source.Give("three in one", "1 2", 96, "Lidar-Duration", "11000000");
  source.Give("marked", "1 3", 32, "Lidar-Discont", "1");
  source.Give("of a slice", "1 4", 32, "Lidar-Slice", "7 1 4 512");
  source.Give("of a run that begins late", "2 5");
  source.Give("behind a gap", "2 9");
  source.Give("that fills it", "2 7");
  source.GiveAgain("again", "2 9", 1);
  source.GiveDamaged("2 10", 33);
  source.Give("behind a damaged one", "2 10");
  source.GiveDamaged("2", 32);
  source.GiveDamaged("2 11", 32, "Lidar-Slice", "7 4 4 512");
  source.Give("behind two of them", "2 11");
  fleet.Publish("r1.imu.config.0123456789abcdef", "text/x-raw");
  c.AwaitStat("formats-damaged", 1);
  source.SetFormat(FormatOf(kTwoPointCaps));
  source.Give("a cloud", "2 12", 24);
  fleet.PublishSample(*FormatOf("application/x-odometry,frame-id=odom,child-frame-id=os"), "2 13");
  c.AwaitStat("messages-without-caps", 1);
  source.Give("behind one without caps", "2 14", 24);
  c.Ask();
  source.GiveDamaged("2 15", 33);
  c.Await("damaged at the end", "message warning A message");
  fleet.Kill();
  fleet.Restart({"reconnects"}, 1);
  c.Send("end", gst_event_new_eos(), "event eos");
  c.Stop();
  source.Play("play again");
  source.SetFormat(FormatOf(kSampleCaps));
  source.GiveDamaged("2 9", 33);
  source.Give("behind a damaged one", "2 9");
  source.Give("in a second run", "2 11");
  c.Stop();
  c.Set("subject", "r1..imu");
  gst_element_set_state(c.element(), GST_STATE_PLAYING);
  c.Note("of a subject that is none");
}

/// Sends a history query to a source and notes the answer.
void NotePast(Course& c, const gst::HistoryQuestion& question) {
  const gst::PadPtr src(gst_pad_get_peer(c.harness()->sinkpad));
  const gst::HistoryAnswer answer = AskForPast(src.get(), question);
  std::string line =
      Line("past from ", answer.from, " to ", answer.to, ", then ", answer.position,
           answer.ended ? " at the end" : "", ", damaged ", answer.damaged, ", buffers");
  for (const gst::SamplePtr& sample : answer.samples)
    line += Line(" ", GST_BUFFER_OFFSET(gst_sample_get_buffer(sample.get())));
  c.AddLine(line);
}

void KeptSourceCourse(Course& c) {
  Fleet fleet(&c);
  c.Hide("buffer at [1-9][0-9]*", "buffer at a later time");
  const auto format = FormatOf(kSampleCaps);
  fleet.MakeBox();
  fleet.PublishCaps(*format);
  for (const char* place : {"1 0", "1 1", "1 4", "1 3", "1 4"})
    fleet.PublishSample(*format, place, 32, "Lidar-Capture-Time", "1500000000000000001");
  fleet.PublishSample(*format, "1 5", 33);
  fleet.PublishSample(*format, "1 6", 32, "Lidar-Capture-Time", "1500000000000000006");
  c.Set("start-time", "0");
  c.Set("eos-at-end", "true");
  c.Ask();
  c.Play("all of it", "event eos");
  NotePast(c, {kCaptured, 0, 1});
  NotePast(c, {GST_CLOCK_TIME_NONE, 3, 1'000'000});
  NotePast(c, {GST_CLOCK_TIME_NONE, 9, 1'000'000});
  NotePast(c, {0, 0, 0});
  c.Stop();
  c.Set("start-sequence", "4");
  c.Play("from a number on", "event eos");
  c.Stop();
  c.Set("eos-at-end", "false");
  c.Play("that goes on", "buffer", 3);
  fleet.Kill();
  fleet.Restart({"reconnects"}, 1);
  fleet.PublishSample(*format, "1 9");
  c.Await("behind a restart of the server", "buffer");
  c.Stop();
  c.Set("durable", "slam");
  c.Play("a durable consumer", "buffer", 4);
  fleet.AwaitAcknowledged("slam");
  c.Stop();
  fleet.PublishSample(*format, "1 10");
  c.Play("that goes on", "buffer");
}

const std::size_t kNatsCourses =
    NatsServer::Program().empty()
        ? 0
        : AddGoldenCourses(
              "NatsGoldenCourses",
              {{"sink", "natssink sync=false subject=r1.imu", SinkCourse, {"sink", nullptr}},
               {"kept_sink",
                "natssink sync=false subject=r1.imu jetstream=box",
                KeptSinkCourse,
                {"sink", nullptr}},
               {"src", "natssrc subject=r1.imu", SourceCourse, {nullptr, "src"}},
               {"kept_src",
                "natssrc subject=r1.imu jetstream=box",
                KeptSourceCourse,
                {nullptr, "src"}}},
              GOLDEN_COURSES_FOLDER);

}  // namespace
}  // namespace lidar::test
