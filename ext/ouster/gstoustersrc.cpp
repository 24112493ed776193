// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-ouster_src
 *
 * Clouds from an Ouster sensor, or from a capture of one. A scan comes as slices, each as soon as
 * its columns are there.
 *
 * |[
 * gst-launch-1.0 ouster_src location=drive.pcap metadata=drive.json ! fakesink silent=false -v
 * gst-launch-1.0 ouster_src lidar-port=7502 metadata=os1.json ! fakesink silent=false -v
 * ]|
 */
#include "gstoustersrc.h"

#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>

#include "common/gstlidar.h"
#include "common/refs.h"
#include "ouster/sensor_stream.h"
#include "pcap_feed.h"
#include "settings.h"
#include "slice_buffer.h"
#include "udp_feed.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_ouster_src_debug);
#define GST_CAT_DEFAULT gst_lidar_ouster_src_debug

namespace {

using namespace lidar;
using namespace lidar::gst;
using ouster::PacketVerdict;

constexpr guint kPropStats = kOusterProperties.size() + 1;

struct Counters {
  ouster::BatcherStats batcher;
  ouster::StreamStats stream;
  guint64 kernel_drops = 0;
  guint receive_buffer = 0;
  bool synchronised = false;
};

struct State {
  std::mutex mutex;  // guards all to the next comment; never held while waiting, pushing or posting
  OusterSettings settings;
  Counters counters;
  GstClockID wait = nullptr;  // the pending wait for a packet's time
  bool flushing = false;
  GstClockTime slice_duration = GST_CLOCK_TIME_NONE;

  UdpFeed udp;  // has its own lock for waking

  // Of the streaming thread, between start and stop.
  OusterSettings active;
  std::unique_ptr<ouster::SensorStream> stream;
  std::unique_ptr<PcapFeed> pcap;
  bool caps_pending = false;
  bool ended = false;
  bool size_reported = false;
  bool init_id_reported = false;
  GstClockTime pace_start = GST_CLOCK_TIME_NONE;  // running time of the capture's first packet
  Time pace_start_utc{};
};

}  // namespace

struct _GstLidarOusterSrc {
  GstPushSrc parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarOusterSrc, gst_lidar_ouster_src, GST_TYPE_PUSH_SRC)
GST_ELEMENT_REGISTER_DEFINE(ouster_src, "ouster_src", GST_RANK_NONE, GST_TYPE_LIDAR_OUSTER_SRC)

static State& StateOf(gpointer self) { return *GST_LIDAR_OUSTER_SRC(self)->state; }

static Time UtcNow() { return Time(std::chrono::microseconds(g_get_real_time())); }

/// None and an element error where the file is no metadata.
static std::optional<ouster::Metadata> LoadMetadata(GstLidarOusterSrc* self,
                                                    const OusterSettings& settings) {
  const std::string path = settings.MetadataPath();
  if (path.empty()) {
    GST_ELEMENT_ERROR(
        self, RESOURCE, SETTINGS, ("The property metadata is not set"),
        ("save the sensor's with: curl http://SENSOR/api/v1/sensor/metadata > m.json"));
    return std::nullopt;
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    GST_ELEMENT_ERROR(self, RESOURCE, NOT_FOUND, ("Cannot read the metadata %s", path.c_str()),
                      ("set the property metadata to the sensor's JSON file"));
    return std::nullopt;
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::string why;
  auto metadata = ouster::ParseMetadata(text, &why);
  if (!metadata)
    GST_ELEMENT_ERROR(self, STREAM, WRONG_TYPE,
                      ("%s is no metadata of an Ouster sensor: %s", path.c_str(), why.c_str()),
                      (nullptr));
  return metadata;
}

/// Takes the sensor as described from now on.
static bool SetMetadata(GstLidarOusterSrc* self, ouster::Metadata metadata) {
  State& state = StateOf(self);
  std::string why;
  const auto options = ToStreamOptions(state.active, &why);
  auto stream =
      options ? ouster::SensorStream::Create(std::move(metadata), *options, &why) : nullptr;
  if (!stream) {
    GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("%s", why.c_str()), (nullptr));
    return false;
  }
  state.stream = std::move(stream);
  state.caps_pending = true;
  const auto duration = static_cast<GstClockTime>(state.stream->slice_duration().count());
  std::lock_guard lock(state.mutex);
  state.slice_duration = duration;
  return true;
}

