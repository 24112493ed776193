// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of ouster_src: each property has an effect, each counter counts, and an element that was
// stopped behaves like a new one.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <fstream>
#include <set>

#include "gst/net/udp_socket.h"
#include "src/tools/bench/ouster_replay/http_server.h"
#include "tests/elements/ouster/ouster_support.h"
#include "tests/support/golden_course.h"
#include "tests/support/own_properties.h"
#include "tests/support/run_trace.h"

namespace lidar::test {
namespace {

/// The records of a capture, which a test can change. They are 64 packets of a scan of 32 beams,
/// and packets of the IMU.
struct CaptureFile {
  struct Record {
    guint64 us;  // time of the capture [us]
    std::string frame;
  };
  static constexpr std::size_t kPayload = 42;  // offset of the UDP payload in a frame
  static constexpr std::size_t kLidarFrame = 8490;
  static constexpr std::size_t kColumns = kPayload + 32;

  explicit CaptureFile(const std::string& path) {
    const std::string bytes = ReadFile(path);
    head = bytes.substr(0, 24);
    for (std::size_t at = 24; at + 16 <= bytes.size();) {
      guint32 words[3];
      std::memcpy(words, bytes.data() + at, sizeof words);
      records.push_back({words[0] * G_USEC_PER_SEC + words[1], bytes.substr(at + 16, words[2])});
      at += 16 + words[2];
    }
  }
  void Write(const std::string& path, std::size_t cut = 0) const {
    std::string bytes = head;
    for (const auto& [us, frame] : records) {
      const auto size = static_cast<guint32>(frame.size());
      const guint32 words[4] = {static_cast<guint32>(us / G_USEC_PER_SEC),
                                static_cast<guint32>(us % G_USEC_PER_SEC), size, size};
      bytes.append(reinterpret_cast<const char*>(words), sizeof words) += frame;
    }
    std::ofstream(path, std::ios::binary) << bytes.substr(0, bytes.size() - cut);
  }
  /// Returns the lidar packets of the scan, moved to the scan that is `n` periods later. They are
  /// captured `delay_us` late.
  std::vector<Record> Scan(guint n, guint64 delay_us = 0) const {
    std::vector<Record> scan;
    for (Record r : records) {
      if (r.frame.size() != kLidarFrame) continue;
      r.us += n * 100'000 + delay_us;
      r.frame[kPayload + 2] = static_cast<char>(r.frame[kPayload + 2] + static_cast<char>(n));
      const std::size_t column = (kLidarFrame - kColumns - 32) / 16;
      for (std::size_t c = 0; c < 16; ++c) {
        guint64 t = 0;
        std::memcpy(&t, &r.frame[kColumns + c * column], sizeof t);
        t += n * 100'000'000;
        std::memcpy(&r.frame[kColumns + c * column], &t, sizeof t);
      }
      scan.push_back(std::move(r));
    }
    return scan;
  }

  std::string head;
  std::vector<Record> records;
};

const std::string kDual = "OS-0-32-U1_v2.2.0_1024x10";
const TempFolder kRunFolder;
const std::string kRunFiles = kRunFolder.path() + "/";

/// Writes the metadata with `from` replaced by `to`. Returns the path of the file.
std::string ChangedMetadata(const char* name, const std::string& from, const std::string& to) {
  std::string text = ReadFile(DataPath(kDual + ".json"));
  text.replace(text.find(from), from.size(), to);
  const std::string path = kRunFiles + name;
  std::ofstream(path) << text;
  return path;
}

/// Writes the capture of a sensor that uses PTP: the sensor's clock is 37 s ahead of UTC. Returns
/// the path of the file.
std::string CaptureOnPtp() {
  CaptureFile file(DataPath(kDual + ".pcap"));
  file.records = file.Scan(0);
  for (CaptureFile::Record& r : file.records) {
    guint64 ns = 0;
    std::memcpy(&ns, &r.frame[CaptureFile::kColumns], sizeof ns);
    r.us = ns / 1000 - 37 * G_USEC_PER_SEC;
  }
  const std::string path = kRunFiles + "ptp.pcap";
  file.Write(path);
  return path;
}

std::string HalfACapture() {
  CaptureFile file(DataPath(kDual + ".pcap"));
  file.records.resize(file.records.size() / 2);
  const std::string path = kRunFiles + "half.pcap";
  file.Write(path);
  return path;
}

std::string LeftMask() {
  const std::string path = kRunFiles + "mask.pgm";
  std::ofstream mask(path, std::ios::binary);
  mask << "P5\n1024 32\n255\n";
  for (int i = 0; i < 32; ++i) mask << std::string(512, '\xff') << std::string(512, '\0');
  return path;
}

/// A run of ouster_src on a file. Records the clouds and the samples of the IMU.
class FileRun {
 public:
  explicit FileRun(const std::string& properties, bool with_bytes = true) {
    const gst::ElementPtr element(gst_parse_launch(("ouster_src " + properties).c_str(), nullptr));
    h_.reset(gst_harness_new_with_element(element.get(), nullptr, "src"));
    gst_harness_use_systemclock(h_.get());
    trace_.emplace(h_.get(), with_bytes);
    g_signal_connect(element.get(), "pad-added", G_CALLBACK(OnPad), this);
  }
  ~FileRun() {
    Stop();
    trace_.reset();
  }
  FileRun(const FileRun&) = delete;
  FileRun& operator=(const FileRun&) = delete;

