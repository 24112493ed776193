// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of ouster_src with a simulated sensor, over real sockets: the element finds the sensor and
// configures it, loses it, and finds it again.
#include <atomic>
#include <cstdio>
#include <fstream>
#include <optional>

#include "src/ouster/scan_batcher.h"
#include "src/tools/bench/ouster_replay/http_server.h"
#include "tests/elements/ouster/live_receiver.h"
#include "tests/elements/ouster/software_sensor.h"
#include "tests/support/element_stats.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

using gst::BufferPtr;
using gst::CloudInfo;
using gst::MessagePtr;

TEST(OusterLive, FindsItsSensorAndHasItDoWhatIsAsked) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(),
                    "udp-dest=@auto lidar-mode=1024x10 udp-profile-lidar=RNG15_RFL8_NIR8 "
                    "sensor-timestamp-mode=TIME_FROM_PTP_1588 signal-multiplier=2 "
                    "azimuth-window=90000,270000");
  const BufferPtr buffer = receiver.Pull();
  ASSERT_TRUE(buffer);
  const CloudInfo info = receiver.Info();
  EXPECT_EQ(info.height, 32U);
  EXPECT_EQ(info.ScanDuration(), 100 * GST_MSECOND);
  EXPECT_EQ(info.sensor_model->columns_per_scan, 1024U);
  EXPECT_EQ(info.sensor_model->range_unit_mm, 8U);
  const auto config = sensor.config();
  EXPECT_EQ(config["udp_dest"], "127.0.0.1");
  EXPECT_EQ(config["udp_port_lidar"], receiver.port());
  EXPECT_EQ(config["signal_multiplier"], 2);
  EXPECT_EQ(config["azimuth_window"], nlohmann::json({90000, 270000}));
  EXPECT_EQ(config["timestamp_mode"], "TIME_FROM_PTP_1588");
}

TEST(OusterLive, ASensorThatIsAsAskedIsNotRestarted) {
  SoftwareSensor sensor({});
  {
    Receiver receiver(sensor.host(), "udp-dest=@auto");
    ASSERT_TRUE(receiver.Pull());
  }
  const auto port = sensor.config()["udp_port_lidar"].get<int>();
  const auto before = nlohmann::json::parse(sensor.state().MetadataJson());
  const auto imu_port = sensor.config()["udp_port_imu"].get<int>();
  EXPECT_EQ(RunToEnd("ouster_src num-buffers=3 udp-dest=@auto hostname=" + sensor.host() +
                     " lidar-port=" + std::to_string(port) +
                     " imu-port=" + std::to_string(imu_port) + " ! fakesink"),
            "");
  const auto after = nlohmann::json::parse(sensor.state().MetadataJson());
  EXPECT_EQ(before["sensor_info"]["initialization_id"], after["sensor_info"]["initialization_id"]);
}

TEST(OusterLive, ConfiguresFirmwareThatHasTheOldApi) {
  SoftwareSensor::Options options;
  options.old_firmware = true;
  SoftwareSensor sensor(options);
  Receiver receiver(sensor.host(), "udp-dest=@auto lidar-mode=512x10");
  ASSERT_TRUE(receiver.Pull());
  EXPECT_EQ(sensor.config()["lidar_mode"], "512x10");
  EXPECT_EQ(receiver.Info().ScanDuration(), 100 * GST_MSECOND);
}

TEST(OusterLive, FirmwareThatHasTheOldApiIsNotRestartedWhereItRefusesASetting) {
  SoftwareSensor::Options options;
  options.old_firmware = true;
  SoftwareSensor sensor(options);
  const auto before = nlohmann::json::parse(sensor.state().MetadataJson());
  Receiver receiver(sensor.host(), "udp-dest=@auto lidar-mode=1x1");
  const std::string error = receiver.AwaitError();
  EXPECT_NE(error.find("there is no mode"), std::string::npos) << error;
  const auto after = nlohmann::json::parse(sensor.state().MetadataJson());
  EXPECT_EQ(before["sensor_info"]["initialization_id"], after["sensor_info"]["initialization_id"]);
}

