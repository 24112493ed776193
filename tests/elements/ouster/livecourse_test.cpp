// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what a live ouster_src outputs and posts in a scripted run with a golden file.
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstring>
#include <filesystem>

#include "tests/elements/ouster/ouster_support.h"
#include "tests/support/clock_wait.h"
#include "tests/support/golden_course.h"

namespace lidar::test {
namespace {

/// A sensor with 32 beams. A scan has 64 packets of 16 columns each.
class PacketSensor {
 public:
  using Packet = std::vector<std::uint8_t>;
  static constexpr const char* kName = "OS-0-32-U1_v2.2.0_1024x10";

  PacketSensor(Course* course, guint16 port, guint16 imu_port)
      : course_(*course), lidar_(port), imu_(imu_port) {
    std::string error;
    const std::string capture = kName + std::string(".pcap");
    auto reader = ouster::PcapReader::Open(DataPath(capture), &error);
    while (auto captured = reader->Next())
      if (captured->datagram.payload.size() != metadata_.format.packet_size())
        imu_packets_.push_back(std::move(captured->datagram.payload));
    packets_ = LoadPackets(capture, metadata_);
  }

  /// Returns packet `number` of the captured scan, changed so that it belongs to the scan `scan`
  /// periods later.
  Packet PacketOf(std::size_t number, guint scan) const {
    constexpr std::size_t kColumns = 16, kHeader = 32, kPeriodNs = 100'000'000;
    Packet packet = packets_[number];
    packet[kFrame] = static_cast<std::uint8_t>(packet[kFrame] + scan);
    packet[kStart] = static_cast<std::uint8_t>(packet[kStart] ^ starts_);
    for (std::size_t c = 0; c < kColumns; ++c) {
      std::uint8_t* column = &packet[kHeader + c * (packet.size() - 2 * kHeader) / kColumns];
      guint64 t = 0;
      std::memcpy(&t, column, sizeof t);
      t += scan * kPeriodNs;
      std::memcpy(column, &t, sizeof t);
    }
    return packet;
  }
  /// Sends the packets of a scan, except for those from `lost` up to but not including `found`.
  /// Waits after each slice, so that the buffer of the socket does not overflow.
  void Send(guint scan, std::size_t from, std::size_t to, std::size_t lost = 0,
            std::size_t found = 0) {
    for (std::size_t i = from; i < to; ++i) {
      if (i < lost || i >= found) SendCounted(PacketOf(i, scan));
      if (i % kOfSlice == kOfSlice - 1) AwaitTaken();
    }
  }
  void AwaitTaken() { course_.AwaitStat("packets", sent_); }
  void SendScan(const char* what, guint scan, std::size_t lost = 0, std::size_t found = 0) {
    Send(scan, 0, packets_.size(), lost, found);
    Note(what);
  }
  void Note(const char* what) { course_.Await(what, "buffer", packets_.size() / kOfSlice); }
  void SendCounted(const Packet& packet) {
    lidar_.Send(packet);
    ++sent_;
  }
  void SendOther(const Packet& packet) { lidar_.Send(packet); }
  /// Sends `count` packets whose size is wrong.
  void SendShort(guint64 count) {
    for (guint64 i = 0; i < count; ++i) SendOther(Packet(1'000));
    short_ += count;
    course_.AwaitStat("packets-wrong-size", short_);
  }
  void SendImu() { imu_.Send(imu_packets_.front()); }
  void BeginAnew() { sent_ = short_ = 0; }
  void Restart() { ++starts_; }

  static constexpr std::size_t kOfSlice = 8, kFrame = 2, kStart = 4, kSerial = 7;

 private:
  Course& course_;
  UdpSender lidar_;
  UdpSender imu_;
  const ouster::Metadata metadata_ = LoadMetadata(kName + std::string(".json"));
  std::vector<Packet> packets_;
  std::vector<Packet> imu_packets_;
  std::uint8_t starts_ = 0;
  std::size_t sent_ = 0;
  guint64 short_ = 0;
};

/// Switches off the kernel's arrival times on the sockets of `port`. These times come from the real
/// clock, but all other times of the test come from the test clock.
void LeaveOutArrivals(guint port) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int fd = std::stoi(entry.path().filename());
    sockaddr_in address{};
    socklen_t size = sizeof address;
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
        address.sin_port != htons(static_cast<guint16>(port)))
      continue;
    const int off = 0;
    EXPECT_EQ(setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &off, sizeof off), 0);
  }
}

