// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of ouster_src that receives from sockets.
#include <atomic>
#include <cstring>
#include <fstream>
#include <functional>
#include <set>

#include "tests/elements/ouster/ouster_support.h"
#include "tests/support/clock_wait.h"
#include "tests/support/element_stats.h"
#include "tests/support/files.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

using gst::BufferPtr;

const char* const kCapture = "OS-1-128_v2.3.0_1024x10_lb_n3.pcap";
const char* const kJson = "OS-1-128_v2.3.0_1024x10.json";

class OusterUdp : public ::testing::Test {
 protected:
  Harness Play(const char* json, const char* more = "") {
    port_ = FreePort();
    const std::string launch = "ouster_src name=src lidar-port=" + std::to_string(port_) +
                               " imu-port=" + std::to_string(FreePort()) +
                               " metadata=" + DataPath(json) + " " + more;
    Harness h(gst_harness_new_parse(launch.c_str()));
    gst_harness_use_systemclock(h.get());
    SetPlaying(h.get());
    sender_ = std::make_unique<UdpSender>(port_);
    return h;
  }
  guint16 port_ = 0;
  std::unique_ptr<UdpSender> sender_;
  const ouster::Metadata metadata_ = LoadMetadata(kJson);
  const std::vector<std::vector<std::uint8_t>> packets_ = LoadPackets(kCapture, metadata_);
};

TEST_F(OusterUdp, GivesASliceOnceItsLastPacketCame) {
  const Harness h = Play(kJson);
  for (std::size_t i = 0; i < 16; ++i) {
    sender_->Send(packets_[i]);
    if (i % 8 != 7) continue;
    const BufferPtr buffer(gst_harness_pull(h.get()));
    ASSERT_TRUE(buffer);
    GstLidarSlice slice{};
    ASSERT_TRUE(gst_lidar_buffer_get_slice(buffer.get(), &slice));
    EXPECT_EQ(slice.slice_index, i / 8);
    // If the sensor does not use PTP, the capture time is derived from the time of arrival.
    const auto now = static_cast<gint64>(g_get_real_time()) * 1000;
    const auto age = now - static_cast<gint64>(gst_lidar_buffer_get_capture_time(buffer.get()));
    EXPECT_GT(age, 0);
    EXPECT_LT(age, 5 * static_cast<gint64>(GST_SECOND));
  }
  EXPECT_EQ(gst_harness_query_latency(h.get()), 12500 * GST_USECOND);
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 2U);
}

/// Sends slices whose times are those of now. The element uses these times, except those of a slice
/// that arrives a second later, because then the clock counts as not synchronised.
TEST_F(OusterUdp, TheCaptureTimeOfASensorOnPtpIsTrueUtc) {
  const TempFolder folder;
  const std::string path = folder.path() + "/ptp.json";
  std::string json = ReadFile(DataPath(kJson));
  const std::string from = "\"base_pn\": \"\",";
  json.replace(json.find(from), from.size(),
               R"("config_params": {"timestamp_mode": "TIME_FROM_PTP_1588"},)");
  std::ofstream(path) << json;
  const Harness h = Play(kJson, ("metadata=" + path).c_str());
  const gst::ElementPtr source(gst_bin_get_by_name(GST_BIN(h->element), "src"));
  const auto& format = metadata_.format;
  const auto time_at = [&](std::vector<std::uint8_t>& packet, std::uint32_t column) {
    return &packet[format.packet_header_size() + column * format.column_size()];
  };
  std::set<guint64> sent;
  bool is_utc = false;
  for (std::size_t first = 0; first < packets_.size() && !is_utc; first += 8) {
    const guint64 utc = static_cast<guint64>(g_get_real_time()) * GST_USECOND;
    guint64 shift = 0;
    for (std::size_t i = first; i < first + 8; ++i) {
      auto packet = packets_[i];
      for (std::uint32_t column = 0; column < format.columns_per_packet; ++column) {
        guint64 time = 0;
        std::memcpy(&time, time_at(packet, column), sizeof time);
        if (i == first && column == 0) shift = utc + 37 * GST_SECOND - time;
        time += shift;
        std::memcpy(time_at(packet, column), &time, sizeof time);
      }
      sender_->Send(packet);
    }
    sent.insert(utc);
    const BufferPtr buffer(gst_harness_pull(h.get()));
    ASSERT_TRUE(buffer);
    is_utc = sent.count(gst_lidar_buffer_get_capture_time(buffer.get())) == 1 &&
             StatOf(source.get(), "clock-synchronised") == 1;
  }
  EXPECT_TRUE(is_utc);
}