TEST(OusterLive, ASettingThatTheSensorRefusesIsAnError) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "signal-multiplier=0.7");
  const std::string error = receiver.AwaitError();
  EXPECT_NE(error.find("signal_multiplier"), std::string::npos) << error;
}

TEST(OusterLoss, IsCountedExactlyAsItWasInjected) {
  tools::SynthOptions options;
  options.model = "os0-32";
  const ouster::Metadata metadata = tools::MakeSynthMetadata(options, {"512x20"});
  tools::SynthStream stream(options, metadata);
  tools::FaultInjector injector(7);
  std::string error;
  ouster::ScanBatcher batcher(metadata, *ouster::PointWriter::Create(metadata, {}, &error), {4, 4});
  tools::Faults faults;
  const auto send = [&](int packets) {
    for (int i = 0; i < packets; ++i) {
      for (const tools::OutPacket& p : injector.Apply(faults, *stream.Next())) {
        if (p.imu) continue;
        batcher.Push(
            *ouster::LidarPacket::Parse({p.bytes.data(), p.bytes.size()}, metadata.format));
        while (batcher.Pop()) continue;
      }
    }
  };
  // A loss is counted only if packets before and after it arrive. Therefore no packet is lost at
  // the beginning and the end.
  send(10);
  faults.loss = faults.reorder = faults.duplicate = 0.05;
  send(6000);
  faults = {};
  send(100);
  EXPECT_GT(injector.counts().lost, 150U);
  EXPECT_EQ(batcher.stats().lost_packets, injector.counts().lost);
  EXPECT_EQ(batcher.stats().duplicate_packets, injector.counts().duplicated);
}

TEST(OusterLive, CountsWhatIsLostOnTheWay) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "udp-dest=@auto");
  ASSERT_TRUE(receiver.AwaitConnected(true));
  const auto before = StatOf(receiver.source(), "packets-lost");
  sensor.Fault({{"loss", 0.1}});
  ASSERT_TRUE(receiver.PullUntil([&](GstBuffer*) { return sensor.counts().lost >= 30; }));
  sensor.Fault({{"loss", 0.0}});
  EXPECT_TRUE(receiver.PullUntil([end = sensor.counts().sent + 100, &sensor](GstBuffer*) {
    return sensor.counts().sent > end;
  }));
  const auto stat = [&](const char* name) { return StatOf(receiver.source(), name); };
  // A lost packet is counted once a later packet has arrived, and the receiver may lag on a busy
  // machine. If the machine stops the sensor for a second, the sensor's clock jumps. In this case,
  // losses at the end of slices before the jump are not counted.
  const auto lost = [&] { return stat("packets-lost") - before; };
  const auto known = [&] { return lost() >= sensor.counts().lost || stat("clock-jumps") > 0; };
  EXPECT_TRUE(receiver.PullUntil([&](GstBuffer*) { return known(); }));
  const guint64 counted = lost();  // read first, because packets continue to arrive
  EXPECT_LE(counted, sensor.counts().lost + stat("dropped-by-kernel"));
  EXPECT_TRUE(lost() >= sensor.counts().lost || stat("clock-jumps") > 0) << lost();
}

TEST(OusterLive, DamagedPacketsAreToldByTheirCrc) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "udp-dest=@auto");
  ASSERT_TRUE(receiver.Pull());
  sensor.Fault({{"corrupt", 1.0}});
  const gint64 end = g_get_monotonic_time() + kPatience_us;
  while (sensor.counts().corrupted < 50 && g_get_monotonic_time() < end) g_usleep(1000);
  sensor.Fault({{"corrupt", 0.0}});
  EXPECT_TRUE(receiver.PullUntil([last = sensor.counts().sent + 100, &sensor](GstBuffer*) {
    return sensor.counts().sent > last;
  }));
  const auto corrupted = sensor.counts().corrupted;
  EXPECT_GE(corrupted, 50U);
  const auto stat = [&](const char* name) { return StatOf(receiver.source(), name); };
  // If the changed bit is in the type or the serial number, the packet is counted differently.
  const auto refused = [&] {
    return stat("packets-damaged") + stat("packets-wrong-size") + stat("packets-foreign");
  };
  EXPECT_TRUE(receiver.PullUntil(
      [&](GstBuffer*) { return refused() + stat("dropped-by-kernel") >= corrupted; }));
  EXPECT_LE(refused(), corrupted);
  EXPECT_GE(stat("packets-damaged") * 25, refused() * 24);
}

