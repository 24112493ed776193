// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/live_session.h"

#include <netinet/in.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "gst/common/refs.h"

#include "ext/ouster/debug.h"

namespace lidar::gst {
namespace {

constexpr guint kDefaultLidarPort = 7502;
constexpr guint kDefaultImuPort = 7503;
// If no packet arrives for this long, the sensor counts as disconnected.
constexpr gint64 kSilenceUs = 1'000'000;
// The same limit before the first packet of the sensor.
constexpr gint64 kFirstSilenceUs = 3'000'000;
constexpr gint64 kCheckNs = 250 * GST_MSECOND;  // interval between checks for silence
constexpr gint64 kQuestionIntervalUs = 1'000'000;
// How long the session waits for new metadata after the sensor's init id changed.
constexpr gint64 kWaitForMetadataUs = 2'000'000;
constexpr guint kWrongSizesForQuestion = 4;

/// Converts text of a server for use in messages. The result is short and valid UTF-8, which
/// GStreamer requires.
std::string Readable(const std::string& text) {
  constexpr gssize kLongest = 1000;  // bytes
  const auto size = std::min(static_cast<gssize>(text.size()), kLongest);
  const StringPtr valid(g_utf8_make_valid(text.data(), size));
  return valid.get();
}

/// Returns the IP address of `from`. IPv4 addresses are returned as IPv4-mapped IPv6 addresses,
/// because an IPv6 socket reports them in this form.
ouster::Sender SenderOf(const NativeAddress& from) {
  ouster::Sender sender{};
  if (from.storage.ss_family == AF_INET6) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &from.storage, sizeof v6);
    std::memcpy(sender.data(), &v6.sin6_addr, sender.size());
  } else if (from.storage.ss_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, &from.storage, sizeof v4);
    sender[10] = sender[11] = 0xff;
    std::memcpy(&sender[12], &v4.sin_addr, 4);
  }
  return sender;
}

/// Returns true if the process may open `count` more files. GLib aborts the process if it cannot
/// open a file that it needs.
bool CanOpenFiles(std::size_t count) {
  std::vector<int> files;
  while (files.size() < count) {
    const int fd = eventfd(0, EFD_CLOEXEC);
    if (fd < 0) break;
    files.push_back(fd);
  }
  for (const int fd : files) close(fd);
  return files.size() == count;
}

}  // namespace

LiveSession::LiveSession(GstBaseSrc* element, const OusterSettings& settings)
    : Session(element, settings) {}

// The link is destroyed first, because its thread calls udp_.Wake().
LiveSession::~LiveSession() { link_.reset(); }

bool LiveSession::Open() {
  constexpr std::size_t kFilesOfLink = 6;  // sockets for HTTP and for name resolution
  constexpr std::size_t kFilesOfFeed = 5;  // two sockets, and the descriptors that wake their wait
  constexpr std::size_t kFilesOfOthers = 4;  // for the application's main loop
  const std::size_t wanted =
      kFilesOfFeed + kFilesOfOthers + (settings().hostname.empty() ? 0 : kFilesOfLink);
  if (!CanOpenFiles(wanted)) {
    GST_ELEMENT_ERROR(
        element(), RESOURCE, NO_SPACE_LEFT,
        ("The process has too few file descriptors left: ouster_src needs %" G_GSIZE_FORMAT ".",
         wanted),
        ("raise the limit: ulimit -n 1024"));
    return false;
  }
  return OpenFeed() && OpenLink();
}

/// Opens the sockets if a file has the metadata. Otherwise the sockets are opened after the sensor
/// has sent its metadata.
bool LiveSession::OpenFeed() {
  if (settings().hostname.empty() || !settings().metadata.empty()) {
    auto metadata = LoadMetadata();
    return metadata && SetMetadata(*std::move(metadata)) && OpenSockets(stream()->metadata());
  }
  return true;
}

bool LiveSession::OpenLink() {
  if (settings().hostname.empty()) return true;
  std::string why;
  link_ = SensorLink::Create(
      settings(), [this] { udp_.Wake(); }, &why);
  if (!link_) {
    GST_ELEMENT_ERROR(element(), RESOURCE, SETTINGS, ("Cannot ask the sensor: %s.", why.c_str()),
                      (nullptr));
    return false;
  }
  link_->Request();
  return true;
}

