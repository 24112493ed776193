// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the statistics and warnings of natssink and natssrc. The counts are exact, each fault
// causes one warning, and each run begins with new counts.
#include <gst/check/gstharness.h>

#include <algorithm>
#include <set>
#include <thread>

#include "ext/nats/stream_format.h"
#include "gst/common/history_query.h"
#include "tests/elements/nats/nats_pipeline.h"
#include "tests/elements/nats/nats_stranger.h"
#include "tests/support/harness.h"

namespace lidar::test {
namespace {

constexpr const char* kImuCaps = "application/x-imu, sample-size=(int)32";
const std::string kImuBox = "subject=r1.imu jetstream=box";

std::string StatsText(GstElement* element) {
  const gst::StringPtr text(gst_structure_to_string(StatsOf(element).get()));
  return text.get();
}

/// A natssink to which the test pushes IMU samples.
class Feeder {
 public:
  explicit Feeder(const std::string& properties)
      : sink_(gst_parse_launch(("natssink sync=false" + kPatientDrain + properties).c_str(),
                               nullptr)) {
    h_.reset(gst_harness_new_with_element(sink_.get(), "sink", nullptr));
    gst_harness_set_src_caps_str(h_.get(), kImuCaps);
  }
  void Push(gsize bytes, GstClockTime captured = GST_CLOCK_TIME_NONE) {
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, bytes, nullptr);
    if (GST_CLOCK_TIME_IS_VALID(captured)) gst_lidar_buffer_set_capture_time(buffer, captured);
    EXPECT_EQ(gst_harness_push(h_.get(), buffer), GST_FLOW_OK);
  }
  /// Sends EOS. Returns once the server has all messages, or after drain-timeout.
  void End() { gst_harness_push_event(h_.get(), gst_event_new_eos()); }
  void Stop() { gst_element_set_state(sink_.get(), GST_STATE_NULL); }
  void PlayAgain() {
    gst_pad_set_active(h_->srcpad, FALSE);
    gst_pad_set_active(h_->srcpad, TRUE);
    gst_element_set_state(sink_.get(), GST_STATE_PLAYING);
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("again"));
    gst_harness_set_src_caps_str(h_.get(), kImuCaps);
  }
  guint64 stat(const char* name) const { return StatOf(sink_.get(), name); }
  std::string stats() const { return StatsText(sink_.get()); }
  /// Returns the number of warnings since the last call whose text contains `part`. Ignores
  /// requests that the server did not answer in time, which may occur on a busy machine.
  std::size_t Warnings(const std::string& part) {
    auto texts = bus_.Texts(GST_MESSAGE_WARNING);
    texts.erase(std::remove_if(texts.begin(), texts.end(),
                               [](const auto& text) { return CountWith(": Timeout", {text}) > 0; }),
                texts.end());
    return CountWith(part, texts);
  }

 private:
  gst::ElementPtr sink_;
  const ElementBus bus_{sink_.get()};
  Harness h_;
};

class NatsRuns : public NatsTest {
 protected:
  void SetUp() override {
    NatsTest::SetUp();
    if (IsSkipped()) return;
    server_.Start();
    std::string why;
    const gst::CapsPtr caps(gst_caps_from_string(kImuCaps));
    imu_ = nats::StreamFormat::FromCaps(caps.get(), &why);
    ASSERT_TRUE(imu_) << why;
  }
  /// Publishes a message that looks like one of natssink. `place` is its run and its number in the
  /// run.
  void Publish(Stranger* stranger, const char* subject, const std::string& place,
               std::size_t bytes = 32) const {
    stranger->Publish(subject, std::string(bytes, 'x'),
                      {{"Lidar-Caps", imu_->id()}, {"Lidar-Place", place}});
  }
  void PublishCaps(Stranger* stranger, const std::string& subject) const {
    stranger->Publish((subject + ".config." + imu_->id()).c_str(), imu_->text());
  }

  nats::StreamFormat::Ptr imu_;
};