TEST_F(OusterUdp, CountsWhatDoesNotFitAndGoesOn) {
  const Harness h = Play(kJson);
  const gst::ElementPtr found(gst_bin_get_by_name(GST_BIN(h->element), "src"));
  GstElement* source = found.get();
  auto foreign = packets_[0];
  foreign[ouster::kStandardHeader.serial] ^= 0xff;
  sender_->Send(foreign);
  sender_->Send(std::vector<std::uint8_t>(100));
  sender_->Send(std::vector<std::uint8_t>(1));
  for (std::size_t i = 0; i < 8; ++i) sender_->Send(packets_[i]);
  const BufferPtr buffer(gst_harness_pull(h.get()));
  ASSERT_TRUE(buffer);
  for (std::size_t i = 8; i < 16; ++i) sender_->Send(packets_[i]);
  const BufferPtr next(gst_harness_pull(h.get()));
  EXPECT_EQ(StatOf(source, "packets-foreign"), 1U);
  EXPECT_EQ(StatOf(source, "packets-wrong-size"), 2U);
  EXPECT_GE(StatOf(source, "packets"), 8U);
  EXPECT_EQ(StatOf(source, "packets-lost"), 0U);
}

TEST_F(OusterUdp, GoesOnWithASensorThatRestarted) {
  const Harness h = Play(kJson);
  for (std::size_t i = 0; i < 8; ++i) sender_->Send(packets_[i]);
  const BufferPtr before(gst_harness_pull(h.get()));
  for (std::size_t i = 0; i < 8; ++i) {
    auto packet = packets_[i];
    packet[ouster::kStandardHeader.init_id] ^= 0x55;
    packet[ouster::kStandardHeader.frame_id] = 0;
    sender_->Send(packet);
  }
  const BufferPtr after(gst_harness_pull(h.get()));
  ASSERT_TRUE(after);
  GstLidarSlice slice{};
  gst_lidar_buffer_get_slice(after.get(), &slice);
  EXPECT_EQ(slice.scan_id, 1U);
  EXPECT_TRUE(GST_BUFFER_FLAG_IS_SET(after.get(), GST_BUFFER_FLAG_DISCONT));
  EXPECT_GE(GST_BUFFER_PTS(after.get()), GST_BUFFER_PTS(before.get()));
}

TEST_F(OusterUdp, ASmallReceiveBufferIsWarnedOfWithTheRemedy) {
  // The size is more than the kernel allows even for root.
  const std::string launch =
      "ouster_src buffer-size=2147483647 lidar-port=" + std::to_string(FreePort()) +
      " imu=false metadata=" + DataPath(kJson) + " ! fakesink";
  const gst::ElementPtr pipeline(gst_parse_launch(launch.c_str(), nullptr));
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  const ElementBus bus(pipeline.get());
  const gst::MessagePtr warning = bus.Wait(GST_MESSAGE_WARNING);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  ASSERT_TRUE(warning);
  const std::string text = TextOf(warning.get());
  EXPECT_NE(text.find("granted a receive buffer of"), std::string::npos) << text;
  EXPECT_NE(text.find("sysctl -w net.core.rmem_max=2147483647"), std::string::npos) << text;
}

/// Packets of old firmware have no serial number, so sensors are distinguished by their addresses.
TEST_F(OusterUdp, TellsSensorsWithoutSerialNumbersByTheirAddresses) {
  const ouster::Metadata legacy = LoadMetadata("OS-1-32-G_v2.1.1_1024x10.json");
  const auto packets = LoadPackets("OS-1-32-G_v2.1.1_1024x10.pcap", legacy);
  for (const char* address : {"", "address=0.0.0.0"}) {
    const Harness h = Play("OS-1-32-G_v2.1.1_1024x10.json", address);
    const gst::ElementPtr source(gst_bin_get_by_name(GST_BIN(h->element), "src"));
    UdpSender other(port_, "127.0.0.2");
    const auto stat = [&](const char* name) { return StatOf(source.get(), name); };
    // The other sensor is foreign only within a second after a packet of the first sensor.
    sender_->Send(packets[0]);
    other.Send(packets[0]);
    EXPECT_TRUE(Eventually([&] { return stat("packets") + stat("packets-foreign") == 2; }));
    EXPECT_EQ(stat("packets-foreign"), 1U) << address;
  }
}