guint64 Reconnects(Receiver& receiver) { return StatOf(receiver.source(), "reconnects"); }

TEST(OusterLive, ASensorThatFellSilentIsWaitedFor) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "udp-dest=@auto", {FreePort(), FreePort()},
                    Receiver::Clock::kTest);
  ASSERT_TRUE(receiver.AwaitConnected(true));
  for (const guint times : {1U, 2U}) {
    const auto silenced = [&] { return sensor.counts().silenced; };
    sensor.Fault({{"silent", true}});
    ASSERT_TRUE(Eventually([&, before = silenced()] { return silenced() > before; }));
    ASSERT_TRUE(receiver.PassUntilDisconnected());
    receiver.Drain();
    EXPECT_EQ(Reconnects(receiver), times - 1);
    sensor.Fault({{"silent", false}});
    ASSERT_TRUE(receiver.AwaitConnected(true));
    EXPECT_TRUE(Eventually([&] { return Reconnects(receiver) == times; }));
    EXPECT_TRUE(receiver.Pull());
  }
}

TEST(OusterLive, WithoutReconnectASilentSensorIsAnError) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "udp-dest=@auto reconnect=false");
  ASSERT_TRUE(receiver.Pull());
  sensor.Fault({{"silent", true}});
  const std::string error = receiver.AwaitError();
  EXPECT_NE(error.find("No packets from the sensor"), std::string::npos) << error;
}

TEST(OusterLive, GoesOnAfterARestartWithScansAndTimesThatGoOn) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "udp-dest=@auto");
  GstLidarSlice last{};
  GstClockTime last_pts = 0;
  const auto note = [&](GstBuffer* buffer) {
    GstLidarSlice slice{};
    gst_lidar_buffer_get_slice(buffer, &slice);
    EXPECT_GE(slice.scan_id, last.scan_id);
    EXPECT_GE(GST_BUFFER_PTS(buffer), last_pts);
    last = slice;
    last_pts = GST_BUFFER_PTS(buffer);
    return slice.scan_id > 3;
  };
  ASSERT_TRUE(receiver.PullUntil(note));
  sensor.state().Restart();
  const MessagePtr changed = receiver.Await("ouster-metadata-changed");
  ASSERT_TRUE(changed);
  const guint before = last.scan_id;
  ASSERT_TRUE(receiver.PullUntil([&](GstBuffer* buffer) {
    note(buffer);
    return last.scan_id > before + 3;
  }));
}

TEST(OusterLive, TakesANewGeometryWhenSomeoneElseReconfigures) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "udp-dest=@auto slices-per-scan=8");
  const BufferPtr first = receiver.Pull();
  ASSERT_TRUE(first);
  const gsize size = gst_buffer_get_size(first.get());
  EXPECT_EQ(receiver.Info().sensor_model->columns_per_scan, 512U);
  EXPECT_TRUE(receiver.AwaitLatency());
  const auto slices = [&] { return StatOf(receiver.source(), "slices"); };
  constexpr guint64 kBefore = 20;
  ASSERT_TRUE(receiver.PullUntil([&](GstBuffer*) { return slices() > kBefore; }));
  ASSERT_EQ(sensor.state().SetConfig(
                {{"lidar_mode", "1024x10"}, {"udp_profile_lidar", "RNG19_RFL8_SIG16_NIR16_DUAL"}},
                {false, true}, "127.0.0.1"),
            "");
  // The caps of the pad may be newer than a buffer that was pulled. Therefore the size of the
  // buffer tells its geometry.
  bool discont = false;
  ASSERT_TRUE(receiver.PullUntil([&](GstBuffer* buffer) {
    discont = GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_DISCONT);
    return gst_buffer_get_size(buffer) != size;
  }));
  EXPECT_TRUE(discont);
  EXPECT_TRUE(receiver.AwaitLatency()) << "slices are twice as long";
  EXPECT_GT(slices(), kBefore) << "of both geometries";
  EXPECT_EQ(receiver.Info().sensor_model->columns_per_scan, 1024U);
  EXPECT_EQ(receiver.Info().ScanDuration(), 100 * GST_MSECOND);
}