  /// Plays to the end of the file. Returns everything that the element output and posted.
  Lines Play() {
    SetPlaying(h_.get());
    AwaitEnd();
    Lines lines = trace_->Take();
    lines.push_back("latency " + std::to_string(gst_harness_query_latency(h_.get())));
    return lines;
  }
  Lines SeekToBegin() {
    EXPECT_TRUE(gst_element_seek_simple(h_->element, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 0));
    AwaitEnd();
    return trace_->TakeBuffers();
  }
  void Stop() {
    trace_->Stop();
    trace_->Take();
  }

 private:
  static void OnPad(GstElement*, GstPad* pad, gpointer self) {
    static_cast<FileRun*>(self)->trace_->Watch(pad);
  }
  void AwaitEnd() {
    for (bool ended = false; !ended;) {
      const gst::EventPtr event(gst_harness_pull_event(h_.get()));
      ASSERT_TRUE(event);
      ended = GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS;
    }
  }
  Harness h_;
  std::optional<RunTrace> trace_;
};

/// Returns the properties of a source that reads a file, but omits the property `changed`.
std::string WithFile(const std::string& changed) {
  std::string all;
  if (changed != "location") all += " location=" + DataPath(kDual + ".pcap");
  if (changed != "metadata") all += " metadata=" + DataPath(kDual + ".json");
  return all;
}

struct OusterEffect {
  const char* others;  // properties without which there is no effect
  const char* property;
  std::string value;
};

const OusterEffect kFileEffects[] = {
    {"", "location", HalfACapture()},
    {"", "metadata", ChangedMetadata("beams.json", "27.67", "30.67")},
    {"", "is-live", "true"},
    {"num-buffers=12", "loop", "true"},
    {"", "imu", "false"},
    {"", "slices-per-scan", "4"},
    {"", "channels", "ring"},
    {"", "return", "second"},
    {"", "pts-from", "arrival"},
    {"", "min-range", "3"},
    {"", "max-range", "3"},
    {"", "azimuth-sectors", "0-90"},
    {"", "mask-location", LeftMask()},
    {"", "invalid", "nan"},
    {"", "destagger", "true"},
};

class OusterEachFileProperty : public ::testing::TestWithParam<OusterEffect> {};
TEST_P(OusterEachFileProperty, ChangesWhatComesOut) {
  const auto& [others, property, value] = GetParam();
  const auto change = std::string(" ") + property + "=" + value;
  static const Lines usual = FileRun(WithFile("")).Play();
  EXPECT_NE(FileRun(WithFile(property) + " " + others + change).Play(),
            *others != '\0' ? FileRun(WithFile("") + " " + others).Play() : usual)
      << property;
}
INSTANTIATE_TEST_SUITE_P(Of, OusterEachFileProperty, ::testing::ValuesIn(kFileEffects));

/// Positions are not compared, because their last bits differ between machines.
TEST(OusterGoldenCourses, OfAFileAreAsTheyWere) {
  for (const auto& [others, property, value] : kFileEffects) {
    const std::string name = property;
    if (name == "location" || name == "metadata" || name == "is-live") continue;
    const std::string properties = WithFile("") + " " + others + " " + name + "=" + value;
    ExpectGoldenLines(FileRun(properties, false).Play(),
                      std::string(GOLDEN_COURSES_FOLDER) + "/" + name + ".txt");
  }
}

TEST(OusterProperties, ThePtpOffsetMakesASynchronisedClockOfUtc) {
  const std::string source =
      "location=" + CaptureOnPtp() + " metadata=" +
      ChangedMetadata("ptp.json", "\"base_pn\": \"\",",
                      "\"config_params\": {\"timestamp_mode\": \"TIME_FROM_PTP_1588\"},");
  const auto synchronised = [](const Lines& lines) {
    return std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
      return line.find("clock-synchronised=(boolean)true") != std::string::npos;
    });
  };
  EXPECT_TRUE(synchronised(FileRun(source).Play()));
  EXPECT_TRUE(synchronised(FileRun(source + " ptp-utc-tai-offset=-36.5").Play()));
  EXPECT_FALSE(synchronised(FileRun(source + " ptp-utc-tai-offset=0").Play()));
}

