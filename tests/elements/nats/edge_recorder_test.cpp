// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of parts of lidar-edge: each setting reaches its element, a session keeps no packets of the
// previous session, and a recorder that fails does not disturb the other branches.
#include "src/tools/apps/edge/pipeline.h"
#include "src/tools/apps/edge/shared_port.h"
#include "tests/elements/nats/nats_server.h"
#include "tests/support/free_ports.h"
#include "tests/support/harness.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

using Settings = std::vector<std::pair<const char*, const char*>>;

void ExpectSettings(GstElement* pipeline, const char* name, const Settings& expected) {
  const gst::ElementPtr element(gst_bin_get_by_name(GST_BIN(pipeline), name));
  ASSERT_TRUE(element) << name;
  for (const auto& [property, text] : expected) {
    GValue value = G_VALUE_INIT;
    g_object_get_property(G_OBJECT(element.get()), property, &value);
    const gst::StringPtr shown(G_VALUE_HOLDS_STRING(&value) ? g_value_dup_string(&value)
                                                            : gst_value_serialize(&value));
    EXPECT_STREQ(shown.get(), text) << name << " " << property;
    g_value_unset(&value);
  }
}

TEST(EdgePipeline, GivesEachSettingToItsElement) {
  edge::EdgeConfig config;
  config.address = "127.0.0.9";
  config.nats = {nats::ConnectionSettings{}, "fleet2", "KEPT", 3, 7, 12'345, 70'000};
  nats::ConnectionSettings& connection = *config.nats.connection;
  connection.url = "nats.invalid";
  connection.credentials_file = "a.creds";
  connection.tls_ca_file = "ca.pem";
  connection.tls_cert_file = "cert.pem";
  connection.tls_key_file = "key.pem";
  edge::RobotConfig robot;
  robot.name = "r1";
  robot.sensor = "top";
  robot.port = 5'017;
  robot.srtp_cipher = "aes-256-gcm";
  robot.dtls_certificate = "edge.pem";
  robot.dtls_peer_certificate = "robot.crt";
  robot.record = "r1-%05d.mcap";
  robot.record_max_file_size = 654'321;
  robot.record_max_files = 12;
  const gst::ElementPtr pipeline = edge::MakePipeline(config, robot, nullptr);
  edge::AddRecorder(pipeline.get(), robot);
  EXPECT_STREQ(GST_OBJECT_NAME(pipeline.get()), "r1-top");
  ExpectSettings(pipeline.get(), "screamsrc",
                 {{"address", "127.0.0.9"},
                  {"port", "5017"},
                  {"srtp-cipher", "aes-256-gcm"},
                  {"dtls-certificate", "edge.pem"},
                  {"dtls-peer-certificate", "robot.crt"},
                  {"close-socket", "false"},
                  {"eos-on-bye", "true"}});
  ExpectSettings(pipeline.get(), "tee", {{"allow-not-linked", "true"}});
  ExpectSettings(pipeline.get(), "natssink",
                 {{"url", "nats.invalid"},
                  {"credentials-file", "a.creds"},
                  {"tls-ca-file", "ca.pem"},
                  {"tls-cert-file", "cert.pem"},
                  {"tls-key-file", "key.pem"},
                  {"subject", "fleet2.r1.lidar.top"},
                  {"jetstream", "KEPT"},
                  {"jetstream-subjects", "fleet2.*.lidar.>"},
                  {"replicas", "3"},
                  {"max-age", "7000000000"},
                  {"max-bytes", "12345"},
                  {"buffer-size", "70000"},
                  {"drain-timeout", "1000000000"},
                  {"sync", "false"},
                  {"async", "false"},
                  {"keep-trying", "true"}});
  ExpectSettings(pipeline.get(), "queue",
                 {{"leaky", "downstream"},
                  {"max-size-bytes", "8388608"},
                  {"max-size-buffers", "16384"},
                  {"max-size-time", "30000000000"}});
  ExpectSettings(pipeline.get(), "mcapsink",
                 {{"location", "r1-%05d.mcap"}, {"max-file-size", "654321"}, {"max-files", "12"}});
}