bool LiveSession::OpenSockets(const ouster::Metadata& metadata) {
  const OusterSettings& s = settings();
  const auto choose = [](guint wanted, guint has, guint otherwise) {
    return wanted != 0 ? wanted : has != 0 ? has : otherwise;
  };
  const UdpFeed::Ports ports{choose(s.lidar_port, metadata.lidar_port, kDefaultLidarPort),
                             s.imu && metadata.imu_profile != ouster::ImuProfile::kOff
                                 ? choose(s.imu_port, metadata.imu_port, kDefaultImuPort)
                                 : 0};
  if (udp_.IsOpen(ports)) return true;
  const auto opened = udp_.Open(s, ports);
  if (!opened.error.empty()) {
    GST_ELEMENT_ERROR(element(), RESOURCE, OPEN_READ, ("%s.", opened.error.c_str()), (nullptr));
    return false;
  }
  if (!opened.imu_error.empty())
    GST_ELEMENT_WARNING(element(), RESOURCE, OPEN_READ, ("%s.", opened.imu_error.c_str()),
                        ("the stream goes on without IMU samples; imu=false avoids this warning"));
  receive_buffer_ = opened.granted_buffer;
  if (opened.granted_buffer < s.buffer_size)
    GST_ELEMENT_WARNING(
        element(), RESOURCE, SETTINGS,
        ("The kernel granted a receive buffer of %u bytes instead of %u: packets may be lost.",
         opened.granted_buffer, s.buffer_size),
        ("raise it with: sysctl -w net.core.rmem_max=%u", s.buffer_size));
  return true;
}

void LiveSession::Unlock() {
  flushing_ = true;
  udp_.Wake();
}

void LiveSession::UnlockStop() {
  flushing_ = false;
  udp_.ClearWake();
}

/// Drops the datagrams that arrived in the sockets' buffers during the pause.
void LiveSession::LeavePauseBehind() {
  constexpr int kMostBatches = 4096;
  last_packet_us_ = Now();
  if (!std::exchange(polled_, true)) return;
  for (int i = 0; i < kMostBatches; ++i)
    if (udp_.Receive(0, [](const ReceivedDatagram&) {}) != UdpFeed::Outcome::kPackets) break;
  if (stream() != nullptr) stream()->Restart();
}

void LiveSession::AddCounters(Counters* counters) const {
  counters->kernel_drops = udp_.drops();
  counters->receive_buffer = receive_buffer_;
  counters->reconnects = reconnects_;
}

void LiveSession::SetConnected(bool connected, const std::string& reason) {
  if (connected == connected_ && (connected || lost_once_)) return;
  connected_ = connected;
  heard_ = heard_ || connected;
  if (connected && lost_once_) ++reconnects_;
  lost_once_ = lost_once_ || !connected;
  if (connected) silence_reported_ = false;
  gst_element_post_message(
      gst_element(),
      gst_message_new_element(
          GST_OBJECT(element()),
          gst_structure_new("ouster-connection-changed", "connected", G_TYPE_BOOLEAN, connected,
                            "reason", G_TYPE_STRING, reason.c_str(), nullptr)));
}

gint64 LiveSession::Now() const {
  GstClock* own = gst_element_get_clock(gst_element());
  const std::unique_ptr<GstClock, Unref> clock(own != nullptr ? own : gst_system_clock_obtain());
  return static_cast<gint64>(GST_TIME_AS_USECONDS(gst_clock_get_time(clock.get())));
}

void LiveSession::Ask() {
  const gint64 now = Now();
  if (!link_ || link_->busy() || now - last_question_us_ < kQuestionIntervalUs) return;
  last_question_us_ = now;
  link_->Request();
}