TEST_F(OusterUdp, StopsWhileItWaitsForPackets) {
  const Harness h = Play(kJson);
  EXPECT_EQ(gst_element_set_state(h->element, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
}

/// A clock that returns the result of a function.
struct CalledClock {
  GstClock parent;
  std::function<GstClockTime()>* read;
};
struct CalledClockClass {
  GstClockClass parent;
};
G_DEFINE_TYPE(CalledClock, called_clock, GST_TYPE_CLOCK)
void called_clock_init(CalledClock*) {}
void called_clock_class_init(CalledClockClass* klass) {
  GST_CLOCK_CLASS(klass)->get_internal_time = [](GstClock* clock) {
    return (*reinterpret_cast<CalledClock*>(clock)->read)();
  };
}

/// A fixture with a sensor whose silence is measured by a test clock.
class OusterOnTestClock : public OusterUdp {
 protected:
  OusterOnTestClock() : imu_(imu_port_) {
    port_ = FreePort();
    h_.reset(gst_harness_new_parse(("ouster_src name=src lidar-port=" + std::to_string(port_) +
                                    " imu-port=" + std::to_string(imu_port_) +
                                    " metadata=" + DataPath(kJson))
                                       .c_str()));
    source_.reset(gst_bin_get_by_name(GST_BIN(h_->element), "src"));
    bus_.emplace(h_->element);
    UseTestClock(h_.get());
    Pass(3600 * GST_SECOND);  // later than running time 0, because earlier packets are dropped
    SetPlaying(h_.get());
    sender_ = std::make_unique<UdpSender>(port_);
  }
  void Pass(GstClockTime time) { gst_harness_set_time(h_.get(), now_ += time); }
  void Send(std::size_t packets) {
    for (std::size_t i = 0; i < packets; ++i) sender_->Send(packets_[sent_++]);
    EXPECT_TRUE(Eventually([this] { return StatOf(source_.get(), "packets") == sent_; }));
  }
  /// Sends a packet of the IMU first, because such packets must not end a silence. Returns true if
  /// the element reports no silence.
  bool IsNotReported() {
    const auto taken = [this] { return StatOf(source_.get(), "packets-imu"); };
    const std::vector<std::uint8_t> packet(metadata_.imu_packet_size());
    // The element reads the clock before it waits for a packet, so the first packet may end a wait
    // that began at an earlier time.
    for (int i = 0; i < 2; ++i) {
      const guint64 before = taken();
      EXPECT_TRUE(Eventually([&] {
        imu_.Send(packet);
        return taken() > before;
      }));
    }
    bool reported = false;
    while (const gst::MessagePtr message = bus_->Pop(GST_MESSAGE_WARNING | GST_MESSAGE_ELEMENT)) {
      gboolean connected = TRUE;
      const GstStructure* s = gst_message_get_structure(message.get());
      if (gst_message_has_name(message.get(), "ouster-connection-changed"))
        gst_structure_get_boolean(s, "connected", &connected);
      reported = reported || !connected || GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_WARNING;
    }
    return !reported;
  }
  bool IsReported() {
    const gst::MessagePtr message = bus_->Wait(GST_MESSAGE_WARNING);
    return message && MessageText(message.get()).rfind("No packets from the sensor", 0) == 0;
  }

  static constexpr std::size_t kPacketsOfSlice = 8;
  const guint16 imu_port_ = FreePort();
  GstClockTime now_ = kClockStart;
  std::size_t sent_ = 0;
  Harness h_;
  gst::ElementPtr source_;
  std::optional<ElementBus> bus_;
  UdpSender imu_;
};

TEST_F(OusterOnTestClock, PacketsOfAnotherSizeAreCountedAndWarnedOf) {
  for (int i = 0; i < 6; ++i) sender_->Send(std::vector<std::uint8_t>(6464));
  const gst::MessagePtr warning = bus_->Wait(GST_MESSAGE_WARNING);
  ASSERT_TRUE(warning);
  const std::string text = TextOf(warning.get());
  EXPECT_NE(text.find("Packets of 6464 bytes arrive, but the metadata describes packets of"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("is the metadata (serial number"), std::string::npos) << text;
  Send(kPacketsOfSlice);
  const BufferPtr buffer(gst_harness_pull(h_.get()));
  EXPECT_TRUE(buffer);
  EXPECT_EQ(StatOf(source_.get(), "packets-wrong-size"), 6U);
}

TEST_F(OusterOnTestClock, PacketsOfAnotherSizeBetweenGoodOnesAreOnlyCounted) {
  constexpr std::size_t kRounds = 16;
  for (std::size_t i = 0; i < kRounds; ++i) {
    sender_->Send(std::vector<std::uint8_t>(6464));
    Send(1);
  }
  EXPECT_EQ(StatOf(source_.get(), "packets-wrong-size"), kRounds);
  EXPECT_EQ(bus_->Texts(GST_MESSAGE_WARNING), std::vector<std::string>());
}

using OusterSilence = OusterOnTestClock;

TEST_F(OusterSilence, IsReportedAfterThreeSecondsAtTheStartAndOneLaterOn) {
  Pass(2'900 * GST_MSECOND);
  EXPECT_TRUE(IsNotReported());
  Send(kPacketsOfSlice);
  Pass(900 * GST_MSECOND);
  EXPECT_TRUE(IsNotReported());
  Pass(100 * GST_MSECOND);
  EXPECT_TRUE(IsReported());
}

TEST_F(OusterSilence, AtTheStartIsReportedToo) {
  EXPECT_TRUE(IsNotReported());
  Pass(3 * GST_SECOND);
  EXPECT_TRUE(IsReported());
}

TEST_F(OusterSilence, IsReportedEachTimeAndOnce) {
  for (int times = 0; times < 3; ++times) {
    Send(kPacketsOfSlice);
    Pass(GST_SECOND);
    ASSERT_TRUE(IsReported()) << times;
    Pass(10 * GST_SECOND);
    EXPECT_TRUE(IsNotReported()) << times;
  }
}

TEST_F(OusterSilence, DoesNotBeginInAPause) {
  Send(kPacketsOfSlice / 2);
  gst_element_set_state(h_->element, GST_STATE_PAUSED);
  Send(kPacketsOfSlice / 2);  // the source reads these packets after the pause
  Pass(10 * GST_SECOND);
  SetPlaying(h_.get());
  EXPECT_TRUE(IsNotReported());
  Pass(900 * GST_MSECOND);
  EXPECT_TRUE(IsNotReported());
  Pass(100 * GST_MSECOND);
  EXPECT_TRUE(IsReported());
}

/// A second passes before each read of the clock, as on a machine that stops the element's thread,
/// but a packet arrives before the second is over.
TEST_F(OusterSilence, IsNotReportedWhilePacketsWaitInTheSocket) {
  Send(1);
  std::atomic<std::size_t> sent = 1;
  std::function<GstClockTime()> read = [&] {
    if (sent == 40) return now_;
    sender_->Send(packets_[sent++]);
    return now_ += GST_SECOND;
  };
  const std::unique_ptr<GstClock, gst::Unref> clock(
      GST_CLOCK(g_object_new(called_clock_get_type(), nullptr)));
  reinterpret_cast<CalledClock*>(clock.get())->read = &read;
  gst_element_set_clock(h_->element, clock.get());
  EXPECT_TRUE(Eventually([&] { return sent == 40; }));
  EXPECT_TRUE(IsNotReported());
  gst_element_set_state(h_->element, GST_STATE_NULL);
}

TEST_F(OusterUdp, LeavesNoFileOpen) {
  const Harness h = Play(kJson);
  gst_element_set_state(h->element, GST_STATE_NULL);
  const auto before = OpenFiles();
  for (int i = 0; i < 3; ++i) {
    SetPlaying(h.get());
    gst_element_set_state(h->element, GST_STATE_NULL);
  }
  EXPECT_EQ(OpenFiles(), before);
}

TEST_F(OusterUdp, APortInUseIsAClearError) {
  GSocket* other =
      g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP, nullptr);
  GSocketAddress* any = g_inet_socket_address_new_from_string("0.0.0.0", 0);
  ASSERT_TRUE(g_socket_bind(other, any, FALSE, nullptr));
  GSocketAddress* bound = g_socket_get_local_address(other, nullptr);
  const auto port = std::to_string(g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(bound)));
  const std::string error =
      RunToEnd("ouster_src lidar-port=" + port + " metadata=" + DataPath(kJson) + " ! fakesink");
  for (gpointer object :
       {static_cast<gpointer>(bound), static_cast<gpointer>(any), static_cast<gpointer>(other)})
    g_object_unref(object);
  EXPECT_NE(error.find(port), std::string::npos) << error;
  EXPECT_NE(error.find("another program"), std::string::npos) << error;
}

}  // namespace
}  // namespace lidar::test