TEST(SharedPort, ASocketThatIsOpenedHasNothingFromBefore) {
  const auto number = FreePort();
  const edge::SharedPort port("127.0.0.1", number, {{7, 7}});
  GSocket* socket = port.socket(0);
  g_socket_set_blocking(socket, FALSE);
  using Object = std::unique_ptr<void, decltype(&g_object_unref)>;
  const Object address(g_inet_socket_address_new_from_string("127.0.0.1", number), g_object_unref);
  const Object sender(g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM,
                                   G_SOCKET_PROTOCOL_DEFAULT, nullptr),
                      g_object_unref);
  char packet[12] = {'\x80', 96, 0, 1, 0, 0, 0, 0, 0, 0, 0, 7};
  const auto send = [&] {
    g_socket_send_to(G_SOCKET(sender.get()), G_SOCKET_ADDRESS(address.get()), packet, sizeof packet,
                     nullptr, nullptr);
  };
  const auto received = [&] {
    char bytes[100];
    int count = 0;
    while (g_socket_receive(socket, bytes, sizeof bytes, nullptr, nullptr) > 0) ++count;
    return count;
  };
  send();  // sent while the socket is shut
  edge::ShutSocket(socket, false);
  EXPECT_EQ(received(), 0);
  send();
  EXPECT_EQ(received(), 1);
  send();  // waits in the socket's queue
  edge::ShutSocket(socket, true);
  send();
  edge::ShutSocket(socket, false);
  EXPECT_EQ(received(), 0) << "of the session before";
  send();
  EXPECT_EQ(received(), 1);
  // The second byte of an RTCP packet is from 192 to 223. The SSRC is in bytes 4 to 7 of an RTCP
  // packet, and in bytes 8 to 11 of an RTP packet.
  for (const auto& [type, at] :
       {std::pair{191, 11}, std::pair{192, 7}, std::pair{223, 7}, std::pair{224, 11}})
    for (const int place : {7, 11}) {
      packet[1] = static_cast<char>(type);
      packet[7] = packet[11] = 0;
      packet[place] = 7;
      send();
      EXPECT_EQ(received(), place == at ? 1 : 0) << type;
    }
}

class EdgeRecorder : public ::testing::Test {
 protected:
  void SetUp() override {
    robot_.record = "/dev/null";
    pipeline_.reset(gst_parse_launch(
        "fakesrc name=screamsrc is-live=true sync=true datarate=1000 sizetype=fixed sizemax=100 ! "
        "tee name=tee allow-not-linked=true ! fakesink name=sink async=false sync=false",
        nullptr));
    edge::AddRecorder(pipeline_.get(), robot_);
  }
  void TearDown() override { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }
  gst::ElementPtr Find(const char* name) const {
    return gst::ElementPtr(gst_bin_get_by_name(GST_BIN(pipeline_.get()), name));
  }
  gst::PadPtr PadOf(const char* element) const {
    return gst::PadPtr(gst_element_get_static_pad(Find(element).get(), "sink"));
  }
  void FailRecorder() const {
    const gst::ElementPtr recorder = Find("recorder");
    GST_ELEMENT_ERROR(recorder.get(), RESOURCE, WRITE, ("The disk is full."), (nullptr));
  }

  edge::RobotConfig robot_;
  gst::ElementPtr pipeline_;
};

TEST_F(EdgeRecorder, ThatFailsAtTheEndDoesNotCutTheStreamShort) {
  FailRecorder();
  gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
  int errors = 0;
  EXPECT_TRUE(edge::Drain(pipeline_.get(), kPatience_ns, [&](GstMessage*) {
    ++errors;
    edge::RemoveRecorder(pipeline_.get());
  }));
  EXPECT_GE(errors, 1);
  // The sink posts the EOS message before its pad has the flag EOS.
  EXPECT_TRUE(Eventually([&] { return GST_PAD_IS_EOS(PadOf("sink").get()); }));
}

TEST_F(EdgeRecorder, ThatFailsBehindTheEndOfTheStreamDoesNotDelayIt) {
  FailRecorder();
  gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
  const gint64 begin = g_get_monotonic_time();
  EXPECT_TRUE(edge::Drain(pipeline_.get(), 300 * GST_SECOND, [&](GstMessage*) {
    EXPECT_TRUE(Eventually([&] { return GST_PAD_IS_EOS(PadOf("sink").get()); }));
    edge::RemoveRecorder(pipeline_.get());
  }));
  EXPECT_LT(g_get_monotonic_time() - begin, 200 * G_TIME_SPAN_SECOND);
}

TEST_F(EdgeRecorder, ThatRefusesWhatItGetsIsNotNoticedInFrontOfIt) {
  const gst::PadPtr entry = PadOf("recorder");
  const gst::PadPtr inner = PadOf("queue");
  for (GstPad* pad : {inner.get(), entry.get()}) gst_pad_set_active(pad, TRUE);
  int refused = 0;
  gst_pad_add_probe(
      inner.get(),
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST),
      [](GstPad*, GstPadProbeInfo* info, gpointer count) {
        gst_mini_object_unref(GST_MINI_OBJECT(GST_PAD_PROBE_INFO_DATA(info)));
        GST_PAD_PROBE_INFO_FLOW_RETURN(info) = GST_FLOW_ERROR;
        ++*static_cast<int*>(count);
        return GST_PAD_PROBE_HANDLED;
      },
      &refused, nullptr);
  gst_pad_send_event(entry.get(), gst_event_new_stream_start("s"));
  gst_pad_send_event(entry.get(), NewSegment());
  EXPECT_EQ(gst_pad_chain(entry.get(), gst_buffer_new()), GST_FLOW_OK);
  GstBufferList* list = gst_buffer_list_new();
  gst_buffer_list_add(list, gst_buffer_new());
  EXPECT_EQ(gst_pad_chain_list(entry.get(), list), GST_FLOW_OK);
  EXPECT_EQ(refused, 2);
}

}  // namespace
}  // namespace lidar::test