/// Handles the metadata or the error that the sensor link returned. If the session cannot continue,
/// posts an error and returns false.
bool LiveSession::HandleAnswer(SensorLink::Result result) {
  if (result.metadata) {
    api_reported_ = false;
    destination_ = Readable(result.destination);
    return TakeMetadata(*std::move(result.metadata));
  }
  const std::string why = Readable(result.error.text);
  if (result.error.permanent) {
    GST_ELEMENT_ERROR(
        element(), RESOURCE, SETTINGS,
        ("The sensor %s cannot be used: %s.", settings().hostname.c_str(), why.c_str()), (nullptr));
    return false;
  }
  if (!settings().reconnect) {
    GST_ELEMENT_ERROR(
        element(), RESOURCE, OPEN_READ,
        ("Cannot talk to the sensor %s: %s.", settings().hostname.c_str(), why.c_str()),
        ("is the sensor powered, and is its name or address right?"));
    return false;
  }
  // Packets may continue to arrive even if the HTTP API is down.
  if (connected_) return true;
  SetConnected(false, why);
  if (!std::exchange(api_reported_, true))
    GST_ELEMENT_WARNING(
        element(), RESOURCE, OPEN_READ,
        ("Cannot talk to the sensor %s: %s.", settings().hostname.c_str(), why.c_str()),
        ("ouster_src asks again until the sensor answers; is the sensor powered, and is its name "
         "or address right?"));
  return true;
}

/// Returns true if the session waits until the sensor's stream is switched on. Posts an error and
/// returns false if `reconnect` is false. Does so also if no packet has ever arrived, because a
/// setting is wrong then.
bool LiveSession::WaitWhileSwitchedOff() {
  if (heard_ && settings().reconnect) {
    SetConnected(false, "the sensor's lidar stream is switched off");
    return true;
  }
  GST_ELEMENT_ERROR(element(), RESOURCE, SETTINGS, ("The sensor's lidar stream is switched off."),
                    ("its udp_dest is empty, its udp_port_lidar is 0 or its udp_profile_lidar is "
                     "OFF; set udp-dest=@auto, lidar-port or udp-profile-lidar"));
  return false;
}

bool LiveSession::TakeMetadata(ouster::Metadata metadata) {
  if (metadata.switched_off) return WaitWhileSwitchedOff();
  const bool first = stream() == nullptr;
  const bool new_geometry = first || !SameGeometry(stream()->metadata(), metadata);
  const bool new_start = first || metadata.init_id != stream()->metadata().init_id;
  if (!first && !new_geometry && !new_start) return true;
  const guint init_id = metadata.init_id;
  const std::string serial = metadata.serial_text;
  if (!OpenSockets(metadata) || !SetMetadata(std::move(metadata))) return false;
  new_init_id_us_ = 0;
  wrong_sizes_in_a_row_ = 0;
  if (first) last_packet_us_ = Now();
  gst_element_post_message(
      gst_element(),
      gst_message_new_element(
          GST_OBJECT(element()),
          gst_structure_new("ouster-metadata-changed", "geometry-changed", G_TYPE_BOOLEAN,
                            new_geometry, "init-id", G_TYPE_UINT, init_id, "serial", G_TYPE_STRING,
                            serial.c_str(), nullptr)));
  return true;
}

/// Handles a packet of a sensor that restarted or was reconfigured. Packets are dropped until new
/// metadata arrives, but for at most kWaitForMetadataUs. After this time, packets are used with the
/// old metadata.
void LiveSession::HandleNewInitId(ByteView payload, const ouster::Arrival& arrival) {
  const gint64 now = Now();
  if (new_init_id_us_ == 0) new_init_id_us_ = now;
  // If the metadata have no serial number, the packet may be from another sensor, while our own
  // sensor continues to send.
  const bool may_be_another = stream()->metadata().serial == 0;
  if ((link_ || may_be_another) && now - new_init_id_us_ < kWaitForMetadataUs) return Ask();
  new_init_id_us_ = 0;
  GST_ELEMENT_WARNING(element(), STREAM, WRONG_TYPE,
                      ("The sensor restarted or was reconfigured since its metadata was read."),
                      ("points are right as long as its mode and profile are the same"));
  stream()->AcceptNewInitId();
  Push(payload, arrival);
}

void LiveSession::HandleWrongSize(gsize size) {
  if (++wrong_sizes_in_a_row_ < kWrongSizesForQuestion) return;
  Ask();
  if (size_reported_ || link_) return;
  size_reported_ = true;
  const ouster::Metadata& m = stream()->metadata();
  GST_ELEMENT_WARNING(element(), STREAM, WRONG_TYPE,
                      ("Packets of %" G_GSIZE_FORMAT
                       " bytes arrive, but the metadata describes packets of %" G_GSIZE_FORMAT ".",
                       size, m.format.packet_size()),
                      ("is the metadata (serial number %s, profile %s) from this sensor, and from "
                       "its present profile and mode?",
                       m.serial_text.c_str(), std::string(ToString(m.format.profile)).c_str()));
}