/// The socket's buffer overflows while the element is paused. After that the sensor sends to
/// another port.
TEST(OusterLive, WhatTheKernelDroppedStaysCountedOnAnotherPort) {
  SoftwareSensor sensor({});
  const auto send_to = [&](guint16 port) {
    EXPECT_EQ(sensor.state().SetConfig({{"udp_port_lidar", port}, {"udp_dest", "127.0.0.1"}},
                                       {false, true}, "127.0.0.1"),
              "");
  };
  send_to(FreePort());
  Receiver receiver(sensor.host(), "lidar-port=0 imu=false buffer-size=32768");
  ASSERT_TRUE(receiver.Pull());
  receiver.SetState(GST_STATE_PAUSED);
  const auto sent = [&] { return sensor.counts().sent; };
  const auto before = sent();
  // The buffer of the socket has room for fewer than 20 packets, so most of 100 packets are
  // dropped.
  ASSERT_TRUE(Eventually([&] { return sent() > before + 100; }));
  receiver.SetState(GST_STATE_PLAYING);
  const auto dropped = [&] { return StatOf(receiver.source(), "dropped-by-kernel"); };
  ASSERT_TRUE(Eventually([&] { return dropped() > 0; }));
  receiver.Await("ouster-metadata-changed");
  send_to(FreePort());
  ASSERT_TRUE(receiver.Await("ouster-metadata-changed"));
  receiver.Drain();
  ASSERT_TRUE(receiver.Pull());
  EXPECT_GT(dropped(), 0U);
}

TEST(OusterLive, TheImuIsFollowedToAnotherPort) {
  SoftwareSensor sensor({});
  const auto send_to = [&](guint16 imu_port) {
    EXPECT_EQ(sensor.state().SetConfig({{"udp_port_imu", imu_port}, {"udp_dest", "127.0.0.1"}},
                                       {false, true}, "127.0.0.1"),
              "");
  };
  send_to(FreePort());
  Receiver receiver(sensor.host(), "", {FreePort(), 0});
  const auto samples = [&] { return StatOf(receiver.source(), "packets-imu"); };
  ASSERT_TRUE(receiver.Await("ouster-metadata-changed"));
  ASSERT_TRUE(receiver.PullUntil([&](GstBuffer*) { return samples() > 0; }));
  send_to(FreePort());
  ASSERT_TRUE(receiver.Await("ouster-metadata-changed"));
  const guint64 before = samples();
  EXPECT_TRUE(receiver.PullUntil([&](GstBuffer*) { return samples() > before + 10; }));
}

TEST(OusterLive, APauseIsNoLossAndLeavesNothingOldBehind) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "udp-dest=@auto");
  ASSERT_TRUE(receiver.Pull());
  const auto lost = StatOf(receiver.source(), "packets-lost");
  receiver.SetState(GST_STATE_PAUSED);
  receiver.Drain();
  g_usleep(1'500'000);
  const auto resumed = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
  receiver.SetState(GST_STATE_PLAYING);
  for (int i = 0; i < 20; ++i) {
    const BufferPtr buffer = receiver.Pull();
    ASSERT_TRUE(buffer);
    // The first slices may contain packets that were read before the pause.
    if (i < 8) continue;
    EXPECT_GT(gst_lidar_buffer_get_capture_time(buffer.get()), resumed - 200 * GST_MSECOND) << i;
  }
  EXPECT_EQ(StatOf(receiver.source(), "packets-lost"), lost);
  EXPECT_EQ(Reconnects(receiver), 0U);
}