/// Returns true if no program has bound `port` at this address.
bool IsFree(const char* address, guint16 port) {
  const std::unique_ptr<GSocket, gst::GObjectUnref> socket(
      g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP, nullptr));
  const std::unique_ptr<GSocketAddress, gst::GObjectUnref> place(
      g_inet_socket_address_new_from_string(address, port));
  return g_socket_bind(socket.get(), place.get(), FALSE, nullptr) != FALSE;
}

/// A sensor that refuses every configuration. asked() returns true after the first request.
class RefusingSensor {
 public:
  RefusingSensor(int status, bool can_be_read) : status_(status), can_be_read_(can_be_read) {}
  std::string host() const { return "127.0.0.1:" + std::to_string(server_.port()); }
  bool asked() const { return asked_; }

 private:
  tools::HttpReply Answer(const tools::HttpRequest& request) {
    asked_ = true;
    if (request.method == "GET" && can_be_read_) return {200, "{}", {}};
    return {status_, "{}", {}};
  }
  const int status_;
  const bool can_be_read_;
  std::atomic<bool> asked_{false};
  tools::HttpServer server_{"127.0.0.1", 0,
                            [this](const tools::HttpRequest& r) { return Answer(r); }};
};

/// A fixture for live sources: their ports, their requests to a sensor, and their first message.
class OusterLiveEffects : public ::testing::Test {
 protected:
  /// Plays a source. Returns the text of its first error or warning.
  static std::string FirstProblem(const std::string& properties) {
    const gst::ElementPtr pipeline(
        gst_parse_launch(("ouster_src " + properties + " ! fakesink").c_str(), nullptr));
    gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
    const ElementBus bus(pipeline.get());
    const gst::MessagePtr message = bus.Wait(GST_MESSAGE_ERROR | GST_MESSAGE_WARNING);
    gst_element_set_state(pipeline.get(), GST_STATE_NULL);
    if (!message) return "nothing";
    return GST_MESSAGE_TYPE_NAME(message.get()) + (": " + TextOf(message.get()));
  }
  std::string Ports(guint16 lidar, guint16 imu) const {
    return "metadata=" + DataPath(kDual + ".json") + " lidar-port=" + std::to_string(lidar) +
           " imu-port=" + std::to_string(imu) + " ";
  }
  /// Returns those of the addresses 127.0.0.1 and 127.0.0.2 at which the source binds `port`.
  std::string Taken(const std::string& properties, guint16 port) const {
    const gst::ElementPtr source(gst_parse_launch(("ouster_src " + properties).c_str(), nullptr));
    EXPECT_NE(gst_element_set_state(source.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
    std::string taken;
    for (const char* address : {"127.0.0.1", "127.0.0.2"})
      if (!IsFree(address, port)) taken += std::string(address) + " ";
    gst_element_set_state(source.get(), GST_STATE_NULL);
    return taken;
  }
};

TEST_F(OusterLiveEffects, PortsAndAddressAreThoseOfItsSockets) {
  const guint16 a = FreePort();
  const guint16 b = FreePort();
  EXPECT_EQ(Taken(Ports(a, b), a), "127.0.0.1 127.0.0.2 ");
  EXPECT_EQ(Taken(Ports(a, b), b), "127.0.0.1 127.0.0.2 ");
  EXPECT_EQ(Taken(Ports(a, b) + "address=127.0.0.2", a), "127.0.0.2 ");
  EXPECT_EQ(Taken(Ports(a, b) + "imu=false", b), "");
  EXPECT_EQ(Taken(Ports(a, a), b), "");
  EXPECT_EQ(IsFree("127.0.0.1", a), true) << "a source that stopped leaves its port";
}

TEST_F(OusterLiveEffects, AGroupMustBeOneAndItsInterfaceMustExist) {
  const std::string ports = Ports(FreePort(), FreePort());
  const std::string group = FirstProblem(ports + "multicast-group=10.0.0.1");
  EXPECT_NE(group.find("10.0.0.1\" is not a multicast group"), std::string::npos) << group;
  const std::string interface =
      FirstProblem(ports + "multicast-group=239.201.7.1 multicast-iface=nosuch0");
  EXPECT_NE(interface.find("nosuch0"), std::string::npos) << interface;
}

TEST_F(OusterLiveEffects, TheReceiveBufferIsThatOfItsSocket) {
  for (const guint bytes : {8192U, 32768U}) {
    const gst::ElementPtr pipeline(
        gst_parse_launch(("ouster_src name=s " + Ports(FreePort(), FreePort()) +
                          "buffer-size=" + std::to_string(bytes) + " ! fakesink")
                             .c_str(),
                         nullptr));
    const gst::ElementPtr source(gst_bin_get_by_name(GST_BIN(pipeline.get()), "s"));
    gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
    EXPECT_TRUE(Eventually([&] { return StatOf(source.get(), "receive-buffer") == bytes; }))
        << bytes;
    gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  }
}

TEST_F(OusterLiveEffects, TheReceiveBufferOfASharedSocketIsTheLargest) {
  const std::string ports = Ports(FreePort(), FreePort());
  std::vector<gst::ElementPtr> pipelines;
  const auto granted_to = [&](guint bytes) {
    pipelines.emplace_back(gst_parse_launch(
        ("ouster_src name=s " + ports + "buffer-size=" + std::to_string(bytes) + " ! fakesink")
            .c_str(),
        nullptr));
    const gst::ElementPtr source(gst_bin_get_by_name(GST_BIN(pipelines.back().get()), "s"));
    gst_element_set_state(pipelines.back().get(), GST_STATE_PLAYING);
    EXPECT_TRUE(Eventually([&] { return StatOf(source.get(), "receive-buffer") > 0; }));
    return StatOf(source.get(), "receive-buffer");
  };
  EXPECT_EQ(granted_to(16384), 16384U);
  EXPECT_EQ(granted_to(32768), 32768U);
  EXPECT_EQ(granted_to(8192), 32768U);
  for (const auto& pipeline : pipelines) gst_element_set_state(pipeline.get(), GST_STATE_NULL);
}

/// One source reads the shared socket for all sources. The queue of each other source has room for
/// at least 1 MiB. The packets of this test have more than twice as many bytes.
TEST_F(OusterLiveEffects, SourcesOfOnePortGetEachPacketHoweverManyCome) {
  constexpr std::size_t kPackets = 300;
  constexpr std::size_t kAtOnce = 8;  // fewer packets than even a small socket buffer has room for
  const guint16 port = FreePort();
  const std::string launch =
      "ouster_src name=s buffer-size=1048576 " + Ports(port, FreePort()) + " ! fakesink";
  std::vector<gst::ElementPtr> pipelines;
  std::vector<gst::ElementPtr> sources;
  for (int i = 0; i < 2; ++i) {
    pipelines.emplace_back(gst_parse_launch(launch.c_str(), nullptr));
    sources.emplace_back(gst_bin_get_by_name(GST_BIN(pipelines.back().get()), "s"));
    gst_element_set_state(pipelines.back().get(), GST_STATE_PLAYING);
    ASSERT_TRUE(Eventually([&] { return StatOf(sources.back().get(), "receive-buffer") > 0; }));
  }
  const auto packets = LoadPackets(kDual + ".pcap", LoadMetadata(kDual + ".json"));
  UdpSender sender(port);
  const auto sent_to_all = [&](std::size_t sent) {
    return std::all_of(sources.begin(), sources.end(), [&](const gst::ElementPtr& source) {
      return StatOf(source.get(), "packets") + StatOf(source.get(), "dropped-by-kernel") >= sent;
    });
  };
  for (std::size_t sent = 0; sent < kPackets; ++sent) {
    if (sent % kAtOnce == 0) {
      ASSERT_TRUE(Eventually([&] { return sent_to_all(sent); })) << sent;
    }
    sender.Send(packets[sent % packets.size()]);
  }
  EXPECT_TRUE(Eventually([&] { return sent_to_all(kPackets); }));
  for (const auto& source : sources) EXPECT_EQ(StatOf(source.get(), "dropped-by-kernel"), 0U);
  for (const auto& pipeline : pipelines) gst_element_set_state(pipeline.get(), GST_STATE_NULL);
}

const OusterEffect kSensorEffects[] = {
    {R"("udp_port_lidar":7)", "lidar-port", "7"},
    {R"("udp_port_imu":9)", "imu-port", "9"},
    {R"("udp_dest":"10.1.2.3")", "udp-dest", "10.1.2.3"},
    {R"("lidar_mode":"512x10")", "lidar-mode", "512x10"},
    {R"("udp_profile_lidar":"LEGACY")", "udp-profile-lidar", "LEGACY"},
    {R"("timestamp_mode":"TIME_FROM_PTP_1588")", "sensor-timestamp-mode", "TIME_FROM_PTP_1588"},
    {R"("azimuth_window":[0,90000])", "azimuth-window", "0,90000"},
    {R"("signal_multiplier":0.5)", "signal-multiplier", "0.5"},
};

TEST_F(OusterLiveEffects, ASensorIsAskedForWhatTheSettingsSayAndNothingElse) {
  const RefusingSensor sensor(400, true);
  for (const auto& [asked, property, value] : kSensorEffects) {
    const std::string error =
        FirstProblem("hostname=" + sensor.host() + " " + property + "=" + value);
    EXPECT_NE(error.find("does not accept the configuration {" + std::string(asked) + "}"),
              std::string::npos)
        << error;
  }
  EXPECT_TRUE(sensor.asked());
}

TEST_F(OusterLiveEffects, ASensorThatFailsIsWaitedForOrAnError) {
  const RefusingSensor busy(503, true);
  EXPECT_EQ(FirstProblem("lidar-mode=512x10 hostname=" + busy.host()).rfind("warning: ", 0), 0U);
  const RefusingSensor sensor(503, false);
  EXPECT_EQ(FirstProblem("hostname=" + sensor.host()).rfind("warning: ", 0), 0U);
  EXPECT_EQ(FirstProblem("reconnect=false hostname=" + sensor.host()).rfind("error: ", 0), 0U);
}

TEST(OusterProperties, AreAllInATest) {
  std::set<std::string> tried = {"ptp-utc-tai-offset", "address",     "multicast-group",
                                 "multicast-iface",    "buffer-size", "hostname",
                                 "reconnect"};
  for (const OusterEffect& effect : kFileEffects) tried.insert(effect.property);
  for (const OusterEffect& effect : kSensorEffects) tried.insert(effect.property);
  for (const std::string& name : OwnWritableProperties("ouster_src"))
    EXPECT_EQ(tried.count(name), 1U) << name;
}

/// Writes a capture with an event for each counter. Returns the path of the file.
std::string CaptureOfTroubles() {
  using Record = CaptureFile::Record;
  CaptureFile file(DataPath(kDual + ".pcap"));
  const std::vector<Record> imu = [&] {
    std::vector<Record> found;
    for (const Record& r : file.records)
      if (r.frame.size() != CaptureFile::kLidarFrame) found.push_back(r);
    return found;
  }();
  std::vector<Record> all;
  const auto add = [&](const std::vector<Record>& scan, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) all.push_back(scan[i]);
  };
  add(file.Scan(0), 0, 64);
  all.push_back(imu[0]);
  all.push_back(imu[1]);
  const std::vector<Record> second = file.Scan(1);
  add(second, 0, 9);  // then two packets are missing, and a third comes late
  add(second, 12, 40);
  all.push_back(second[9]);
  add(second, 40, 45);
  all.push_back(second[44]);
  Record foreign = second[45];
  foreign.frame[CaptureFile::kPayload + 7] ^= 1;
  all.push_back(foreign);
  Record stray = second[45];
  stray.frame[CaptureFile::kPayload + 3] ^= 0x40;
  all.push_back(stray);
  add(second, 45, 64);
  Record short_one = imu[2];
  short_one.frame[39] = 8 + 40;  // the length in the UDP header is too small
  all.push_back(short_one);
  add(file.Scan(2, 5 * G_USEC_PER_SEC), 0, 64);
  std::vector<Record> restarted = file.Scan(3, 5 * G_USEC_PER_SEC);
  for (Record& r : restarted) r.frame[CaptureFile::kPayload + 4] ^= 1;
  add(restarted, 0, 60);
  file.records = all;
  const std::string path = kRunFiles + "troubles.pcap";
  file.Write(path, 1000);
  return path;
}

TEST(OusterSecondRun, IsAsTheFirst) {
  FileRun run("location=" + CaptureOfTroubles() + " metadata=" + DataPath(kDual + ".json"));
  const Lines first = run.Play();
  EXPECT_TRUE(HasLine(
      first,
      "packets=(guint64)251, packets-lost=(guint64)2, packets-late=(guint64)1, "
      "packets-duplicate=(guint64)1, packets-stray=(guint64)1, packets-wrong-size=(guint64)1, "
      "packets-foreign=(guint64)1, packets-damaged=(guint64)0, packets-imu=(guint64)2, "
      "clock-jumps=(guint64)1, dropped-by-kernel=(guint64)0, restarts=(guint64)1, "
      "reconnects=(uint)0, slices=(guint64)32, slices-incomplete=(guint64)2, "
      "receive-buffer=(uint)0, clock-synchronised=(boolean)false;"))
      << first[first.size() - 2];
  EXPECT_TRUE(HasLine(first, "message ouster-packet-loss, lost=(guint64)3, total=(guint64)3"));
  EXPECT_TRUE(HasLine(first, "message warning The sensor was restarted"));
  EXPECT_TRUE(HasLine(first, "troubles.pcap is cut short"));
  run.Stop();
  EXPECT_EQ(run.Play(), first);
}

TEST(OusterRestarts, InACaptureAreWarnedOfOnce) {
  CaptureFile file(DataPath(kDual + ".pcap"));
  std::vector<CaptureFile::Record> all;
  for (guint scan = 0; scan < 3; ++scan) {
    for (CaptureFile::Record& r : file.Scan(scan)) {
      char& init_id = r.frame[CaptureFile::kPayload + 4];
      init_id = static_cast<char>(init_id ^ static_cast<char>(scan));
      all.push_back(std::move(r));
    }
  }
  file.records = std::move(all);
  const std::string path = kRunFiles + "restarts.pcap";
  file.Write(path);
  const Lines lines = FileRun("location=" + path + " metadata=" + DataPath(kDual + ".json")).Play();
  EXPECT_TRUE(HasLine(lines, "restarts=(guint64)2,"));
  EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                          [](const std::string& line) {
                            return line.find("warning The sensor was restarted") != line.npos;
                          }),
            1);
}

