// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of streams that JetStream stores: replays, durable consumers, and servers that are killed.
#include "ext/nats/jetstream.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>

#include "ext/nats/message.h"
#include "ext/nats/stream_format.h"
#include "ext/nats/subscriber.h"
#include "gst/common/history_query.h"
#include "gst/lidar/gstlidar.h"
#include "tests/elements/nats/nats_client.h"
#include "tests/elements/nats/nats_pipeline.h"

namespace lidar::test {
namespace {

const std::string kBox = "subject=r1.front jetstream=box";

class NatsJetStream : public NatsTest {
 protected:
  void SetUp() override {
    NatsTest::SetUp();
    if (!IsSkipped()) server_.Start();
  }
  /// Replays the stored stream from the time `start` on, and returns the buffers.
  std::vector<Kept> Replay(guint64 start, const std::string& more = "") {
    NatsPipeline player("natssrc name=n eos-at-end=true start-time=" + std::to_string(start) +
                        At(kBox + " " + more) + "! fakesink name=see sync=false");
    player.Play();
    EXPECT_EQ(player.WaitForEnd(), "");
    caps_ = player.caps();
    EXPECT_EQ(player.stat("messages-without-caps"), 0U);
    EXPECT_EQ(player.stat("messages-lost"), 0U);
    return player.buffers();
  }