TEST(OusterLive, WaitsForASensorThatIsSwitchedOffForAWhile) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "");
  const auto send_to = [&](const char* destination) {
    EXPECT_EQ(sensor.state().SetConfig({{"udp_dest", destination}}, {false, true}, ""), "");
  };
  EXPECT_NE(receiver.AwaitError().find("switched off"), std::string::npos);
  Receiver second(sensor.host(), "udp-dest=@auto");
  ASSERT_TRUE(second.AwaitConnected(true));
  send_to("");
  ASSERT_TRUE(second.AwaitConnected(false));
  ASSERT_TRUE(second.AwaitConnected(true));
}

TEST(OusterLive, ASensorThatWasNeverOnIsAnErrorAlsoWithAMetadataFile) {
  SoftwareSensor sensor({});
  const std::string path = ::testing::TempDir() + "ouster_off.json";
  std::ofstream(path) << sensor.state().MetadataJson();
  Receiver receiver(sensor.host(), "metadata=" + path);
  EXPECT_NE(receiver.AwaitError().find("switched off"), std::string::npos);
  std::remove(path.c_str());
}

TEST(OusterLive, WaitsForASensorWhoseApiFails) {
  SoftwareSensor sensor({});
  sensor.Fault({{"http_status", 500}});
  Receiver receiver(sensor.host(), "udp-dest=@auto");
  ASSERT_TRUE(receiver.AwaitConnected(false));
  sensor.Fault({{"http_status", 0}});
  EXPECT_TRUE(receiver.AwaitConnected(true));
}

TEST(OusterLive, WarnsOfEachTimeThatTheApiFails) {
  SoftwareSensor sensor({});
  sensor.Fault({{"http_status", 500}});
  Receiver receiver(sensor.host(), "udp-dest=@auto");
  for (int times = 0; times < 2; ++times) {
    EXPECT_TRUE(receiver.AwaitWarning("Cannot talk to the sensor"));
    sensor.Fault({{"http_status", 0}, {"silent", false}});
    ASSERT_TRUE(receiver.AwaitConnected(true));
    sensor.Fault({{"http_status", 500}, {"silent", true}});
  }
}

TEST(OusterLive, WithoutReconnectAnApiThatFailsIsAnError) {
  SoftwareSensor sensor({});
  sensor.Fault({{"http_status", 503}});
  Receiver receiver(sensor.host(), "reconnect=false");
  const std::string error = receiver.AwaitError();
  EXPECT_NE(error.find("503"), std::string::npos) << error;
  EXPECT_EQ(error.find("firmware"), std::string::npos) << error;
}

TEST(OusterLive, PacketsOfARestartedSensorAreTakenWhereItsApiIsDown) {
  SoftwareSensor sensor({});
  Receiver receiver(sensor.host(), "udp-dest=@auto");
  ASSERT_TRUE(receiver.Pull());
  sensor.Fault({{"http_status", 500}});
  sensor.state().Restart();
  ASSERT_TRUE(receiver.PullUntil([](GstBuffer* buffer) {
    return GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_DISCONT) != FALSE;
  }));
  // The errors of the API must not count as a lost connection. The first lost connection is that of
  // the silent sensor.
  sensor.Fault({{"silent", true}});
  std::string reason;
  for (gboolean connected = TRUE; connected != FALSE;) {
    const MessagePtr message = receiver.Await("ouster-connection-changed");
    ASSERT_TRUE(message);
    const GstStructure* s = gst_message_get_structure(message.get());
    gst_structure_get_boolean(s, "connected", &connected);
    reason = gst_structure_get_string(s, "reason");
  }
  EXPECT_EQ(reason.rfind("no packets", 0), 0U) << reason;
}