TEST(OusterSecondRun, OfAFileThatWasSoughtGivesTheSameClouds) {
  const std::string troubles = CaptureOfTroubles();
  FileRun run("location=" + troubles + " metadata=" + DataPath(kDual + ".json"));
  Lines first = run.Play();
  first.erase(std::remove_if(first.begin(), first.end(),
                             [](const auto& line) { return line.rfind("buffer", 0) != 0; }),
              first.end());
  Lines again = run.SeekToBegin();
  for (Lines* lines : {&first, &again})
    for (std::string& line : *lines) {
      // The numbers of scans do not restart after a seek.
      const std::size_t number = line.find(" slice ");
      if (number != std::string::npos) line.erase(number, line.find(' ', number + 7) - number);
    }
  EXPECT_EQ(again, first);
}

TEST(OusterSecondRun, CountsADamagedPacketAndMissesIt) {
  CaptureFile file(DataPath("crc_test.pcap"));
  auto lidar = std::find_if(file.records.begin() + 5, file.records.end(), [](const auto& r) {
    return r.frame.size() == CaptureFile::kLidarFrame;
  });
  lidar->frame[CaptureFile::kColumns + 100] ^= 1;
  const std::string path = kRunFiles + "damaged.pcap";
  file.Write(path);
  FileRun run("location=" + path + " metadata=" + DataPath("crc_test.json"));
  for (int i = 0; i < 2; ++i) {
    const Lines lines = run.Play();
    EXPECT_TRUE(HasLine(lines, "packets-damaged=(guint64)1,")) << lines[lines.size() - 2];
    EXPECT_TRUE(HasLine(lines, "packets-lost=(guint64)1,")) << lines[lines.size() - 2];
    EXPECT_TRUE(HasLine(lines, "slices-incomplete=(guint64)2,")) << lines[lines.size() - 2];
    run.Stop();
  }
}

}  // namespace
}  // namespace lidar::test
