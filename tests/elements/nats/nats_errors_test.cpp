// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of natssink and natssrc with invalid messages, wrong settings, and servers that need
// credentials.
#include <dlfcn.h>

#include <atomic>
#include <cstdlib>
#include <map>

#include "ext/nats/stream_format.h"
#include "tests/elements/nats/nats_pipeline.h"
#include "tests/elements/nats/nats_stranger.h"

namespace {
std::atomic<bool> limits_come_late{false};
}  // namespace

/// Replaces libnats' function in this program and in the plugins that it loads. While
/// `limits_come_late` is true, waits until the subscription's connection is closed.
extern "C" __attribute__((visibility("default"))) natsStatus natsSubscription_SetPendingLimits(
    natsSubscription* subscription, int messages, int bytes) {
  static const auto next = reinterpret_cast<decltype(&natsSubscription_SetPendingLimits)>(
      dlsym(RTLD_NEXT, "natsSubscription_SetPendingLimits"));
  while (limits_come_late && natsSubscription_IsValid(subscription)) g_usleep(1'000);
  return next(subscription, messages, bytes);
}

namespace lidar::test {
namespace {

class NatsErrors : public NatsTest {};

TEST_F(NatsErrors, GarbageIsCountedAndTheStreamGoesOn) {
  server_.Start();
  NatsPipeline receiver("natssrc name=n" + At() + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  Stranger stranger(server_.url());
  const std::string id = "0123456789abcdef";
  stranger.Publish("lidar", "hello");
  stranger.Publish("lidar", "");
  stranger.Publish("lidar", std::string(900'000, 'x'));
  stranger.Publish("lidar", "x", {{"Lidar-Caps", id}});
  stranger.Publish("lidar", "x",
                   {{"Lidar-Caps", id}, {"Lidar-Place", "1 2"}, {"Lidar-Slice", "9"}});
  stranger.Publish("lidar", "x", {{"Lidar-Caps", id}, {"Lidar-Place", "1 2"}});  // unknown caps
  stranger.Publish(
      "lidar.config."
      "0123456789abcdef",
      "application/x-odometry");
  stranger.Publish("lidar.config.x", std::string(500'000, '{'));
  std::string nested = "application/x-lidar-slice, alignment=(string)slice, a=";
  while (nested.size() < 569) nested += "[[ a, b={";
  stranger.Publish("lidar.config.0000000000000000", nested);
  stranger.Publish("lidar.get-config", std::string(1'000, 'x'));
  stranger.Flush();
  EXPECT_TRUE(Eventually([&] { return receiver.stat("messages-damaged") == 5; }));
  EXPECT_TRUE(Eventually([&] { return receiver.stat("messages-without-caps") == 1; }));
  const auto sent = PublishSlices(16, At());
  ASSERT_TRUE(receiver.WaitForBuffers(16));
  ExpectSameStream(receiver.buffers(), sent);
  EXPECT_EQ(receiver.stat("formats-damaged"), 3U);
}

TEST_F(NatsErrors, WhatTheNextElementDoesNotTakeIsSaidOnceAndTheStreamGoesOn) {
  server_.Start();
  NatsPipeline receiver("natssrc name=n" + At() + "! lidardec ! fakesink name=see sync=false");
  Listen(server_, &receiver);
  const std::string caps = "application/x-voxels, alignment=(string)slice";
  std::string why;
  const gst::CapsPtr voxels(gst_caps_from_string(caps.c_str()));
  const auto format = nats::StreamFormat::FromCaps(voxels.get(), &why);
  ASSERT_TRUE(format) << why;
  Stranger stranger(server_.url());
  stranger.Publish(("lidar.config." + format->id()).c_str(), caps);
  for (const char* place : {"1 0", "1 1"})
    stranger.Publish("lidar", "x", {{"Lidar-Caps", format->id()}, {"Lidar-Place", place}});
  stranger.Flush();
  EXPECT_EQ(receiver.WaitForWarning("The subject"),
            "The subject carries application/x-voxels, which the next element does not take. Such "
            "messages are dropped and counted.");
  EXPECT_TRUE(Eventually([&] { return receiver.stat("messages-not-accepted") == 2; }));
  PublishSlices(8, At());
  EXPECT_TRUE(receiver.WaitForBuffers(8));
}

TEST_F(NatsErrors, AComplaintThatComesWithEachMessageIsToldOnce) {
  std::ofstream(server_.folder() + "/conf")
      << "authorization { users = [{ user: me, password: pw, permissions: { publish: { deny: lidar "
         "} } }] }\n";
  server_.Start({"-c", server_.folder() + "/conf"});
  NatsPipeline sender(kLive + "! lidarenc" + kSee +
                      "! natssink name=n url=" + server_.url("nats", "me:pw@"));
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return sender.stat("server-errors") >= 10; }));
  EXPECT_EQ(sender.Warnings("The NATS server reports an error"), 1U);
}

TEST_F(NatsErrors, WhatIsLeftOutIsNotCountedAsLostAndLeavesAMarkedGap) {
  server_.Start();
  NatsPipeline receiver("natssrc name=n" + At() +
                        "! application/x-imu ! fakesink name=see sync=false");
  Listen(server_, &receiver);
  Stranger stranger(server_.url());
  const auto publish = [&](const std::string& caps, const char* place) {
    std::string why;
    const gst::CapsPtr of(gst_caps_from_string(caps.c_str()));
    const auto format = nats::StreamFormat::FromCaps(of.get(), &why);
    ASSERT_TRUE(format) << why;
    if (caps != "application/x-imu, sample-size=(int)1")
      stranger.Publish(("lidar.config." + format->id()).c_str(), format->text());
    stranger.Publish("lidar", std::string(32, 'x'),
                     {{"Lidar-Caps", format->id()}, {"Lidar-Place", place}});
  };
  const char* const kImu = "application/x-imu, sample-size=(int)32";
  publish(kImu, "1 0");
  publish("application/x-imu, sample-size=(int)1", "1 1");  // these caps are never published
  publish(kImu, "1 2");
  publish("application/x-voxels, alignment=(string)slice", "1 3");
  publish(kImu, "1 4");
  publish(kImu, "1 5");
  ASSERT_TRUE(receiver.WaitForBuffers(4));
  EXPECT_EQ(receiver.stat("messages-without-caps"), 1U);
  EXPECT_EQ(receiver.stat("messages-not-accepted"), 1U);
  EXPECT_EQ(receiver.stat("messages-lost"), 0U);
  std::vector<bool> marked;
  for (const Kept& kept : receiver.buffers()) marked.push_back(kept.discont);
  EXPECT_EQ(marked, (std::vector<bool>{true, true, true, false}));
}

TEST_F(NatsErrors, ABufferOfAnotherSizeThanItsCapsSayIsCounted) {
  server_.Start();
  NatsPipeline receiver("natssrc name=n" + At() + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  PublishSlices(1, At());
  ASSERT_TRUE(receiver.WaitForBuffers(1));
  NatsPipeline clouds(kQuick + "num-buffers=1" + kSee + "! natssink name=n sync=false" +
                      kPatientDrain + At());
  clouds.Play();
  EXPECT_EQ(clouds.WaitForEnd(), "");
  ASSERT_TRUE(receiver.WaitForBuffers(2));
  Stranger stranger(server_.url());
  // Publishes a cloud that was cut off, with the caps of whole clouds.
  std::string why;
  const gst::CapsPtr caps(gst_caps_from_string(clouds.caps().c_str()));
  const auto format = nats::StreamFormat::FromCaps(caps.get(), &why);
  ASSERT_TRUE(format);
  stranger.Publish("lidar", "short", {{"Lidar-Caps", format->id()}, {"Lidar-Place", "1 2"}});
  stranger.Flush();
  EXPECT_TRUE(Eventually([&] { return receiver.stat("messages-damaged") == 1; }));
  EXPECT_EQ(receiver.count(), 2U);
}

TEST_F(NatsErrors, CapsAndBuffersThatTheServerDoesNotTakeAreTold) {
  std::ofstream(server_.folder() + "/conf") << "max_payload: 100\n";
  server_.Start({"-c", server_.folder() + "/conf"});
  NatsPipeline sender(kQuick + "num-buffers=8" + kSee + "! natssink name=n sync=false" +
                      kPatientDrain + At());
  sender.Play();
  for (const std::string what : {"The caps are", "A buffer is"})
    EXPECT_NE(sender.WaitForWarning(what + " larger than the server allows"), "");
  EXPECT_EQ(sender.WaitForEnd(),
            "None of 8 messages reached the NATS server: they exceed its max_payload, or "
            "buffer-size.");
  EXPECT_EQ(sender.stat("messages-too-large"), 8U);
}

TEST_F(NatsErrors, AStreamWhoseBuffersAllExceedTheBufferSizeEndsWithAnError) {
  server_.Start();
  NatsPipeline sender(kQuick + "slices-per-scan=1 num-buffers=8" + kSee +
                      "! natssink name=n sync=false buffer-size=65536" + kPatientDrain + At());
  sender.Play();
  EXPECT_EQ(sender.WaitForEnd(),
            "None of 8 messages reached the NATS server: they exceed its max_payload, or "
            "buffer-size.");
  EXPECT_EQ(sender.stat("messages-dropped"), 8U);
  NatsPipeline patient(kQuick + "slices-per-scan=1 num-buffers=8" + kSee +
                       "! natssink name=n sync=false buffer-size=65536 keep-trying=true" +
                       kPatientDrain + At());
  patient.Play();
  EXPECT_EQ(patient.WaitForEnd(), "");
  EXPECT_EQ(patient.stat("messages-dropped"), 8U);
}

TEST_F(NatsErrors, AnEmptyStreamIsNoError) {
  server_.Start();
  NatsPipeline sender(kQuick + "num-buffers=0 ! lidarenc" + kSee + "! natssink name=n sync=false" +
                      kPatientDrain + At());
  sender.Play();
  EXPECT_EQ(sender.WaitForEnd(), "");
}

TEST_F(NatsErrors, AServerThatIsNotThereIsToldOfByBothEnds) {
  const std::string away = " url=nats://me:s3cret@127.0.0.1:1 ";
  for (const std::string& pipeline :
       {"natssrc name=n" + away + "! fakesink name=see",
        kLive + "! lidarenc" + kSee + "! natssink name=n drain-timeout=100000000" + away}) {
    NatsPipeline p(pipeline);
    p.Play();
    const std::string warning = p.WaitForWarning("No NATS server");
    EXPECT_EQ(warning.rfind("No NATS server answers at nats://127.0.0.1:1; ", 0), 0U) << warning;
  }
}

/// A robot may start while its link is interrupted. In this case libnats itself does not connect
/// again.
TEST_F(NatsErrors, AServerThatTakesConnectionsAndIsSilentIsTriedAgain) {
  server_.Start();
  server_.Freeze();
  NatsPipeline receiver("natssrc name=n" + At() + "! fakesink name=see sync=false");
  NatsPipeline sender(kLive + "! lidarenc" + kSee + "! natssink name=n" + At());
  receiver.Play();
  sender.Play();
  EXPECT_NE(receiver.WaitForWarning("No NATS server answers"), "");
  EXPECT_NE(sender.WaitForWarning("No NATS server answers"), "");
  server_.Thaw();
  EXPECT_TRUE(receiver.WaitForBuffers(1));
  EXPECT_EQ(sender.stat("refusals"), 0U);
}

/// libnats gives a silent server up while natssrc subscribes, as on a machine that stops its
/// thread.
TEST_F(NatsErrors, AServerThatIsSilentDuringASubscriptionIsTriedAgain) {
  server_.Start();
  server_.Freeze();
  NatsPipeline receiver("natssrc name=n" + At() + "! fakesink name=see sync=false");
  limits_come_late = true;
  const bool plays = receiver.Play();
  limits_come_late = false;
  ASSERT_TRUE(plays);
  EXPECT_NE(receiver.WaitForWarning("No NATS server answers"), "");
  server_.Thaw();
  ASSERT_TRUE(Eventually([&] { return server_.Subscriptions("lidar") > 0; }));
  PublishSlices(8, At());
  EXPECT_TRUE(receiver.WaitForBuffers(8));
}

TEST_F(NatsErrors, AStreamThatReachesNoServerEndsWithAnError) {
  NatsPipeline sender(kQuick + "num-buffers=8 ! lidarenc" + kSee +
                      "! natssink name=n sync=false drain-timeout=100000000 "
                      "url=nats://127.0.0.1:1");
  sender.Play();
  EXPECT_EQ(sender.WaitForEnd(),
            "None of 8 messages reached a NATS server. Start a server, or set url.");
  sender.Stop();
  EXPECT_EQ(sender.stat("messages-dropped"), 8U) << "at the stop";
}

TEST_F(NatsErrors, AWrongTokenIsAnErrorAndTheRightOneIsTaken) {
  server_.Start({"--auth", "s3cret"});
  for (const std::string end : {" ! fakesink name=see", ""}) {
    const std::string with = At("token=wrong");
    NatsPipeline refused(end.empty() ? kLive + "! lidarenc" + kSee + "! natssink name=n" + with
                                     : "natssrc name=n" + with + end);
    refused.Play();
    const std::string text = refused.WaitForEnd();
    EXPECT_NE(text.find("refused the connection: Authorization Violation."), text.npos) << text;
  }
  NatsPipeline receiver("natssrc name=n" + At("token=s3cret") + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  PublishSlices(8, At("token=s3cret"));
  EXPECT_TRUE(receiver.WaitForBuffers(8));
}

TEST_F(NatsErrors, ASinkThatKeepsTryingIsTakenOnceTheServerWants) {
  server_.Start({"--auth", "other"});
  NatsPipeline sender(kLive + "! lidarenc" + kSee + "! natssink name=n keep-trying=true" +
                      At("token=s3cret"));
  sender.Play();
  EXPECT_NE(sender.WaitForWarning("refused the connection"), "");
  EXPECT_EQ(sender.stat("connected"), 0U);
  server_.Start({"--auth", "s3cret"});
  NatsPipeline receiver("natssrc name=n" + At("token=s3cret") + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  EXPECT_TRUE(receiver.WaitForBuffers(8));
  EXPECT_EQ(sender.stat("connected"), 1U);
}

TEST_F(NatsErrors, ASinkThatKeepsTryingCountsOverAllItsConnections) {
  const auto connected = [](const NatsPipeline& sender) {
    return Eventually([&] { return sender.stat("connected") == 1; });
  };
  server_.Start({"--auth", "s3cret"});
  NatsPipeline sender(kLive + "! lidarenc" + kSee + "! natssink name=n keep-trying=true" +
                      At("token=s3cret"));
  sender.Play();
  ASSERT_TRUE(connected(sender));
  std::map<std::string, guint64> before;
  for (guint64 round = 1; round <= 2; ++round) {
    EXPECT_EQ(sender.stat("reconnects"), round - 1);
    server_.Start({"--auth", "other"});
    ASSERT_TRUE(Eventually([&] { return sender.stat("refusals") > before["refusals"]; }));
    EXPECT_EQ(sender.stat("connected"), 0U);
    const guint64 errors = sender.stat("server-errors");
    EXPECT_GT(errors, before["server-errors"]);
    server_.Start({"--auth", "s3cret"});
    ASSERT_TRUE(connected(sender));
    EXPECT_GE(sender.stat("server-errors"), errors);
    for (const char* count : {"refusals", "server-errors", "messages"}) {
      EXPECT_GE(sender.stat(count), before[count]) << count;
      before[count] = sender.stat(count);
    }
    EXPECT_EQ(sender.stat("reconnects"), round);
  }
}

TEST_F(NatsErrors, CredentialsAreTakenFromAFile) {
  const auto options = server_.OptionsForCredentials();
  if (options.empty()) GTEST_SKIP() << "openssl or python3 is not installed";
  server_.Start(options);
  const std::string good = At("credentials-file=" + server_.folder() + "/good.creds");
  NatsPipeline receiver("natssrc name=n" + good + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  PublishSlices(8, good);
  EXPECT_TRUE(receiver.WaitForBuffers(8));
  const std::string bad = At("credentials-file=" + server_.folder() + "/bad.creds");
  for (const std::string& with : {bad, At()}) {
    NatsPipeline refused("natssrc name=n" + with + "! fakesink name=see");
    refused.Play();
    EXPECT_NE(refused.WaitForEnd().find("refused the connection"), std::string::npos);
  }
}

/// Makes a self-signed certificate for 127.0.0.1: the files NAME.pem and NAME-key.pem.
bool MakeCertificate(const std::string& folder, const std::string& name) {
  const std::string make =
      "cd " + folder +
      " && openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -keyout " +
      name + "-key.pem -out " + name +
      ".pem -days 2 -subj /CN=127.0.0.1 -addext subjectAltName=IP:127.0.0.1 2>/dev/null";
  return std::system(make.c_str()) == 0;
}

TEST_F(NatsErrors, AnAddressWithTlsMeansTls) {
  server_.Start();
  // A connection without TLS would succeed, but it must not be used: a single tls:// address in the
  // list is enough to require TLS.
  for (const std::string& url : {server_.url("tls"), server_.url() + "," + server_.url("tls")}) {
    NatsPipeline wary("natssrc name=n url=" + url + " ! fakesink name=see sync=false");
    wary.Play();
    PublishSlices(8, At());  // newer versions of libnats try again, older versions give up
    EXPECT_EQ(wary.stat("connected"), 0U) << url;
    EXPECT_TRUE(wary.buffers().empty()) << url;
  }
}

TEST_F(NatsErrors, CertificatesMeanTls) {
  const std::string own = server_.folder() + "/own";
  if (!MakeCertificate(server_.folder(), "own")) GTEST_SKIP() << "openssl is not installed";
  server_.Start();
  // A connection without TLS would succeed, but the files require TLS.
  for (const std::string& files :
       {"tls-ca-file=" + own + ".pem",
        "tls-cert-file=" + own + ".pem tls-key-file=" + own + "-key.pem"}) {
    NatsPipeline wary("natssrc name=n url=" + server_.url() + " " + files +
                      " ! fakesink name=see sync=false");
    wary.Play();
    PublishSlices(8, At());
    EXPECT_EQ(wary.stat("connected"), 0U) << files;
    EXPECT_TRUE(wary.buffers().empty()) << files;
  }
}

TEST_F(NatsErrors, AnAddressWithTlsTrustsWhomTheSystemTrusts) {
  const std::string f = server_.folder();
  if (!MakeCertificate(f, "cert")) GTEST_SKIP() << "openssl is not installed";
  server_.Start({"--tls", "--tlscert", f + "/cert.pem", "--tlskey", f + "/cert-key.pem"});
  const std::string tls = " url=" + server_.url("tls") + " ";
  g_setenv("SSL_CERT_FILE", (f + "/cert.pem").c_str(), TRUE);
  NatsPipeline receiver("natssrc name=n" + tls + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  PublishSlices(8, tls);
  EXPECT_TRUE(receiver.WaitForBuffers(8));
  g_unsetenv("SSL_CERT_FILE");
  NatsPipeline wary("natssrc name=n" + tls + "! fakesink name=see sync=false");
  wary.Play();
  EXPECT_TRUE(Eventually([&] { return server_.Logged("TLS handshake error") > 0; }));
  EXPECT_EQ(wary.stat("connected"), 0U);
}

TEST_F(NatsErrors, TlsChecksTheServersCertificate) {
  const std::string f = server_.folder();
  if (!MakeCertificate(f, "cert") || !MakeCertificate(f, "other"))
    GTEST_SKIP() << "openssl is not installed";
  server_.Start({"--tls", "--tlscert", f + "/cert.pem", "--tlskey", f + "/cert-key.pem"});
  const std::string good = " url=" + server_.url("tls") + " tls-ca-file=" + f + "/cert.pem ";
  NatsPipeline receiver("natssrc name=n" + good + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  PublishSlices(8, good);
  EXPECT_TRUE(receiver.WaitForBuffers(8));
  NatsPipeline wary("natssrc name=n url=" + server_.url("tls") + " tls-ca-file=" + f +
                    "/other.pem ! fakesink name=see sync=false");
  wary.Play();
  PublishSlices(8, good);
  EXPECT_EQ(wary.stat("connected"), 0U);
}

TEST_F(NatsErrors, AServerThatWantsACertificateGetsOurs) {
  const std::string f = server_.folder();
  if (!MakeCertificate(f, "cert") || !MakeCertificate(f, "own"))
    GTEST_SKIP() << "openssl is not installed";
  server_.Start({"--tls", "--tlscert", f + "/cert.pem", "--tlskey", f + "/cert-key.pem",
                 "--tlsverify", "--tlscacert", f + "/own.pem"});
  const std::string without = " url=" + server_.url("tls") + " tls-ca-file=" + f + "/cert.pem ";
  const std::string with =
      without + "tls-cert-file=" + f + "/own.pem tls-key-file=" + f + "/own-key.pem ";
  NatsPipeline receiver("natssrc name=n" + with + "! fakesink name=see sync=false");
  Listen(server_, &receiver);
  PublishSlices(8, with);
  EXPECT_TRUE(receiver.WaitForBuffers(8));
  NatsPipeline stranger("natssrc name=n" + without + "! fakesink name=see sync=false");
  stranger.Play();
  EXPECT_TRUE(Eventually([&] { return server_.Logged("TLS handshake error") > 0; }));
  EXPECT_EQ(stranger.stat("connected"), 0U);
}

struct WrongSetting {
  const char* element;
  const char* message;
};
class NatsWrongSetting : public ::testing::TestWithParam<WrongSetting> {};
INSTANTIATE_TEST_SUITE_P(
    All, NatsWrongSetting,
    ::testing::Values(
        WrongSetting{"natssink name=n subject=a..b",
                     "The subject \"a..b\" is not valid: it begins or ends with a dot, or has two "
                     "dots in a row."},
        WrongSetting{"natssink name=n subject=fleet.>",
                     "The subject \"fleet.>\" is not valid: it has a blank, a wildcard or a "
                     "character that is "
                     "not ASCII."},
        WrongSetting{
            "natssink name=n jetstream=a.b",
            "The jetstream \"a.b\" is not valid: only letters, digits, - and _ are allowed."},
        WrongSetting{"natssink name=n subject=a.b jetstream=s jetstream-subjects=a.*",
                     "jetstream-subjects \"a.*\" must cover a.b and a.b.config.*."},
        WrongSetting{"natssink name=n jetstream=s jetstream-subjects=>",
                     "jetstream-subjects \">\" must not begin with a wildcard."},
        WrongSetting{"natssink name=n url=,", "NATS cannot be used: url names no server."},
        WrongSetting{"natssrc name=n url=,", "NATS cannot be used: url names no server."},
        WrongSetting{"natssink name=n replicas=3",
                     "The property replicas needs the property jetstream."},
        WrongSetting{"natssink name=n tls-ca-file=/none",
                     "NATS cannot be used: cannot read /none."},
        WrongSetting{"natssink name=n credentials-file=/none",
                     "NATS cannot be used: cannot read /none."},
        WrongSetting{"natssink name=n tls-cert-file=/etc/passwd",
                     "NATS cannot be used: tls-cert-file and tls-key-file must be set together."},
        WrongSetting{"natssink name=n tls-key-file=/etc/passwd",
                     "NATS cannot be used: tls-cert-file and tls-key-file must be set together."},
        WrongSetting{"natssink name=n token=t credentials-file=/etc/passwd",
                     "NATS cannot be used: token and credentials-file cannot be set together."},
        WrongSetting{"natssink name=n jetstream=s jetstream-subjects=*.b",
                     "jetstream-subjects \"*.b\" must not begin with a wildcard."},
        WrongSetting{"natssrc name=n durable=d ! fakesink", "durable needs jetstream."},
        WrongSetting{"natssrc name=n jetstream=s queue-group=q ! fakesink",
                     "queue-group with jetstream needs durable."}));

TEST_P(NatsWrongSetting, IsNamed) {
  const std::string element = GetParam().element;
  const bool sink = element.find("natssink") == 0;
  NatsPipeline pipeline(sink ? kLive + "! lidarenc" + kSee + "! " + element
                             : element.substr(0, element.find('!')) + kSee + "! fakesink");
  EXPECT_FALSE(pipeline.Play());
  EXPECT_EQ(pipeline.WaitForEnd(), GetParam().message);
}

}  // namespace
}  // namespace lidar::test