TEST_F(NatsRuns, OfASinkCountAlikeAndItsCountsStayAfterTheStop) {
  for (const std::string& where : {At("subject=r1.imu"), At(kImuBox)}) {
    Feeder sink(where);
    std::set<std::string> seen;
    for (int run = 0; run < 2; ++run) {
      for (const gsize bytes : {64U, 33U, 96U, 0U, 32U}) sink.Push(bytes);
      sink.End();
      EXPECT_EQ(sink.stat("messages"), 3U);
      EXPECT_EQ(sink.stat("bytes"), 192U);
      EXPECT_EQ(sink.stat("buffers-refused"), 2U);
      EXPECT_EQ(sink.stat("messages-acknowledged"), where == At(kImuBox) ? 3U : 0U);
      EXPECT_EQ(sink.Warnings("A buffer does not match its caps"), 1U);
      seen.insert(sink.stats());
      sink.Stop();
      EXPECT_EQ(sink.stat("messages"), 3U);
      EXPECT_EQ(sink.stat("bytes"), 192U);
      sink.PlayAgain();
      EXPECT_EQ(sink.stat("messages") + sink.stat("bytes") + sink.stat("buffers-refused"), 0U);
    }
    EXPECT_EQ(seen.size(), 1U) << *seen.begin() << "\n" << *seen.rbegin();
  }
}

/// Returns the number of messages with the subject `counted` before the first message with the
/// subject `last`.
int CountBefore(const std::string& last, natsSubscription* all, const std::string& counted) {
  for (int count = 0;;) {
    natsMsg* raw = nullptr;
    if (natsSubscription_NextMsg(&raw, all, NatsClient::kPatienceMs) != NATS_OK) {
      ADD_FAILURE() << "no message " << last;
      return count;
    }
    const nats::MessagePtr message(raw);
    const std::string subject = natsMsg_GetSubject(raw);
    if (subject == last) return count;
    count += subject == counted ? 1 : 0;
  }
}