static bool OpenCapture(GstLidarOusterSrc* self) {
  State& state = StateOf(self);
  std::string why;
  const std::string& path = state.active.location;
  state.pcap = PcapFeed::Open(path, state.stream->metadata(), state.active.loop, &why);
  if (state.pcap) return true;
  GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ,
                    ("Cannot read the capture %s: %s", path.c_str(), why.c_str()), (nullptr));
  return false;
}

static bool OpenUdp(GstLidarOusterSrc* self) {
  State& state = StateOf(self);
  const OusterSettings& s = state.active;
  const guint port = s.lidar_port != 0 ? s.lidar_port : state.stream->metadata().lidar_port;
  const auto opened = state.udp.Open(s, port);
  if (!opened.ok) {
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ, ("%s", opened.error.c_str()), (nullptr));
    return false;
  }
  if (opened.granted_buffer < s.buffer_size)
    GST_ELEMENT_WARNING(
        self, RESOURCE, SETTINGS,
        ("The kernel granted a receive buffer of %u bytes instead of %u: packets may be lost",
         opened.granted_buffer, s.buffer_size),
        ("raise it with: sysctl -w net.core.rmem_max=%u", s.buffer_size));
  std::lock_guard lock(state.mutex);
  state.counters.receive_buffer = opened.granted_buffer;
  return true;
}

static gboolean Stop(GstBaseSrc* base) {
  State& state = StateOf(base);
  state.udp.Close();
  state.pcap.reset();
  state.stream.reset();
  std::lock_guard lock(state.mutex);
  state.slice_duration = GST_CLOCK_TIME_NONE;
  return TRUE;
}

static gboolean Start(GstBaseSrc* base) {
  auto* self = GST_LIDAR_OUSTER_SRC(base);
  State& state = StateOf(self);
  {
    std::lock_guard lock(state.mutex);
    state.active = state.settings;
    state.counters = {};
    state.flushing = false;
  }
  state.ended = state.size_reported = state.init_id_reported = false;
  state.pace_start = GST_CLOCK_TIME_NONE;
  state.udp.ClearWake();
  auto metadata = LoadMetadata(self, state.active);
  if (!metadata || !SetMetadata(self, *std::move(metadata)) ||
      !(state.active.from_file() ? OpenCapture(self) : OpenUdp(self))) {
    Stop(base);
    return FALSE;
  }
  return TRUE;
}

static GstClockTime RunningTime(GstLidarOusterSrc* self) {
  GstClock* clock = gst_element_get_clock(GST_ELEMENT(self));
  if (clock == nullptr) return 0;
  const GstClockTime now = gst_clock_get_time(clock);
  gst_object_unref(clock);
  const GstClockTime base_time = gst_element_get_base_time(GST_ELEMENT(self));
  return now > base_time ? now - base_time : 0;
}

static Time ToTime(GstClockTime time) { return Time(Duration(static_cast<gint64>(time))); }

/// Waits for the pipeline's clock; false when it was woken to stop.
static bool WaitUntil(GstLidarOusterSrc* self, GstClockTime running_time) {
  State& state = StateOf(self);
  const std::unique_ptr<GstClock, Unref> clock(gst_element_get_clock(GST_ELEMENT(self)));
  if (!clock) return true;
  const GstClockTime base_time = gst_element_get_base_time(GST_ELEMENT(self));
  std::unique_lock lock(state.mutex);
  if (state.flushing) return false;
  GstClockID id = gst_clock_new_single_shot_id(clock.get(), base_time + running_time);
  state.wait = id;
  lock.unlock();
  const GstClockReturn outcome = gst_clock_id_wait(id, nullptr);
  lock.lock();
  state.wait = nullptr;
  gst_clock_id_unref(id);
  return outcome != GST_CLOCK_UNSCHEDULED;
}

