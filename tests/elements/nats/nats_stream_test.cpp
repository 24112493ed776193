// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of natssink and natssrc that run at the same time: buffers that enter natssink come out of
// natssrc.
#include <atomic>
#include <thread>

#include "ext/nats/subscriber.h"
#include "tests/elements/nats/nats_client.h"
#include "tests/elements/nats/nats_pipeline.h"

namespace lidar::test {
namespace {

class NatsStream : public NatsTest {
 protected:
  void SetUp() override {
    NatsTest::SetUp();
    if (!IsSkipped()) server_.Start();
  }
};

TEST_F(NatsStream, SlicesComeBackByteForByte) {
  NatsPipeline receiver("natssrc name=n" + At("subject=r1.front") +
                        "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  NatsPipeline sender(kQuick + "num-buffers=80 ! lidarenc" + kSee + "! natssink name=n sync=false" +
                      kPatientDrain + At("subject=r1.front"));
  sender.Play();
  EXPECT_EQ(sender.WaitForEnd(), "");
  ASSERT_TRUE(receiver.WaitForBuffers(80));
  ExpectSameStream(receiver.buffers(), sender.buffers());
  EXPECT_EQ(receiver.caps(), sender.caps());
  EXPECT_EQ(receiver.stat("messages-lost"), 0U);
  EXPECT_EQ(receiver.stat("messages-without-caps"), 0U);
  EXPECT_EQ(sender.stat("messages"), 80U);
  EXPECT_EQ(sender.stat("messages-waiting"), 0U);
  guint64 bytes = 0;
  for (const auto& buffer : sender.buffers()) bytes += buffer.bytes.size();
  EXPECT_EQ(sender.stat("bytes"), bytes);
  for (const NatsPipeline* end : {&sender, &receiver}) EXPECT_EQ(end->stat("reconnects"), 0U);
}

TEST_F(NatsStream, CloudsComeBackByteForByte) {
  NatsPipeline receiver("natssrc name=n" + At() + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  NatsPipeline sender(kQuick + "num-buffers=16" + kSee + "! natssink name=n sync=false" +
                      kPatientDrain + At());
  sender.Play();
  EXPECT_EQ(sender.WaitForEnd(), "");
  ASSERT_TRUE(receiver.WaitForBuffers(16));
  ExpectSameStream(receiver.buffers(), sender.buffers());
  EXPECT_EQ(receiver.caps(), sender.caps());
}

TEST_F(NatsStream, ALateJoinerHasItsCapsWithTheFirstMessage) {
  NatsPipeline sender(kLive + "! lidarenc" + kSee + "! natssink name=n" + At());
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages") >= 10; }));
  sender.Hold(true);
  ASSERT_TRUE(Eventually([&] { return sender.holds() && sender.stat("messages-waiting") == 0; }));
  const NatsClient other(server_.url());
  const auto configs = other.Subscribe("lidar.config.*");
  NatsPipeline receiver("natssrc name=n" + At() + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  natsMsg* config = nullptr;  // the sender's answer to the receiver
  ASSERT_EQ(natsSubscription_NextMsg(&config, configs.get(), NatsClient::kPatienceMs), NATS_OK);
  natsMsg_Destroy(config);
  sender.Hold(false);
  ASSERT_TRUE(receiver.WaitForBuffers(8));
  EXPECT_EQ(receiver.caps(), sender.caps());
  EXPECT_EQ(receiver.stat("messages-without-caps"), 0U);
  EXPECT_EQ(receiver.stat("messages-lost"), 0U);
}

TEST_F(NatsStream, CapsDoNotComeWithEachMessage) {
  const NatsClient other(server_.url());
  const auto configs = other.Subscribe("r1.front.config.*");
  PublishSlices(80, At("subject=r1.front"));
  natsConnection_Flush(other.get());
  int caps = 0;
  natsSubscription_GetPending(configs.get(), &caps, nullptr);
  EXPECT_GE(caps, 1);
  EXPECT_LT(caps, 40) << "they come again after a second";
}

/// The sender does not answer the first two requests for caps. It answers the third request.
TEST_F(NatsStream, CapsAreAskedForUntilTheyCome) {
  std::string why;
  const gst::CapsPtr caps(gst_caps_from_string("application/x-imu,sample-size=(int)32"));
  const auto format = nats::StreamFormat::FromCaps(caps.get(), &why);
  ASSERT_TRUE(format) << why;
  const NatsClient sender(server_.url());
  {
    const auto questions = sender.Subscribe("r1.imu.get-config");
    nats::SubscriberSettings settings;
    settings.connection.url = server_.url();
    settings.subject = "r1.imu";
    const auto subscriber = nats::Subscriber::Open(
        settings, [](const auto&) {}, &why);
    ASSERT_TRUE(subscriber) << why;
    std::thread answers([&] {
      for (int question = 1; question <= 3; ++question) {
        natsMsg* asked = nullptr;
        EXPECT_EQ(natsSubscription_NextMsg(&asked, questions.get(), NatsClient::kPatienceMs),
                  NATS_OK)
            << question;
        natsMsg_Destroy(asked);
      }
      natsConnection_PublishString(sender.get(), ("r1.imu.config." + format->id()).c_str(),
                                   format->text().c_str());
    });
    const auto found = subscriber->Format(format->id(), kPatience);
    answers.join();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->text(), format->text());
  }
}

/// libnats 3.4 may free a subscription while its reading thread still handles a message for the
/// subscription.
TEST_F(NatsStream, SubscriptionsEndWhileMessagesCome) {
  std::atomic<bool> done{false};
  std::thread flood([&] {
    const NatsClient sender(server_.url());
    while (!done) natsConnection_PublishString(sender.get(), "r1.imu", "a message");
  });
  nats::SubscriberSettings settings;
  settings.connection.url = server_.url();
  settings.subject = "r1.imu";
  const NatsClient other(server_.url());
  for (int i = 0; i < 100; ++i) {
    other.Subscribe("r1.imu");
    std::string why;
    const auto subscriber = nats::Subscriber::Open(
        settings, [](const auto&) {}, &why);
    EXPECT_TRUE(subscriber) << why;
    if (!subscriber) break;
    nats::Delivery delivery;
    EXPECT_TRUE(Eventually([&] {
      return subscriber->Next(std::chrono::milliseconds(100), &delivery) ==
             nats::Subscriber::Event::kMessage;
    }));
  }
  done = true;
  flood.join();
}

TEST_F(NatsStream, CapsThatChangeArriveBeforeTheirBuffers) {
  NatsPipeline receiver("natssrc name=n" + At() + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  const auto slices = PublishSlices(8, At());
  ASSERT_TRUE(receiver.WaitForBuffers(8));
  const std::string first = receiver.caps();
  NatsPipeline clouds(kQuick + "num-buffers=8" + kSee + "! natssink name=n sync=false" +
                      kPatientDrain + At());
  clouds.Play();
  EXPECT_EQ(clouds.WaitForEnd(), "");
  ASSERT_TRUE(receiver.WaitForBuffers(16));
  EXPECT_NE(receiver.caps(), first);
  EXPECT_EQ(receiver.caps(), clouds.caps());
  EXPECT_EQ(receiver.stat("messages-damaged"), 0U);
}

TEST_F(NatsStream, ServerKilledAndBackEveryLossIsCounted) {
  NatsPipeline receiver("natssrc name=n" + At() + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  NatsPipeline sender(kLive + "! lidarenc" + kSee + "! natssink name=n buffer-size=65536 " +
                      kPatientDrain + At());
  // The receiver cannot know what the sender drops before its first message.
  sender.HoldFrom(1);
  sender.Play();
  ASSERT_TRUE(receiver.WaitForBuffers(1));
  sender.Hold(false);
  ASSERT_TRUE(receiver.WaitForBuffers(20));
  server_.Kill();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-dropped") > 0; }));
  EXPECT_LE(sender.stat("bytes-waiting"), 65536U);
  ASSERT_TRUE(Eventually([&] { return sender.stat("connected") == 0; }));
  server_.Restart();
  ASSERT_TRUE(Eventually([&] { return receiver.stat("reconnects") > 0; }));
  const std::size_t before = receiver.count();
  ASSERT_TRUE(receiver.WaitForBuffers(before + 40));
  sender.SendEos();
  EXPECT_EQ(sender.WaitForEnd(), "");
  const guint64 sent = sender.count();
  EXPECT_TRUE(Eventually([&] {
    return receiver.stat("messages") + receiver.stat("messages-lost") == sent;
  })) << receiver.stat("messages")
      << " + " << receiver.stat("messages-lost") << " of " << sent;
  EXPECT_GE(receiver.stat("messages-lost"), sender.stat("messages-dropped"));
  EXPECT_EQ(sender.stat("messages") + sender.stat("messages-dropped"), sent);
  EXPECT_GE(sender.stat("reconnects"), 1U);
}

TEST_F(NatsStream, AServerThatComesLateGetsWhatWaits) {
  const std::string where = At();
  server_.Kill();
  NatsPipeline sender(kQuick + "num-buffers=40 ! lidarenc" + kSee +
                      "! natssink name=n sync=false " + kPatientDrain + where);
  NatsPipeline receiver("natssrc name=n" + where + "! fakesink name=see sync=false");
  receiver.Play();
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-waiting") == 40; }));
  server_.Restart();
  EXPECT_EQ(sender.WaitForEnd(), "");
  EXPECT_EQ(sender.stat("messages"), 40U);
  EXPECT_EQ(sender.stat("messages-dropped"), 0U);
}

TEST_F(NatsStream, TheStreamingThreadNeverWaitsForAServerThatHangs) {
  NatsPipeline sender(kQuick + "num-buffers=400 ! lidarenc" + kSee +
                      "! natssink name=n sync=false buffer-size=65536 drain-timeout=0" + At());
  sender.HoldFrom(1);
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages") == 1; }));
  server_.Freeze();
  sender.Hold(false);
  EXPECT_EQ(sender.WaitForEnd(), "");
  server_.Thaw();
}

TEST_F(NatsStream, AQueueGroupSharesTheMessages) {
  NatsPipeline a("natssrc name=n queue-group=workers" + At() + "! fakesink name=see sync=false");
  NatsPipeline b("natssrc name=n queue-group=workers" + At() + "! fakesink name=see sync=false");
  Listen(server_, &a);
  Listen(server_, &b);
  PublishSlices(200, At());
  EXPECT_TRUE(Eventually([&] { return a.count() + b.count() >= 200; }));
  EXPECT_EQ(a.count() + b.count(), 200U);
  EXPECT_GT(a.count(), 0U);
  EXPECT_GT(b.count(), 0U);
  EXPECT_EQ(a.stat("messages-lost") + b.stat("messages-lost"), 0U);
}

}  // namespace
}  // namespace lidar::test