void LiveCourse(Course& c) {
  guint port = 0;
  guint imu_port = 0;
  g_object_get(c.element(), "lidar-port", &port, "imu-port", &imu_port, nullptr);
  UseTestClock(c.harness());
  // Later than running time 0, because earlier packets are dropped.
  GstClockTime now = kClockStart + 3600 * GST_SECOND;
  gst_harness_set_time(c.harness(), now);
  // Arrival times differ between runs.
  c.Hide("buffer at [0-9]+", "buffer");
  // Another thread posts this message, so its position among the events varies.
  c.Hide("message latency ", "");
  c.Hide("position [0-9]+", "position");
  c.Hide(", clock-jumps=.guint64.[0-9]+", "");
  c.Hide("captured (at )?-?[0-9]+", "captured");
  c.Hide(", receive-buffer=.uint.[0-9]+", "");
  c.Hide("UDP port [0-9]+", "its UDP port");
  c.Hide("[0-9]+ ms", "some time");
  c.trace()->TakeAddedPads();
  PacketSensor sensor(&c, static_cast<guint16>(port), static_cast<guint16>(imu_port));
  const auto play = [&](const char* what) {
    gst_element_set_state(c.element(), GST_STATE_PLAYING);
    sensor.BeginAnew();
    LeaveOutArrivals(port);
    c.Await(what, "event stream-start");
  };
  // The clock advances only here. Therefore a busy machine that delays the test causes no silence.
  // An incomplete slice is output after the message about the silence.
  const auto be_silent = [&](const char* line, std::size_t buffers = 0) {
    sensor.AwaitTaken();
    EXPECT_TRUE(Eventually([&] {
      gst_harness_set_time(c.harness(), now += GST_SECOND);
      return c.trace()->Count(line) > 0;
    }));
    c.Await("silence", "buffer", buffers);
  };
  c.Ask();
  play("play");
  sensor.SendScan("a scan", 0);
  sensor.SendShort(3);
  sensor.SendImu();
  c.AwaitStat("packets-imu", 1);
  c.Await("a packet of the IMU", "buffer");
  sensor.SendScan("with a slice that lacks two packets", 1, 9, 11);
  sensor.SendShort(3);
  sensor.Send(2, 0, 8);
  sensor.SendCounted(sensor.PacketOf(7, 2));
  PacketSensor::Packet other = sensor.PacketOf(8, 2);
  other[PacketSensor::kFrame + 1] ^= 0x40;
  sensor.SendCounted(other);
  other = sensor.PacketOf(8, 2);
  other[PacketSensor::kSerial] ^= 1;
  sensor.SendOther(other);
  c.AwaitStat("packets-foreign", 1);
  sensor.Send(2, 8, 64);
  sensor.Note("with packets that belong to none");
  sensor.SendShort(4);
  c.Await("of another size", "message warning Packets of");
  c.Ask();
  sensor.Send(3, 0, 12);
  for (int i = 0; i < 2; ++i) {
    be_silent("message warning No packets", i == 0 ? 2 : 0);
    sensor.SendScan("behind the silence", 4 + static_cast<guint>(i));
  }
  sensor.Restart();
  sensor.SendScan("behind a restart", 6);
  c.Stop();
  play("play again");
  sensor.SendScan("a scan", 7);
  sensor.Restart();
  sensor.SendScan("behind a restart", 8);
  be_silent("message warning No packets");
  c.Stop();
  c.Set("reconnect", "false");
  play("play once more");
  sensor.SendScan("a scan", 9);
  be_silent("event eos");  // EOS comes after both errors
  c.Stop();
  play("without a sensor");
  be_silent("event eos");  // EOS comes after both errors
}

const std::size_t kOusterCourses = AddGoldenCourses(
    "OusterGoldenCourses",
    {{"live",
      "ouster_src metadata=" + DataPath("OS-0-32-U1_v2.2.0_1024x10.json") +
          " lidar-port=" + std::to_string(FreePort()) + " imu-port=" + std::to_string(FreePort()),
      LiveCourse,
      {nullptr, "src"}}},
    GOLDEN_COURSES_FOLDER, false);

}  // namespace
}  // namespace lidar::test