void LiveSession::HandlePacket(const ReceivedDatagram& d, Time now, Time utc_now) {
  if (stream() == nullptr) return;
  const Time utc = GST_CLOCK_TIME_IS_VALID(d.arrival) ? ToTime(d.arrival) : utc_now;
  const ouster::Arrival arrival{now + (utc - utc_now), utc, SenderOf(*d.from)};
  // Packets that arrived before running time 0 are dropped.
  if (arrival.local < Time{}) return;
  const ByteView payload{d.data, d.size};
  switch (Push(payload, arrival)) {
    case ouster::PacketVerdict::kLidar:
      last_packet_us_ = Now();
      wrong_sizes_in_a_row_ = 0;
      new_init_id_us_ = 0;
      if (!connected_) SetConnected(true, "packets arrive");
      break;
    case ouster::PacketVerdict::kNewInitId:
      last_packet_us_ = Now();
      HandleNewInitId(payload, arrival);
      break;
    case ouster::PacketVerdict::kWrongSize:
      HandleWrongSize(d.size);
      break;
    case ouster::PacketVerdict::kImu:
    case ouster::PacketVerdict::kForeign:
    case ouster::PacketVerdict::kDamaged:
      break;
  }
}

/// Checks whether the sensor had been silent for too long at `now_us`, a time of Now() before the
/// last call of udp_.Receive(). A later time would count a stop of this thread as silence, although
/// packets wait in the socket. If the session cannot wait for the sensor, posts an error and
/// returns false.
bool LiveSession::CheckSilence(gint64 now_us) {
  if (stream() == nullptr) return true;
  const bool never = stream()->batcher().stats().packets == 0 && !lost_once_;
  const gint64 silence = now_us - last_packet_us_;
  if (silence < (never ? kFirstSilenceUs : kSilenceUs)) return true;
  const std::string where =
      destination_.empty() ? std::string() : "; the sensor sends to " + destination_;
  if (!settings().reconnect) {
    GST_ELEMENT_ERROR(
        element(), RESOURCE, READ,
        ("No packets from the sensor on UDP port %u for %" G_GINT64_FORMAT " ms%s.", udp_.port(),
         silence / 1000, where.c_str()),
        ("is the sensor powered, and does it send to this port? udp-dest=@auto makes it do so"));
    return false;
  }
  if (connected_) stream()->Flush();
  SetConnected(false, "no packets" + where);
  if (!silence_reported_) {
    silence_reported_ = true;
    GST_ELEMENT_WARNING(
        element(), RESOURCE, READ,
        ("No packets from the sensor on UDP port %u%s.", udp_.port(), where.c_str()),
        ("is the sensor powered, and does it send to this port? udp-dest=@auto makes it do so"));
  }
  Ask();
  return true;
}

GstFlowReturn LiveSession::Poll() {
  if (resumed_.exchange(false)) LeavePauseBehind();
  if (link_) {
    auto answer = link_->Take();
    if (answer && !HandleAnswer(*std::move(answer))) return GST_FLOW_ERROR;
  }
  const Time now = ToTime(RunningTime());
  const Time utc_now = UtcNow();
  const gint64 now_us = Now();
  const auto outcome =
      udp_.Receive(kCheckNs, [&](const ReceivedDatagram& d) { HandlePacket(d, now, utc_now); });
  switch (outcome) {
    case UdpFeed::Outcome::kWoken:
      udp_.ClearWake();
      return flushing_ ? GST_FLOW_FLUSHING : GST_FLOW_OK;
    case UdpFeed::Outcome::kError:
      GST_ELEMENT_ERROR(element(), RESOURCE, READ, ("Receiving failed: %s.", g_strerror(errno)),
                        (nullptr));
      return GST_FLOW_ERROR;
    case UdpFeed::Outcome::kPackets:
    case UdpFeed::Outcome::kTimeout:
      break;
  }
  return CheckSilence(now_us) ? GST_FLOW_OK : GST_FLOW_ERROR;
}

}  // namespace lidar::gst