/// Says once what is wrong with packets that do not fit.
static void Report(GstLidarOusterSrc* self, PacketVerdict verdict, gsize size) {
  State& state = StateOf(self);
  const ouster::Metadata& m = state.stream->metadata();
  if (verdict == PacketVerdict::kWrongSize && !state.active.from_file() && !state.size_reported) {
    state.size_reported = true;
    GST_ELEMENT_WARNING(
        self, STREAM, WRONG_TYPE,
        ("Packets of %" G_GSIZE_FORMAT " bytes come where the metadata asks for %" G_GSIZE_FORMAT,
         size, m.format.packet_size()),
        ("is it the metadata of this sensor (%s, %s), and of the profile and mode it is in now?",
         m.serial_text.c_str(), std::string(ToString(m.format.profile)).c_str()));
  }
  if (verdict == PacketVerdict::kForeign) GST_LOG_OBJECT(self, "packet of another sensor");
  if (verdict == PacketVerdict::kDamaged) GST_DEBUG_OBJECT(self, "packet with a wrong CRC");
}

static void Push(GstLidarOusterSrc* self, ByteView payload, const ouster::Arrival& arrival) {
  State& state = StateOf(self);
  PacketVerdict verdict = state.stream->Push(payload, arrival);
  if (verdict == PacketVerdict::kNewInitId) {
    if (!state.init_id_reported)
      GST_ELEMENT_WARNING(self, STREAM, WRONG_TYPE,
                          ("The sensor restarted or was reconfigured since its metadata was saved"),
                          ("points are right as long as its mode and profile are the same"));
    state.init_id_reported = true;
    state.stream->AcceptAnyInitId();
    verdict = state.stream->Push(payload, arrival);
  }
  Report(self, verdict, payload.size);
}

static void UpdateCounters(State& state) {
  std::lock_guard lock(state.mutex);
  state.counters.batcher = state.stream->batcher().stats();
  state.counters.stream = state.stream->stats();
  state.counters.kernel_drops = state.udp.kernel_drops();
  state.counters.synchronised = state.stream->has_synchronised_clock();
}

static GstFlowReturn EndOfCapture(GstLidarOusterSrc* self) {
  State& state = StateOf(self);
  const PcapFeed& pcap = *state.pcap;
  const char* path = state.active.location.c_str();
  if (!pcap.found_lidar_packets()) {
    GST_ELEMENT_ERROR(self, STREAM, WRONG_TYPE,
                      ("%s is no capture of the sensor in the metadata: %s", path,
                       pcap.DescribeContents().c_str()),
                      ("set the property metadata to the file that was saved with the capture"));
    return GST_FLOW_ERROR;
  }
  if (state.stream->batcher().stats().packets == 0) {
    GST_ELEMENT_ERROR(self, STREAM, WRONG_TYPE,
                      ("%s holds packets of another sensor than the metadata's (serial number %s)",
                       path, state.stream->metadata().serial_text.c_str()),
                      ("set the property metadata to the file that was saved with the capture"));
    return GST_FLOW_ERROR;
  }
  if (!pcap.error().empty())
    GST_ELEMENT_WARNING(self, STREAM, DECODE, ("%s is cut short", path),
                        ("%s", pcap.error().c_str()));
  state.stream->Flush();
  state.ended = true;
  return GST_FLOW_OK;
}

/// One packet of the capture, at its time where that is asked for.
static GstFlowReturn ReadPacket(GstLidarOusterSrc* self) {
  State& state = StateOf(self);
  auto packet = state.pcap->Next();
  if (!packet) return EndOfCapture(self);
  ouster::Arrival arrival{Time(packet->due), packet->captured};
  if (state.active.is_live) {
    if (!GST_CLOCK_TIME_IS_VALID(state.pace_start)) {
      state.pace_start = RunningTime(self);
      state.pace_start_utc = UtcNow();
    }
    const auto due = static_cast<GstClockTime>(packet->due.count());
    if (!WaitUntil(self, state.pace_start + due)) return GST_FLOW_FLUSHING;
    arrival.local = ToTime(state.pace_start) + packet->due;
    arrival.utc = state.pace_start_utc + packet->due;
  }
  if (packet->starts_over) state.stream->Restart();
  Push(self, {packet->payload.data(), packet->payload.size()}, arrival);
  return GST_FLOW_OK;
}