  std::string caps_;  // of the stream that Replay() read last
};

/// Sends history queries to the source `n` until it has answered with everything up to the end.
/// Each answer has at most `question.most_bytes` bytes.
std::vector<Kept> AskForHistory(const NatsPipeline& receiver, gst::HistoryQuestion question,
                                gst::HistoryAnswer* last) {
  const gst::PadPtr pad(gst_element_get_static_pad(receiver.nats(), "src"));
  std::vector<Kept> out;
  do {
    *last = AskForPast(pad.get(), question);
    for (const gst::SamplePtr& sample : last->samples)
      out.push_back(Keep(gst_sample_get_buffer(sample.get())));
    question.time = GST_CLOCK_TIME_NONE;
    question.position = last->position;
  } while (!last->ended && question.most_bytes > 0);
  return out;
}

/// Blocks the buffers of `receiver` until the server sends unacknowledged messages a second time,
/// then unblocks the buffers. Returns true if `receiver` then acknowledges all messages.
bool TakesAllAfterItWasSentAgain(const DurableConsumer& consumer, NatsPipeline* receiver) {
  receiver->Hold(true);
  receiver->Play();
  const bool sent_again = Eventually([&] { return consumer.again() > 0; });
  receiver->Hold(false);
  return sent_again && Eventually([&] { return consumer.open() == 0; });
}

/// Publishes caps that are unique for each `number`, and a message with these caps.
void PutInOwnCaps(const NatsClient& client, int number) {
  const gst::CapsPtr caps(gst_caps_from_string(
      (GST_LIDAR_IMU_MEDIA_TYPE ", sample-size=(int)32, number=(int)" + std::to_string(number))
          .c_str()));
  std::string why;
  const auto format = nats::StreamFormat::FromCaps(caps.get(), &why);
  ASSERT_TRUE(format) << why;
  const std::string& text = format->text();
  EXPECT_EQ(js_Publish(nullptr, client.js(), nats::ConfigSubject("r1.front", format->id()).c_str(),
                       text.data(), static_cast<int>(text.size()), nullptr, nullptr),
            NATS_OK);
  const gst::BufferPtr buffer(gst_buffer_new_allocate(nullptr, 32, nullptr));
  const auto message = nats::WriteMessage("r1.front", nullptr, format->id(),
                                          {1, static_cast<std::uint64_t>(number)}, buffer.get());
  EXPECT_EQ(js_PublishMsg(nullptr, client.js(), message.get(), nullptr, nullptr), NATS_OK);
}

TEST_F(NatsJetStream, ABlackBoxIsReplayedWhole) {
  const auto sent = PublishSlices(80, At(kBox));
  const auto played = Replay(0);
  ExpectSameStream(played, sent);
  ASSERT_FALSE(played.empty());
  EXPECT_EQ(played.front().pts, 0U);
  for (std::size_t i = 1; i < played.size(); ++i) EXPECT_GE(played[i].pts, played[i - 1].pts);
  EXPECT_NE(caps_.find("application/x-lidar-slice"), caps_.npos);
}

TEST_F(NatsJetStream, AReplayBeginsAtItsTime) {
  const auto first = PublishSlices(40, At(kBox));
  const guint64 between = static_cast<guint64>(g_get_real_time()) * 1000;
  const auto second = PublishSlices(24, At(kBox));
  ExpectSameStream(Replay(between), second);
  EXPECT_EQ(Replay(0).size(), 64U);
  EXPECT_EQ(Replay(between + 3600 * GST_SECOND).size(), 0U);
}

TEST_F(NatsJetStream, AReplayBeginsEarlyInASecondAsWell) {
  const auto first = PublishSlices(8, At(kBox));
  const auto now = [] { return static_cast<guint64>(g_get_real_time()) * 1000; };
  ASSERT_TRUE(Eventually([&] { return now() % GST_SECOND < 40 * GST_MSECOND; }));
  const guint64 between = now();
  const auto second = PublishSlices(8, At(kBox));
  const auto played = Replay(between);
  ExpectSameStream(played, second);
}

/// Returns the time at which the server stored the last message of r1.front [ns since 1970].
guint64 LastStored(const NatsClient& client) {
  natsMsg* raw = nullptr;
  EXPECT_EQ(js_GetLastMsg(&raw, client.js(), "box", "r1.front", nullptr, nullptr), NATS_OK);
  const nats::MessagePtr message(raw);
  return message ? static_cast<guint64>(natsMsg_GetTime(raw)) : 0;
}

/// If a time is early in its second, libnats asks for all messages from the start of that second
/// on. Therefore natssrc itself drops the messages before the time.
TEST_F(NatsJetStream, AReplayEndsWhereAllMessagesAreBeforeItsTime) {
  const NatsClient client(server_.url());
  std::string why;
  ASSERT_TRUE(nats::EnsureStream(client.js(), {"box", {}, 0, 1, ""},
                                 {"r1.front", "r1.front.config.*"}, &why))
      << why;
  guint64 last = 0;
  ASSERT_TRUE(Eventually([&] {
    const guint64 now = static_cast<guint64>(g_get_real_time()) * 1000;
    if (now % GST_SECOND > 40 * GST_MSECOND) return false;
    PutInOwnCaps(client, 0);
    last = LastStored(client);
    return last % GST_SECOND < 90 * GST_MSECOND;
  }));
  EXPECT_EQ(Replay(last + 1).size(), 0U);
}

TEST_F(NatsJetStream, AReplayBeginsAtItsNumber) {
  const auto sent = PublishSlices(16, At(kBox));
  const auto numbers = NatsClient(server_.url()).NumbersOf("box", "r1.front");
  ASSERT_EQ(numbers.size(), 16U);
  const std::string begin = "start-sequence=" + std::to_string(numbers[4]);
  ExpectSameStream(Replay(0, begin), {sent.begin() + 4, sent.end()});
  EXPECT_EQ(Replay(0, "start-sequence=900").size(), 0U);
  const auto later = static_cast<guint64>(g_get_real_time()) * 1000 + 3600 * GST_SECOND;
  ExpectSameStream(Replay(later, begin), {sent.begin() + 4, sent.end()});
}

/// Publishes `count` messages, each with its own caps.
void FillWithOwnCaps(const NatsServer& server, int count) {
  const NatsClient client(server.url());
  std::string why;
  ASSERT_TRUE(nats::EnsureStream(client.js(), {"box", {}, 0, 1, ""},
                                 {"r1.front", "r1.front.config.*"}, &why))
      << why;
  for (int i = 0; i < count; ++i) PutInOwnCaps(client, i);
}

constexpr int kManyFormats = 20;  // more formats than a source stores

TEST_F(NatsJetStream, AStreamOfManyFormatsIsReplayedWhole) {
  FillWithOwnCaps(server_, kManyFormats);
  EXPECT_EQ(Replay(0).size(), std::size_t{kManyFormats});
}

TEST_F(NatsJetStream, AMessageOfUnknownCapsWaitsForAServerThatIsAway) {
  FillWithOwnCaps(server_, kManyFormats);
  NatsPipeline receiver("natssrc name=n start-time=0" + At(kBox) +
                        "! fakesink name=see sync=false");
  receiver.Hold(true);
  receiver.Play();
  ASSERT_TRUE(receiver.WaitForBuffers(1));
  server_.Kill();
  receiver.Hold(false);
  ASSERT_NE(receiver.WaitForWarning("No NATS server answers"), "");
  server_.Restart();
  EXPECT_TRUE(receiver.WaitForBuffers(kManyFormats));
  EXPECT_EQ(receiver.stat("messages-without-caps"), 0U);
}

TEST_F(NatsJetStream, NothingIsLostWhereTheServerIsKilledMeanwhile) {
  NatsPipeline sender(kLive + "! lidarenc" + kSee + "! natssink name=n " + kPatientDrain +
                      At(kBox));
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-acknowledged") >= 20; }));
  NatsPipeline receiver("natssrc name=n start-time=0" + At(kBox) +
                        "! fakesink name=see sync=false");
  receiver.Play();
  ASSERT_TRUE(receiver.WaitForBuffers(20));
  server_.Kill();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-waiting") >= 20; }));
  server_.Restart();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-waiting") <= 4; }));
  sender.SendEos();
  EXPECT_EQ(sender.WaitForEnd(), "");
  const auto sent = sender.buffers();
  EXPECT_EQ(sender.stat("messages-dropped"), 0U);
  EXPECT_EQ(sender.stat("messages-acknowledged"), sent.size());
  ASSERT_TRUE(receiver.WaitForBuffers(sent.size()));
  ExpectSameStream(receiver.buffers(), sent);
  EXPECT_EQ(receiver.stat("messages-lost"), 0U);
  ExpectSameStream(Replay(0), sent);
}

/// The sink waits five seconds for an acknowledgement. During this time it sends messages and caps
/// until 256 of them are unacknowledged, which takes three seconds here.
TEST_F(NatsJetStream, GoesOnWhereCapsWereNeverAnswered) {
  NatsPipeline sender(kLive + "! lidarenc" + kSee + "! natssink name=n" + At(kBox));
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-acknowledged") >= 20; }));
  server_.Freeze();
  const gint64 late = g_get_monotonic_time() + 10 * G_USEC_PER_SEC;
  ASSERT_TRUE(Eventually([&] { return g_get_monotonic_time() > late; }));
  server_.Kill();  // the server also loses the messages that it stored last
  server_.Restart();
  const guint64 before = sender.stat("messages-acknowledged");
  EXPECT_TRUE(Eventually([&] { return sender.stat("messages-acknowledged") >= before + 100; }));
}

TEST_F(NatsJetStream, ADurableConsumerGoesOnWhereTheLastOneEnded) {
  const auto sent = PublishSlices(64, At(kBox));
  std::vector<Kept> all;
  {
    NatsPipeline first("natssrc name=n durable=slam start-time=0 num-buffers=30" + At(kBox) +
                       "! fakesink name=see sync=false");
    first.Play();
    EXPECT_EQ(first.WaitForEnd(), "");
    all = first.buffers();
  }
  NatsPipeline second("natssrc name=n durable=slam" + At(kBox) + "! fakesink name=see sync=false");
  second.Play();
  // The server sends messages again if the first natssrc received them but did not acknowledge
  // them.
  const auto has_all = [&] {
    auto seen = all;
    for (const Kept& kept : second.buffers()) seen.push_back(kept);
    return std::all_of(sent.begin(), sent.end(), [&](const Kept& want) {
      return std::any_of(seen.begin(), seen.end(), [&](const Kept& k) { return k.SameAs(want); });
    });
  };
  EXPECT_TRUE(Eventually(has_all));
  EXPECT_LE(second.count(), 64U - 28U);
}

/// Reads all messages that the durable consumer "slam" has not acknowledged, until the end of the
/// stream.
std::vector<Kept> TakeRest(const std::string& at) {
  NatsPipeline rest("natssrc name=n durable=slam start-time=0 eos-at-end=true" + at +
                    "! fakesink name=see sync=false");
  rest.Play();
  EXPECT_EQ(rest.WaitForEnd(), "");
  return rest.buffers();
}

TEST_F(NatsJetStream, ADurableConsumerBeginsAtTheTimeAndNumberThatItWasMadeWith) {
  PublishSlices(8, At(kBox));
  guint64 between = 0;
  // Waits, because early in a second libnats would ask for messages from the start of that second
  // on.
  ASSERT_TRUE(Eventually([&] {
    between = static_cast<guint64>(g_get_real_time()) * 1000;
    return between % GST_SECOND > 100 * GST_MSECOND;
  }));
  const auto second = PublishSlices(8, At(kBox));
  const auto takes = [&](const std::string& more) {
    NatsPipeline source("natssrc name=n eos-at-end=true" + At(kBox + " " + more) +
                        "! fakesink name=see sync=false");
    source.Play();
    EXPECT_EQ(source.WaitForEnd(), "");
    return source.buffers();
  };
  ExpectSameStream(takes("durable=slam start-time=" + std::to_string(between)), second);
  const auto numbers = NatsClient(server_.url()).NumbersOf("box", "r1.front");
  ASSERT_EQ(numbers.size(), 16U);
  ExpectSameStream(takes("durable=other start-sequence=" + std::to_string(numbers[10])),
                   {second.begin() + 2, second.end()});
}

TEST_F(NatsJetStream, ADurableConsumerThatHasHadAllEndsAtOnce) {
  const auto sent = PublishSlices(8, At(kBox));
  ExpectSameStream(TakeRest(At(kBox)), sent);
  EXPECT_EQ(TakeRest(At(kBox)).size(), 0U);
}

TEST_F(NatsJetStream, ADurableConsumerEndsAfterAllThatAnotherDidNotAcknowledge) {
  PublishSlices(8, At(kBox));
  const DurableConsumer consumer(server_.url(), 200'000'000, 100);
  {
    const NatsClient other(server_.url());
    const auto subscription = other.Subscribe("slam-delivery");
    ASSERT_TRUE(Eventually([&] { return consumer.unacknowledged() == 8; }));
  }
  EXPECT_EQ(TakeRest(At(kBox)).size(), 8U);
  EXPECT_EQ(consumer.open(), 0U);
}

TEST_F(NatsJetStream, AMessageThatAStopCutsOffAtItsCapsComesAgain) {
  PublishSlices(1, At(kBox));
  const DurableConsumer consumer(server_.url(), 200'000'000, 100);
  const std::string source =
      "natssrc name=n durable=slam" + At(kBox) + "! fakesink name=see sync=false";
  std::atomic<bool> asked{false};
  const auto wait_for_stop = [](GstPad* pad, GstPadProbeInfo* info, gpointer data) {
    if (GST_QUERY_TYPE(GST_PAD_PROBE_INFO_QUERY(info)) == GST_QUERY_ACCEPT_CAPS) {
      *static_cast<std::atomic<bool>*>(data) = true;
      EXPECT_TRUE(Eventually([&] { return GST_PAD_IS_FLUSHING(pad); }));
    }
    return GST_PAD_PROBE_OK;
  };
  {
    NatsPipeline first(source);
    const gst::PadPtr pad(gst_element_get_static_pad(first.nats(), "src"));
    gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM, wait_for_stop, &asked,
                      nullptr);
    first.Play();
    ASSERT_TRUE(Eventually([&] { return asked.load(); }));
  }
  NatsPipeline second(source);
  second.Play();
  EXPECT_TRUE(second.WaitForBuffers(1));
}

TEST_F(NatsJetStream, WhatADurableConsumerSendsAgainIsTakenOnce) {
  const auto sent = PublishSlices(40, At(kBox));
  const DurableConsumer consumer(server_.url(), 200'000'000, 100);
  NatsPipeline receiver("natssrc name=n durable=slam" + At(kBox) +
                        "! fakesink name=see sync=false");
  ASSERT_TRUE(TakesAllAfterItWasSentAgain(consumer, &receiver));
  ExpectSameStream(receiver.buffers(), sent);
  EXPECT_TRUE(Eventually([&] { return receiver.stat("messages-again") > 0; }));
  EXPECT_EQ(receiver.stat("messages-lost"), 0U);
}

TEST_F(NatsJetStream, WhatWaitsForADurableConsumerIsBoundedAndNothingIsLost) {
  constexpr int kCount = 600;
  PublishSlices(kCount, At(kBox));
  const DurableConsumer consumer(server_.url(), 1'000'000'000, 10'000);
  NatsPipeline receiver("natssrc name=n durable=slam" + At(kBox) +
                        "! fakesink name=see sync=false");
  ASSERT_TRUE(TakesAllAfterItWasSentAgain(consumer, &receiver));
  EXPECT_EQ(receiver.count(), std::size_t{kCount});
  EXPECT_GT(receiver.stat("messages-overrun"), 0U);
  EXPECT_EQ(receiver.stat("messages-lost"), 0U);
}

TEST_F(NatsJetStream, OfTwoWithOneDurableConsumerTheSecondWaitsForTheFirst) {
  PublishSlices(8, At(kBox));
  auto first = std::make_unique<NatsPipeline>("natssrc name=n durable=slam start-time=0" +
                                              At(kBox) + "! fakesink name=see sync=false");
  first->Play();
  ASSERT_TRUE(first->WaitForBuffers(8));
  NatsPipeline second("natssrc name=n durable=slam" + At(kBox) + "! fakesink name=see sync=false");
  second.Play();
  EXPECT_NE(second.WaitForWarning("JetStream delivers no messages"), "");
  first.reset();
  PublishSlices(8, At(kBox));
  EXPECT_TRUE(second.WaitForBuffers(8));
}

TEST_F(NatsJetStream, WorkersOfAGroupShareADurableConsumer) {
  const std::string source = "natssrc name=n durable=work queue-group=work start-time=0" +
                             At(kBox) + "! fakesink name=see sync=false";
  PublishSlices(8, At(kBox));
  NatsPipeline a(source);
  NatsPipeline b(source);
  a.Play();
  ASSERT_TRUE(a.WaitForBuffers(8));
  b.Play();
  ASSERT_TRUE(Eventually([&] { return b.stat("connected") == 1; }));
  // The second natssrc receives some of the messages once the server has its subscription.
  ASSERT_TRUE(Eventually([&] {
    PublishSlices(8, At(kBox));
    return b.count() > 0;
  }));
}

TEST_F(NatsJetStream, AReplayEndsWhereTheServerDropsTheRestMeanwhile) {
  PublishSlices(8, At(kBox));
  nats::SubscriberSettings settings;
  settings.connection.url = server_.url();
  settings.subject = "r1.front";
  settings.stream = "box";
  settings.start_time = 0;
  settings.seeks_end = true;
  std::string why;
  const auto subscriber = nats::Subscriber::Open(settings, nullptr, &why);
  ASSERT_TRUE(subscriber) << why;
  nats::Delivery delivery;
  const auto gives = [&](nats::Subscriber::Event event) {
    return Eventually(
        [&] { return subscriber->Next(std::chrono::milliseconds(10), &delivery) == event; });
  };
  ASSERT_TRUE(gives(nats::Subscriber::Event::kMessage));
  ASSERT_EQ(delivery.to_come, 7U);
  server_.Kill();
  server_.Restart();
  ASSERT_TRUE(Eventually([&] { return subscriber->connection().connections == 2; }));
  const NatsClient client(server_.url());
  ASSERT_EQ(js_PurgeStream(client.js(), "box", nullptr, nullptr), NATS_OK);
  EXPECT_TRUE(gives(nats::Subscriber::Event::kEmpty));
}

TEST_F(NatsJetStream, ASourceBeginsAnotherStreamOfTheSameNameAtItsFirstMessage) {
  PublishSlices(80, At(kBox));
  NatsPipeline receiver("natssrc name=n start-time=0" + At(kBox) +
                        "! fakesink name=see sync=false");
  receiver.Play();
  ASSERT_TRUE(receiver.WaitForBuffers(80));
  const NatsClient client(server_.url());
  ASSERT_EQ(js_DeleteStream(client.js(), "box", nullptr, nullptr), NATS_OK);
  const auto sent = PublishSlices(8, At(kBox));
  ASSERT_TRUE(receiver.WaitForBuffers(88));
  const auto got = receiver.buffers();
  ExpectSameStream({got.begin() + 80, got.end()}, sent);
}

TEST_F(NatsJetStream, ASourceThatIsNotToldOfItsStreamAsksAgain) {
  const auto start = [this](const std::string& denied) {
    std::ofstream(server_.folder() + "/conf")
        << "authorization { users = [ { user: edge, password: pw }, { user: viewer, password: pw, "
           "permissions: { publish: { deny: "
        << denied << " } } } ] }";
    server_.Start({"-c", server_.folder() + "/conf"});
  };
  start("none");
  const std::string edge = "url=" + server_.url("nats", "edge:pw@") + " " + kBox;
  PublishSlices(16, edge);
  NatsPipeline receiver("natssrc name=n start-time=0 url=" + server_.url("nats", "viewer:pw@") +
                        " " + kBox + " ! fakesink name=see sync=false");
  receiver.Play();
  ASSERT_TRUE(receiver.WaitForBuffers(16));
  start("\"$JS.API.STREAM.INFO.box\"");  // such a request gets no answer
  const NatsClient client(server_.url("nats", "edge:pw@"));
  ASSERT_EQ(js_DeleteStream(client.js(), "box", nullptr, nullptr), NATS_OK);
  const auto sent = PublishSlices(8, edge);
  ASSERT_TRUE(Eventually([&] { return server_.Logged("STREAM.INFO.box") >= 2; }));
  EXPECT_NE(receiver.WaitForWarning("JetStream delivers no messages"), "");
  start("none");
  ASSERT_TRUE(receiver.WaitForBuffers(24));
  const auto got = receiver.buffers();
  ExpectSameStream({got.begin() + 16, got.end()}, sent);
}

/// Replaces the source's own consumer by another one. The new consumer begins with the next message
/// and counts its messages from 1.
void ReplaceConsumer(const NatsClient& client) {
  jsConsumerInfoList* raw = nullptr;
  ASSERT_EQ(js_Consumers(&raw, client.js(), "box", nullptr, nullptr), NATS_OK);
  const std::unique_ptr<jsConsumerInfoList, decltype(&jsConsumerInfoList_Destroy)> list(
      raw, jsConsumerInfoList_Destroy);
  const auto end = list->List + list->Count;
  const auto found = std::find_if(list->List, end, [](const jsConsumerInfo* info) {
    return info->PushBound && info->Config->FilterSubject == std::string("r1.front");
  });
  ASSERT_NE(found, end);
  const jsConsumerInfo& info = **found;
  ASSERT_EQ(js_DeleteConsumer(client.js(), "box", info.Name, nullptr, nullptr), NATS_OK);
  jsConsumerConfig config;
  jsConsumerConfig_Init(&config);
  config.DeliverSubject = info.Config->DeliverSubject;
  config.DeliverPolicy = js_DeliverNew;
  config.FilterSubject = "r1.front";
  config.AckPolicy = js_AckNone;
  config.FlowControl = true;
  config.Heartbeat = info.Config->Heartbeat;
  EXPECT_EQ(js_AddConsumer(nullptr, client.js(), "box", &config, nullptr, nullptr), NATS_OK);
}

TEST_F(NatsJetStream, MessagesOutOfOrderAreReadAgain) {
  PublishSlices(8, At(kBox));
  NatsPipeline receiver("natssrc name=n start-time=0" + At(kBox) +
                        "! fakesink name=see sync=false");
  receiver.Play();
  ASSERT_TRUE(receiver.WaitForBuffers(8));
  const NatsClient client(server_.url());
  std::vector<Kept> sent;
  for (int round = 0; round < 2; ++round) {
    ReplaceConsumer(client);
    const auto more = PublishSlices(4, At(kBox));
    sent.insert(sent.end(), more.begin(), more.end());
    ASSERT_TRUE(receiver.WaitForBuffers(8 + sent.size()));
  }
  const auto got = receiver.buffers();
  ExpectSameStream({got.begin() + 8, got.end()}, sent);
  EXPECT_EQ(receiver.stat("messages-lost"), 0U);
  EXPECT_EQ(receiver.stat("messages-again"), 0U);
  EXPECT_EQ(receiver.stat("reconnects"), 0U);
}

TEST_F(NatsJetStream, ASinkWhoseStreamIsDeletedSaysSoAndMakesItAnew) {
  NatsPipeline sender(kLive + "! lidarenc" + kSee + "! natssink name=n " + kPatientDrain +
                      At(kBox));
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-acknowledged") >= 20; }));
  const NatsClient client(server_.url());
  ASSERT_EQ(js_DeleteStream(client.js(), "box", nullptr, nullptr), NATS_OK);
  EXPECT_EQ(sender.WaitForWarning("JetStream"),
            "No JetStream stream keeps the subject; until this is solved, messages wait or are "
            "dropped and counted.");
  const guint64 before = sender.stat("messages-acknowledged");
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-acknowledged") >= before + 20; }));
  sender.SendEos();
  EXPECT_EQ(sender.WaitForEnd(), "");
  const auto sent = sender.buffers();
  EXPECT_EQ(sender.stat("messages-acknowledged"), sent.size());
  EXPECT_EQ(sender.stat("messages-dropped"), 0U);
  const auto kept = Replay(0);
  ASSERT_GE(kept.size(), 20U);
  ASSERT_LT(kept.size(), sent.size());
  ExpectSameStream(kept, {sent.end() - static_cast<std::ptrdiff_t>(kept.size()), sent.end()});
}

/// Makes the stream "box". The stream refuses messages larger than `most` bytes.
void MakeBoxForSmallMessages(const std::string& url, std::int32_t most) {
  const NatsClient client(url);
  const char* subjects[] = {"r1.front", "r1.front.config.*"};
  jsStreamConfig config;
  jsStreamConfig_Init(&config);
  config.Name = "box";
  config.Subjects = subjects;
  config.SubjectsLen = 2;
  config.MaxMsgSize = most;
  EXPECT_TRUE(Eventually(
      [&] { return js_AddStream(nullptr, client.js(), &config, nullptr, nullptr) == NATS_OK; }));
}

TEST_F(NatsJetStream, MessagesThatAreTooLargeForTheStreamDelayNoOthers) {
  MakeBoxForSmallMessages(server_.url(), 10'000);
  NatsPipeline sender("concat name=c" + kSee + "! natssink name=n sync=false" + kPatientDrain +
                      At(kBox) + kQuick + "num-buffers=8 ! c. " + kQuick +
                      "num-buffers=8 ! lidarenc ! c.");
  sender.Play();
  EXPECT_NE(sender.WaitForWarning("A message is larger than the stream allows (max_msg_size)"), "");
  EXPECT_EQ(sender.WaitForEnd(), "");
  EXPECT_EQ(sender.stat("messages-too-large"), 8U);
  EXPECT_EQ(sender.stat("messages-acknowledged"), 8U);
  EXPECT_EQ(sender.stat("messages-waiting"), 0U);
}

TEST_F(NatsJetStream, AStreamThatTakesNoMessageEndsWithAnError) {
  MakeBoxForSmallMessages(server_.url(), 100);
  NatsPipeline sender(kQuick + "num-buffers=8 ! lidarenc" + kSee + "! natssink name=n sync=false" +
                      kPatientDrain + At(kBox));
  sender.Play();
  EXPECT_NE(sender.WaitForWarning("The caps are larger than the stream allows (max_msg_size)"), "");
  EXPECT_EQ(sender.WaitForEnd(),
            "None of 8 messages reached the NATS server: they exceed its max_payload, the stream's "
            "max_msg_size, or buffer-size.");
  EXPECT_EQ(sender.stat("messages-too-large"), 8U);
}

TEST_F(NatsJetStream, TheOldestGoesWhereTheBoxIsFull) {
  const auto sent = PublishSlices(80, At(kBox + " max-bytes=50000"));
  const auto played = Replay(0);
  ASSERT_FALSE(played.empty());
  ASSERT_LT(played.size(), sent.size());
  ExpectSameStream(played, {sent.end() - static_cast<std::ptrdiff_t>(played.size()), sent.end()});
}

TEST_F(NatsJetStream, SeveralStreamsShareABox) {
  const auto front = PublishSlices(16, At("subject=r1.front jetstream=box"));
  PublishSlices(24, At("subject=r1.rear jetstream=box"));
  ExpectSameStream(Replay(0), front);
}

TEST_F(NatsJetStream, ManyThatBeginAtOnceShareABox) {
  std::vector<std::unique_ptr<NatsPipeline>> senders;
  for (int i = 0; i < 6; ++i) {
    senders.push_back(std::make_unique<NatsPipeline>(
        kQuick + "num-buffers=16 ! lidarenc" + kSee + "! natssink name=n sync=false " +
        kPatientDrain + " jetstream=box" + At("subject=r" + std::to_string(i) + ".front")));
    senders.back()->Play();
  }
  for (const auto& sender : senders) {
    EXPECT_EQ(sender->WaitForEnd(), "");
    EXPECT_EQ(sender->stat("messages-acknowledged"), 16U);
    EXPECT_EQ(sender->stat("messages-dropped"), 0U);
  }
  // Two sinks may add their subjects to the stream at the same time, and one may remove the subject
  // that the other has just added. The stream then refuses messages of that other sink. The sink
  // sends them again, after later messages.
  std::vector<Kept> played = Replay(0);
  std::stable_sort(played.begin(), played.end(), [](const Kept& a, const Kept& b) {
    return std::pair(a.slice.scan_id, a.slice.slice_index) <
           std::pair(b.slice.scan_id, b.slice.slice_index);
  });
  ExpectSameStream(played, senders[1]->buffers());
}

TEST_F(NatsJetStream, SinksThatNameAllSubjectsFindTheStreamAsTheyWantIt) {
  const std::string all = " jetstream=box jetstream-subjects=r1.> ";
  const auto front = PublishSlices(16, At("subject=r1.front" + all));
  const auto rear = PublishSlices(8, At("subject=r1.rear" + all));
  ExpectSameStream(Replay(0), front);
  const NatsClient client(server_.url());
  jsStreamInfo* info = nullptr;
  ASSERT_EQ(js_GetStreamInfo(&info, client.js(), "box", nullptr, nullptr), NATS_OK);
  ASSERT_EQ(info->Config->SubjectsLen, 1);
  EXPECT_STREQ(info->Config->Subjects[0], "r1.>");
  jsStreamInfo_Destroy(info);
}

TEST_F(NatsJetStream, AStreamThatAnswersForTheServerIsToldOf) {
  const NatsClient client(server_.url());
  std::string why;
  const bool made = nats::EnsureStream(client.js(), {"all", {}, 0, 1, ""}, {"*.>"}, &why);
  // Newer servers refuse such a stream.
  EXPECT_TRUE(made || why.find("no-ack") != std::string::npos) << why;
  // The server and the stream both answer the request. EnsureStream() reads only the first answer,
  // so several tries may be needed.
  bool told = !made;
  for (int i = 0; i < 500 && !told; ++i)
    told = !nats::EnsureStream(client.js(), {"all", {}, 0, 1, ""}, {"*.>"}, &why);
  EXPECT_TRUE(told);
  EXPECT_NE(why, "");
}

TEST_F(NatsJetStream, AStreamThatCannotBeMadeIsToldOfWithTheReasonAndItsNumber) {
  PublishSlices(1, At(kBox));
  NatsPipeline sender(kLive + "! lidarenc" + kSee +
                      "! natssink name=n subject=r1.front jetstream=other" + At());
  sender.Play();
  const std::string warning = sender.WaitForWarning("overlap");
  EXPECT_EQ(warning.rfind("The stream other cannot be created or updated: ", 0), 0U) << warning;
  EXPECT_NE(warning.find(" (10065); until this is solved"), warning.npos) << warning;
}

TEST_F(NatsJetStream, AServerWithoutJetStreamIsToldOf) {
  NatsServer plain;
  std::ofstream(plain.folder() + "/conf") << "jetstream: disabled\n";
  plain.Start({"-c", plain.folder() + "/conf", "-js=false"});
  NatsPipeline sender(kLive + "! lidarenc" + kSee +
                      "! natssink name=n jetstream=box url=" + plain.url());
  NatsPipeline receiver("natssrc name=n jetstream=box url=" + plain.url() + " ! fakesink name=see");
  sender.Play();
  receiver.Play();
  std::string of_sender = sender.WaitForWarning("has no JetStream");
  std::string of_receiver = receiver.WaitForWarning("has no JetStream");
  EXPECT_EQ(of_sender,
            "The stream box cannot be created or updated: the server has no JetStream; until this "
            "is solved, messages wait or are dropped and counted.");
  EXPECT_EQ(of_receiver,
            "JetStream delivers no messages: the server has no JetStream; natssrc keeps trying.");
  // Both elements try again twice a second, and these messages take two seconds.
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-waiting") >= 160; }));
  // A request that is not answered in time is another problem.
  for (const auto& [end, last] :
       {std::pair(&sender, &of_sender), std::pair(&receiver, &of_receiver)})
    for (const std::string& text : end->WarningTexts())
      EXPECT_NE(std::exchange(*last, text), text) << "said again";
}

TEST_F(NatsJetStream, TellsALiveStreamsPastPieceByPiece) {
  const auto sent = PublishSlices(300, At(kBox));
  NatsPipeline receiver("natssrc name=n" + At("subject=r1.front") + "! fakesink name=see");
  receiver.Play();
  gst::HistoryAnswer last;
  const auto all = AskForHistory(receiver, {0, 0, 100'000}, &last);
  ExpectSameStream(all, sent);
  EXPECT_EQ(last.from, sent.front().capture_time);
  EXPECT_EQ(last.to, sent.back().capture_time);
  EXPECT_EQ(last.damaged, 0U);
  // The source may ask the server for messages from the start of a second on. Therefore the first
  // slice may be up to a second earlier than `half`.
  const GstClockTime half = sent[150].capture_time;
  const auto later = AskForHistory(receiver, {half, 0, 100'000}, &last);
  ASSERT_FALSE(later.empty());
  EXPECT_LE(later.front().capture_time, half);
  EXPECT_EQ(later.back().capture_time, sent.back().capture_time);
  EXPECT_TRUE(AskForHistory(receiver, {GST_CLOCK_TIME_NONE, last.position, 1'000}, &last).empty());
  EXPECT_TRUE(last.ended);
}

/// These are the permissions that docs/fleet.md lists.
TEST_F(NatsJetStream, AReceiverNeedsTheRightsOfItsStreamAlone) {
  std::ofstream(server_.folder() + "/conf") << R"(authorization { users = [
    { user: edge, password: pw },
    { user: viewer, password: pw, permissions: {
        publish: ["r1.front.get-config", "$JS.API.STREAM.NAMES", "$JS.API.STREAM.INFO.box",
                  "$JS.API.STREAM.MSG.GET.box", "$JS.API.CONSUMER.CREATE.box",
                  "$JS.API.CONSUMER.*.box.>", "$JS.API.CONSUMER.MSG.NEXT.box.>"],
        subscribe: ["r1.front", "r1.front.config.*", "_INBOX.>"] } }] })";
  server_.Start({"-c", server_.folder() + "/conf"});
  const auto sent = PublishSlices(64, "url=" + server_.url("nats", "edge:pw@") + " " + kBox);
  const std::string viewer = "natssrc name=n url=" + server_.url("nats", "viewer:pw@");
  NatsPipeline player(viewer + " start-time=0 eos-at-end=true " + kBox +
                      " ! fakesink name=see sync=false");
  player.Play();
  EXPECT_EQ(player.WaitForEnd(), "");
  ExpectSameStream(player.buffers(), sent);
  NatsPipeline live(viewer + " subject=r1.front ! fakesink name=see");
  live.Play();
  gst::HistoryAnswer last;
  ExpectSameStream(AskForHistory(live, {0, 0, 100'000}, &last), sent);
  player.Stop();
  live.Stop();
  EXPECT_EQ(server_.Logged("Violation"), 0U);
}

TEST_F(NatsJetStream, ThePastDoesNotEndWhereTheServerDoesNotAnswer) {
  const auto sent = PublishSlices(64, At(kBox));
  NatsPipeline receiver("natssrc name=n" + At("subject=r1.front") + "! fakesink name=see");
  receiver.Play();
  gst::HistoryAnswer last;
  ExpectSameStream(AskForHistory(receiver, {0, 0, 100'000}, &last), sent);
  const gst::PadPtr pad(gst_element_get_static_pad(receiver.nats(), "src"));
  const gst::QueryPtr query = gst::NewHistoryQuery({0, 0, 100'000});
  server_.Freeze();
  ASSERT_TRUE(gst_pad_query(pad.get(), query.get()));
  EXPECT_TRUE(gst::ParseHistoryAnswer(query.get()).unanswered);
  server_.Thaw();
  ExpectSameStream(AskForHistory(receiver, {0, 0, 100'000}, &last), sent);
}

TEST_F(NatsJetStream, HasNoPastOfAStreamThatItDoesNotKeep) {
  PublishSlices(8, At(kBox));
  NatsPipeline receiver("natssrc name=n" + At("subject=r2.front") + "! fakesink name=see");
  receiver.Play();
  const gst::PadPtr pad(gst_element_get_static_pad(receiver.nats(), "src"));
  const gst::QueryPtr query = gst::NewHistoryQuery({});
  EXPECT_FALSE(gst_pad_query(pad.get(), query.get()));
  server_.Kill();
  EXPECT_FALSE(gst_pad_query(pad.get(), query.get()));
}

}  // namespace
}  // namespace lidar::test