TEST_F(NatsRuns, CapsComeAgainBeforeASmallBoxDropsThem) {
  const NatsClient client(server_.url());
  const auto all = client.Subscribe("r1.>");
  Feeder sink(At(kImuBox + " max-bytes=40000"));
  // Each sample is a little larger than a quarter of max-bytes.
  for (int i = 0; i < 20; ++i) sink.Push(10'016);
  sink.End();
  natsConnection_PublishString(client.get(), "r1.end", "");
  EXPECT_GE(CountBefore("r1.end", all.get(), "r1.imu.config." + imu_->id()), 20);
}

TEST_F(NatsRuns, WhatJetStreamHasNotAcknowledgedWaits) {
  Feeder sink(At(kImuBox));
  sink.Push(32);
  ASSERT_TRUE(Eventually([&] { return sink.stat("messages-acknowledged") == 1; }));
  EXPECT_EQ(sink.stat("messages-waiting"), 0U);
  EXPECT_EQ(sink.stat("bytes-waiting"), 0U);
  server_.Freeze();
  for (int i = 0; i < 3; ++i) sink.Push(32);
  ASSERT_TRUE(Eventually([&] { return sink.stat("messages") == 4; }));
  EXPECT_EQ(sink.stat("messages-waiting"), 3U);
  EXPECT_GE(sink.stat("bytes-waiting"), 96U);
  EXPECT_EQ(sink.stat("messages-acknowledged"), 1U);
  server_.Thaw();
  EXPECT_TRUE(Eventually([&] { return sink.stat("messages-acknowledged") == 4; }));
  EXPECT_EQ(sink.stat("messages-waiting"), 0U);
}

TEST_F(NatsRuns, AStopDoesNotWaitForTheEnd) {
  server_.Kill();
  Feeder sink(At());
  sink.Push(32);
  const gint64 begin = g_get_monotonic_time();
  std::thread end([&] { sink.End(); });
  g_usleep(50'000);
  sink.Stop();
  end.join();
  EXPECT_LT(g_get_monotonic_time() - begin, 30 * G_USEC_PER_SEC);
  EXPECT_EQ(sink.stat("messages-dropped"), 1U);
}

TEST_F(NatsRuns, TheBoxIsAsThePropertiesSayAlsoWhereItWasMadeBefore) {
  constexpr std::int64_t kSecond = 1'000'000'000, kUsual = 120 * kSecond;
  struct Box {
    const char* properties;
    std::int64_t age, bytes, duplicates;
  };
  const NatsClient client(server_.url());
  for (const Box& want :
       {Box{"", 3600 * kSecond, std::int64_t{4} << 30, kUsual},
        Box{" max-age=1000000000", kSecond, std::int64_t{4} << 30, kSecond},
        Box{" max-age=0 max-bytes=0", 0, -1, kUsual},
        Box{" max-age=500000000000 max-bytes=70000", 500 * kSecond, 70'000, kUsual}}) {
    Feeder sink(At(kImuBox + want.properties));
    sink.Push(32);
    sink.End();
    EXPECT_EQ(sink.Warnings("cannot be created or updated"), 0U) << want.properties;
    jsStreamInfo* found = nullptr;
    ASSERT_EQ(js_GetStreamInfo(&found, client.js(), "box", nullptr, nullptr), NATS_OK);
    const nats::StreamInfoPtr info(found);
    EXPECT_EQ(info->Config->MaxAge, want.age) << want.properties;
    EXPECT_EQ(info->Config->MaxBytes, want.bytes) << want.properties;
    EXPECT_EQ(info->Config->Duplicates, want.duplicates) << want.properties;
    EXPECT_EQ(info->Config->Replicas, 1);
    EXPECT_EQ(info->Config->Storage, js_FileStorage);
  }
  // Replicas are impossible, because there is only one server.
  Feeder copied(At("subject=r2.imu jetstream=copied replicas=3 drain-timeout=0"));
  copied.Push(32);
  EXPECT_TRUE(Eventually(
      [&] { return copied.Warnings("The stream copied cannot be created or updated") > 0; }));
}

TEST_F(NatsRuns, ASinkTellsOnceOfBuffersThatAreTooLargeUntilOneIsTaken) {
  std::ofstream(server_.folder() + "/conf") << "max_payload: 1024\n";
  server_.Start({"-c", server_.folder() + "/conf"});
  for (const std::string& where : {At("subject=r1.imu"), At(kImuBox)}) {
    Feeder sink(where);
    for (std::size_t round = 1; round <= 2; ++round) {
      for (int i = 0; i < 2; ++i) sink.Push(2'048);
      ASSERT_TRUE(Eventually([&] { return sink.stat("messages-too-large") == 2 * round; }));
      sink.Push(32);
      ASSERT_TRUE(Eventually(
          [&] { return sink.stat("messages") == round && sink.stat("messages-waiting") == 0; }));
      EXPECT_EQ(sink.Warnings("max_payload"), 1U) << round;
    }
  }
}

TEST_F(NatsRuns, OfAReplayAreAlike) {
  const std::string box = "subject=r1.front jetstream=box";
  const auto sent = PublishSlices(8, At(box));
  Stranger stranger(server_.url());
  stranger.Publish("r1.front", "no natssink's");
  stranger.Flush();
  PublishSlices(8, At(box));
  NatsPipeline player("natssrc name=n eos-at-end=true start-time=0" + At(box) +
                      "! fakesink name=see sync=false");
  std::vector<std::string> stats;
  for (int run = 0; run < 2; ++run) {
    player.Play();
    EXPECT_NE(player.WaitForWarning("A message is damaged or not from natssink"), "") << run;
    EXPECT_EQ(player.WaitForEnd(), "");
    stats.push_back(StatsText(player.nats()));
    player.Stop();
  }
  EXPECT_EQ(stats[0], stats[1]);
  EXPECT_EQ(player.stat("messages"), 16U);
  EXPECT_EQ(player.stat("messages-damaged"), 1U);
  EXPECT_EQ(player.stat("connected"), 0U);
  const auto played = player.buffers();
  ASSERT_EQ(played.size(), 32U);
  EXPECT_EQ(played[0].pts, 0U);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_TRUE(played[i].SameAs(played[16 + i])) << i;
    EXPECT_EQ(played[i].pts, played[16 + i].pts) << i;
  }
}

TEST_F(NatsRuns, WhatTheStreamNumbersHasItsNumberAndAGapIsMarked) {
  const gst::ElementPtr source(
      gst_parse_launch(("natssrc eos-at-end=true start-time=0" + At(kImuBox)).c_str(), nullptr));
  {
    Feeder sink(At(kImuBox));
    sink.Push(32);
    sink.End();
  }
  Stranger stranger(server_.url());
  for (const char* place : {"7 0", "7 1", "7 5", "7 4", "7 4", "7 6"})
    Publish(&stranger, "r1.imu", place);
  stranger.Flush();
  const NatsClient client(server_.url());
  std::vector<std::uint64_t> numbers;
  ASSERT_TRUE(Eventually([&] {
    numbers = client.NumbersOf("box", "r1.imu");
    return numbers.size() == 7;
  }));
  const Harness h(gst_harness_new_with_element(source.get(), nullptr, "src"));
  SetPlaying(h.get());
  const struct {
    std::size_t message;
    bool discont;
  } wanted[] = {{0, false}, {1, false}, {2, false}, {3, true}, {4, false}, {6, false}};
  for (const auto& want : wanted) {
    const gst::BufferPtr buffer(gst_harness_pull(h.get()));
    ASSERT_TRUE(buffer);
    EXPECT_EQ(GST_BUFFER_OFFSET(buffer.get()), numbers[want.message]);
    if (want.message == 0) continue;  // the first buffer of the run may have the flag
    EXPECT_EQ(GST_BUFFER_FLAG_IS_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT), want.discont)
        << want.message;
  }
  EXPECT_EQ(StatOf(source.get(), "messages-lost"), 2U) << "numbers 2 and 3";
  EXPECT_EQ(StatOf(source.get(), "messages-late"), 1U);
  EXPECT_EQ(StatOf(source.get(), "messages-again"), 1U);
  EXPECT_EQ(StatOf(source.get(), "bytes"), 6 * 32U);
}

TEST_F(NatsRuns, DamageIsToldOfAgainAfterAGoodMessageAndAcknowledged) {
  const std::string box = "subject=r1.front jetstream=box";
  PublishSlices(1, At(box));
  const DurableConsumer consumer(server_.url(), kPatience_ns, 100);  // sends no message twice
  NatsPipeline receiver("natssrc name=n durable=slam start-time=0" + At(box) +
                        "! fakesink name=see sync=false");
  receiver.Play();
  Stranger stranger(server_.url());
  for (std::size_t round = 1; round <= 2; ++round) {
    for (int i = 0; i < 3; ++i) stranger.Publish("r1.front", "no natssink's");
    stranger.Flush();
    PublishSlices(1, At(box));
    ASSERT_TRUE(receiver.WaitForBuffers(1 + round));
    EXPECT_EQ(receiver.stat("messages-damaged"), 3 * round);
    EXPECT_EQ(receiver.Warnings("A message is damaged or not from natssink"), 1U) << round;
  }
  EXPECT_TRUE(Eventually([&] { return consumer.open() <= 1; }));  // the last one is downstream
}

TEST_F(NatsRuns, WhatWaitsForASourceIsBoundedByItsBufferSize) {
  constexpr int kMessages = 200;
  for (const bool is_small : {true, false}) {
    NatsPipeline receiver(
        "natssrc name=n buffer-size=" + std::string(is_small ? "65536" : "1000000") +
        At("subject=r1.imu") + "! fakesink name=see sync=false");
    receiver.Hold(true);
    receiver.Play();
    Stranger stranger(server_.url());
    ASSERT_TRUE(Eventually([&] {
      PublishCaps(&stranger, "r1.imu");
      Publish(&stranger, "r1.imu", "1 0");
      stranger.Flush();
      return receiver.count() > 0;
    }));
    std::uint64_t published = 0;
    const auto flood = [&](const std::string& run) {
      for (int i = 1; i <= kMessages; ++i)
        Publish(&stranger, "r1.imu", run + " " + std::to_string(i), 1'024);
      stranger.Flush();
      published += kMessages;
    };
    flood("2");
    receiver.Hold(false);
    const auto of_flood = [&] { return receiver.count() + receiver.stat("messages-again"); };
    if (is_small) {
      std::uint64_t overruns = 0, marker = 0;
      for (const char* run : {"3", "4", "5"}) {
        EXPECT_TRUE(Eventually([&] { return receiver.stat("messages-overrun") > overruns; }));
        overruns = receiver.stat("messages-overrun");
        receiver.Hold(true);
        ASSERT_TRUE(Eventually([&] {
          Publish(&stranger, "r1.imu", "9 " + std::to_string(++marker));
          stranger.Flush();
          return receiver.holds();
        }));
        flood(run);
        receiver.Hold(false);
      }
      EXPECT_TRUE(Eventually([&] { return receiver.stat("messages-overrun") > overruns; }));
      EXPECT_LE(receiver.stat("messages-overrun"), published) << "counted once";
    } else {
      EXPECT_TRUE(Eventually([&] { return of_flood() >= kMessages; }));
      EXPECT_EQ(receiver.stat("messages-overrun"), 0U);
    }
  }
}

TEST_F(NatsRuns, AServerThatGoesIsToldOfEachTime) {
  NatsPipeline receiver("natssrc name=n" + At("subject=r1.imu") + "! fakesink name=see sync=false");
  receiver.Play();
  for (unsigned round = 0; round < 2; ++round) {
    ASSERT_TRUE(Eventually([&] { return receiver.stat("connected") == 1; }));
    EXPECT_EQ(receiver.stat("reconnects"), round);
    server_.Kill();
    EXPECT_NE(receiver.WaitForWarning("No NATS server answers at "), "") << round;
    EXPECT_EQ(receiver.stat("connected"), 0U);
    server_.Restart();
  }
}

/// Returns the first answer of a natssrc to a history query.
gst::HistoryAnswer Past(const std::string& where, const gst::HistoryQuestion& question) {
  NatsPipeline receiver("natssrc name=n" + where + "! fakesink name=see");
  receiver.Play();
  const gst::PadPtr pad(gst_element_get_static_pad(receiver.nats(), "src"));
  return AskForPast(pad.get(), question);
}

TEST_F(NatsRuns, ThePastCountsWhatIsDamaged) {
  const std::string box = "subject=r1.front jetstream=box";
  PublishSlices(4, At(box));
  Stranger stranger(server_.url());
  stranger.Publish("r1.front", "no natssink's");
  Publish(&stranger, "r1.front", "7 0");  // these caps were never published
  stranger.Flush();
  const gst::HistoryAnswer answer = Past(At("subject=r1.front"), {0, 0, 1'000'000});
  EXPECT_TRUE(answer.ended);
  EXPECT_EQ(answer.samples.size(), 4U);
  EXPECT_EQ(answer.damaged, 2U);
}

TEST_F(NatsRuns, ThePastIsFoundByTheClockOfARobotThatIsAhead) {
  const auto captured = static_cast<GstClockTime>(g_get_real_time()) * 1'000 + 3'600 * GST_SECOND;
  Feeder sink(At(kImuBox));
  sink.Push(32, captured);
  sink.End();
  EXPECT_EQ(Past(At("subject=r1.imu"), {captured, 0, 1'000'000}).samples.size(), 1U);
}

TEST_F(NatsRuns, ThePastOfARobotThatPutItsClockBackDoesNotEndBeforeItBegins) {
  const auto captured = static_cast<GstClockTime>(g_get_real_time()) * 1'000;
  Feeder sink(At(kImuBox));
  sink.Push(32, captured);
  sink.Push(32, captured - 60 * GST_SECOND);
  sink.End();
  const gst::HistoryAnswer past = Past(At("subject=r1.imu"), {});
  EXPECT_EQ(past.from, captured);
  EXPECT_EQ(past.to, captured);
}

TEST(NatsSource, AnswersWhatGStreamerAsks) {
  const gst::ElementPtr source(gst_element_factory_make("natssrc", nullptr));
  const gst::PadPtr pad(gst_element_get_static_pad(source.get(), "src"));
  const gst::QueryPtr caps(gst_query_new_caps(nullptr));
  EXPECT_TRUE(gst_pad_query(pad.get(), caps.get()));
}

}  // namespace
}  // namespace lidar::test