static GstFlowReturn ReceivePackets(GstLidarOusterSrc* self) {
  State& state = StateOf(self);
  const Time now = ToTime(RunningTime(self));
  const Time utc_now = UtcNow();
  const auto outcome = state.udp.Receive(-1, [&](const ReceivedDatagram& d) {
    const Time utc = GST_CLOCK_TIME_IS_VALID(d.arrival) ? ToTime(d.arrival) : utc_now;
    Push(self, {d.data, d.size}, {now + (utc - utc_now), utc});
  });
  switch (outcome) {
    case UdpFeed::Outcome::kWoken:
      return GST_FLOW_FLUSHING;
    case UdpFeed::Outcome::kError:
      GST_ELEMENT_ERROR(self, RESOURCE, READ, ("Receiving failed: %s", g_strerror(errno)),
                        (nullptr));
      return GST_FLOW_ERROR;
    case UdpFeed::Outcome::kPackets:
    case UdpFeed::Outcome::kTimeout:
      break;
  }
  return GST_FLOW_OK;
}

static GstFlowReturn Create(GstPushSrc* push, GstBuffer** out) {
  auto* self = GST_LIDAR_OUSTER_SRC(push);
  State& state = StateOf(self);
  for (;;) {
    if (auto slice = state.stream->Pop()) {
      if (state.caps_pending) {
        const CapsPtr caps(CapsOf(*state.stream));
        state.caps_pending = false;
        if (!gst_base_src_set_caps(GST_BASE_SRC(self), caps.get())) return GST_FLOW_NOT_NEGOTIATED;
      }
      *out = ToBuffer(*std::move(slice), state.stream->slice_duration());
      return GST_FLOW_OK;
    }
    if (state.ended) return GST_FLOW_EOS;
    const GstFlowReturn flow = state.active.from_file() ? ReadPacket(self) : ReceivePackets(self);
    if (flow != GST_FLOW_OK) return flow;
    UpdateCounters(state);
  }
}

static gboolean Unlock(GstBaseSrc* base) {
  State& state = StateOf(base);
  state.udp.Wake();
  std::lock_guard lock(state.mutex);
  state.flushing = true;
  if (state.wait != nullptr) gst_clock_id_unschedule(state.wait);
  return TRUE;
}

static gboolean UnlockStop(GstBaseSrc* base) {
  State& state = StateOf(base);
  state.udp.ClearWake();
  std::lock_guard lock(state.mutex);
  state.flushing = false;
  return TRUE;
}

static gboolean Query(GstBaseSrc* base, GstQuery* query) {
  State& state = StateOf(base);
  if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY || !gst_base_src_is_live(base))
    return GST_BASE_SRC_CLASS(gst_lidar_ouster_src_parent_class)->query(base, query);
  std::lock_guard lock(state.mutex);
  if (!GST_CLOCK_TIME_IS_VALID(state.slice_duration)) return FALSE;
  gst_query_set_latency(query, TRUE, state.slice_duration, GST_CLOCK_TIME_NONE);
  return TRUE;
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    State& state = StateOf(element);
    std::unique_lock lock(state.mutex);
    const bool live = state.settings.live();
    lock.unlock();
    gst_base_src_set_live(GST_BASE_SRC(element), live);
  }
  return GST_ELEMENT_CLASS(gst_lidar_ouster_src_parent_class)->change_state(element, transition);
}