TEST(OusterLive, StopsAtOnceWhileTheApiIsSlow) {
  SoftwareSensor sensor({});
  sensor.Fault({{"http_delay_ms", 60'000}});
  const gint64 start = g_get_monotonic_time();
  { Receiver receiver(sensor.host(), "udp-dest=@auto"); }
  EXPECT_LT(g_get_monotonic_time() - start, 30 * G_USEC_PER_SEC);
}

/// An HTTP server at a sensor's address that is not a sensor.
class Impostor {
 public:
  explicit Impostor(tools::HttpServer::Handler handler)
      : server_("127.0.0.1", 0, std::move(handler)) {}
  std::string host() const { return "127.0.0.1:" + std::to_string(server_.port()); }

 private:
  tools::HttpServer server_;
};

TEST(OusterLive, MetadataThatMakesNoSenseIsAClearError) {
  const Impostor impostor([](const tools::HttpRequest&) {
    return tools::HttpReply{200, R"({"lidar_data_format": {"columns_per_packet": 0}})", {}};
  });
  const std::string error =
      RunToEnd("ouster_src reconnect=false hostname=" + impostor.host() + " ! fakesink");
  EXPECT_NE(error.find("the sensor's metadata cannot be used"), std::string::npos) << error;
}

TEST(OusterLive, ASensorThatDoesNotSayWhereItSendsIsAClearError) {
  const Impostor impostor([](const tools::HttpRequest&) {
    return tools::HttpReply{200, R"({"udp_port_lidar": 7502})", {}};
  });
  Receiver receiver(impostor.host(), "udp-dest=@auto reconnect=false");
  const std::string error = receiver.AwaitError();
  EXPECT_NE(error.find("does not report the udp_dest that it chose"), std::string::npos) << error;
}

/// Unlike ouster-replay, old firmware accepts texts only without quotes.
TEST(OusterLive, AsksOldFirmwareForWhatIsActiveAndSetsTextsWithoutQuotes) {
  std::string config;
  std::string set;
  const Impostor impostor([&](const tools::HttpRequest& request) {
    const auto args = request.query.find("args");
    if (args == request.query.end()) return tools::HttpReply{404, {}, {}};
    const bool sets = request.path.find("set_config_param") != std::string::npos;
    (sets ? set : config) = args->second;
    return tools::HttpReply{sets ? 400 : 200, "{}", {}};
  });
  std::string error;
  {
    Receiver receiver(impostor.host(), "lidar-mode=512x10");
    error = receiver.AwaitError();
  }
  EXPECT_NE(error.find("the sensor does not accept the configuration"), std::string::npos) << error;
  EXPECT_EQ(config, "active");
  EXPECT_EQ(set, "lidar_mode 512x10");
}

TEST(OusterLive, FollowsNoRedirect) {
  std::atomic<int> visits{0};
  const Impostor target([&](const tools::HttpRequest&) {
    ++visits;
    return tools::HttpReply{};
  });
  const Impostor impostor([&](const tools::HttpRequest&) {
    return tools::HttpReply{302, {}, "http://" + target.host() + "/"};
  });
  Receiver receiver(impostor.host(), "reconnect=false");
  const std::string error = receiver.AwaitError();
  EXPECT_NE(error.find("302"), std::string::npos) << error;
  EXPECT_EQ(visits, 0);
}

/// Sets an environment variable, and restores its old value at the end of the lifetime.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const gchar* before = g_getenv(name)) before_ = before;
    g_setenv(name, value, TRUE);
  }
  ~Variable() {
    if (before_)
      g_setenv(name_, before_->c_str(), TRUE);
    else
      g_unsetenv(name_);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* const name_;
  std::optional<std::string> before_;
};

TEST(OusterLive, AsksItsSensorWithoutTheProxyOfTheEnvironment) {
  const Variable proxy("http_proxy", "http://127.0.0.1:1");
  const Variable lower("no_proxy", "");
  const Variable upper("NO_PROXY", "");
  const Impostor impostor([](const tools::HttpRequest&) { return tools::HttpReply{404, {}, {}}; });
  Receiver receiver(impostor.host(), "reconnect=false");
  const std::string error = receiver.AwaitError();
  EXPECT_NE(error.find("answers with HTTP status 404"), std::string::npos) << error;
}

TEST(OusterLive, AnAnswerOfMoreThanAMebibyteIsCutOff) {
  const Impostor impostor([](const tools::HttpRequest&) {
    return tools::HttpReply{200, std::string(16U << 20, ' '), {}};
  });
  Receiver receiver(impostor.host(), "reconnect=false");
  const std::string error = receiver.AwaitError();
  EXPECT_NE(error.find("Cannot talk to the sensor"), std::string::npos) << error;
}

}  // namespace
}  // namespace lidar::test