static GstStructure* Stats(State& state) {
  std::lock_guard lock(state.mutex);
  const Counters& c = state.counters;
  return gst_structure_new(
      "application/x-ouster-src-stats", "packets", G_TYPE_UINT64, c.batcher.packets, "packets-lost",
      G_TYPE_UINT64, c.batcher.lost_packets, "packets-late", G_TYPE_UINT64, c.batcher.late_packets,
      "packets-duplicate", G_TYPE_UINT64, c.batcher.duplicate_packets, "packets-stray",
      G_TYPE_UINT64, c.batcher.stray_packets, "packets-wrong-size", G_TYPE_UINT64,
      c.stream.wrong_size, "packets-foreign", G_TYPE_UINT64, c.stream.foreign, "packets-damaged",
      G_TYPE_UINT64, c.stream.damaged, "packets-imu", G_TYPE_UINT64, c.stream.imu_packets,
      "dropped-by-kernel", G_TYPE_UINT64, c.kernel_drops, "restarts", G_TYPE_UINT64,
      c.batcher.restarts, "slices", G_TYPE_UINT64, c.batcher.slices, "slices-incomplete",
      G_TYPE_UINT64, c.batcher.incomplete_slices, "receive-buffer", G_TYPE_UINT, c.receive_buffer,
      "clock-synchronised", G_TYPE_BOOLEAN, c.synchronised, nullptr);
}

static void gst_lidar_ouster_src_init(GstLidarOusterSrc* self) {
  self->state = new State;
  gst_base_src_set_format(GST_BASE_SRC(self), GST_FORMAT_TIME);
}

static void InstallVmethods(GstLidarOusterSrcClass* klass) {
  auto* src = GST_BASE_SRC_CLASS(klass);
  src->start = Start;
  src->stop = Stop;
  src->unlock = Unlock;
  src->unlock_stop = UnlockStop;
  src->query = Query;
  src->is_seekable = [](GstBaseSrc*) -> gboolean { return FALSE; };
  // Caps are set with the first slice: the sensor says what they are.
  src->negotiate = [](GstBaseSrc*) -> gboolean { return TRUE; };
  GST_PUSH_SRC_CLASS(klass)->create = Create;
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
}

static void gst_lidar_ouster_src_class_init(GstLidarOusterSrcClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_ouster_src_debug, "ouster_src", 0, "Ouster sensors");
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = [](GObject* o, guint id, const GValue* v, GParamSpec*) {
    State& state = StateOf(o);
    std::lock_guard lock(state.mutex);
    SetProperty(state.settings, kOusterProperties[id - 1], v);
  };
  object->get_property = [](GObject* o, guint id, GValue* v, GParamSpec*) {
    State& state = StateOf(o);
    if (id == kPropStats) return g_value_take_boxed(v, Stats(state));
    std::lock_guard lock(state.mutex);
    GetProperty(state.settings, kOusterProperties[id - 1], v);
  };
  object->finalize = [](GObject* o) {
    delete GST_LIDAR_OUSTER_SRC(o)->state;
    G_OBJECT_CLASS(gst_lidar_ouster_src_parent_class)->finalize(o);
  };
  InstallProperties(object, kOusterProperties);
  g_object_class_install_property(
      object, kPropStats,
      g_param_spec_boxed("stats", "stats", "Counts of packets, slices and what went wrong",
                         GST_TYPE_STRUCTURE,
                         static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
  gst_type_mark_as_plugin_api(OusterReturnType(), static_cast<GstPluginAPIFlags>(0));
  gst_type_mark_as_plugin_api(OusterPtsFromType(), static_cast<GstPluginAPIFlags>(0));
  gst_type_mark_as_plugin_api(OusterInvalidType(), static_cast<GstPluginAPIFlags>(0));
  static GstStaticPadTemplate src = GST_STATIC_PAD_TEMPLATE(
      "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_CLOUD_MEDIA_TYPE));
  auto* element = GST_ELEMENT_CLASS(klass);
  gst_element_class_add_static_pad_template(element, &src);
  gst_element_class_set_static_metadata(element, "Ouster LiDAR source", "Source/Network",
                                        "Receives an Ouster sensor, or reads a capture of one",
                                        "gst-lidar");
  InstallVmethods(klass);
}
