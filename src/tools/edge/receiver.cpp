// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/edge/receiver.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace lidar::edge {
namespace {

using gst::ElementPtr;
using gst::MessagePtr;
using gst::StructurePtr;
using std::chrono::seconds;

constexpr seconds kAfterFailure{2};
constexpr seconds kAfterFlood{10};
constexpr seconds kSilence{10};           // a robot that is silent for as long is gone
constexpr int kPatience = 3;              // seconds that a robot may be above its limit
constexpr guint kRecordQueue = 8U << 20;  // bytes that wait for a slow disk

GstElement* Add(GstElement* bin, const char* factory) {
  GstElement* element = gst_element_factory_make(factory, factory);
  if (element == nullptr)
    throw std::runtime_error(std::string("the element ") + factory + " is not installed");
  gst_bin_add(GST_BIN(bin), element);
  return element;
}

void Link(GstElement* from, GstElement* to) {
  if (!gst_element_link(from, to)) throw std::runtime_error("elements cannot be linked");
}

/// NULL stays the default.
void SetText(GstElement* element, const char* property, const std::string& value) {
  if (!value.empty()) g_object_set(element, property, value.c_str(), nullptr);
}

void AddNats(GstElement* pipeline, GstElement* from, const NatsConfig& nats,
             const RobotConfig& robot) {
  GstElement* sink = Add(pipeline, "natssink");
  g_object_set(sink, "sync", FALSE, "url", nats.url.c_str(), "subject",
               StreamSubject(nats, robot).c_str(), "max-age", nats.max_age_s * GST_SECOND,
               "max-bytes", nats.max_bytes, "buffer-size", static_cast<guint>(nats.buffer_size),
               nullptr);
  SetText(sink, "jetstream", nats.jetstream);
  SetText(sink, "credentials-file", nats.credentials_file);
  SetText(sink, "tls-ca-file", nats.tls_ca_file);
  SetText(sink, "tls-cert-file", nats.tls_cert_file);
  SetText(sink, "tls-key-file", nats.tls_key_file);
  Link(from, sink);
}

/// A disk that is slow costs the recording, and nothing else.
void AddRecorder(GstElement* pipeline, GstElement* from, const RobotConfig& robot) {
  GstElement* queue = Add(pipeline, "queue");
  gst_util_set_object_arg(G_OBJECT(queue), "leaky", "downstream");
  g_object_set(queue, "max-size-buffers", 0, "max-size-time", guint64{0}, "max-size-bytes",
               kRecordQueue, nullptr);
  GstElement* sink = Add(pipeline, "mcapsink");
  g_object_set(sink, "location", robot.record.c_str(), "max-file-size", robot.record_max_file_size,
               "max-files", static_cast<guint>(robot.record_max_files), nullptr);
  Link(from, queue);
  Link(queue, sink);
}

ElementPtr MakePipeline(const EdgeConfig& config, const RobotConfig& robot) {
  const std::string name = robot.name + "-" + robot.sensor;
  ElementPtr pipeline(GST_ELEMENT(gst_object_ref_sink(gst_pipeline_new(name.c_str()))));
  GstElement* source = Add(pipeline.get(), "screamsrc");
  g_object_set(source, "port", static_cast<guint>(robot.port), "eos-on-bye", TRUE, nullptr);
  SetText(source, "address", config.address);
  if (!robot.srtp_key.empty()) {
    g_object_set(source, "srtp-cipher", robot.srtp_cipher.c_str(), "srtp-key",
                 robot.srtp_key.c_str(), nullptr);
  }
  GstElement* depayloader = Add(pipeline.get(), "rtplidardepay");
  GstElement* tee = Add(pipeline.get(), "tee");
  g_object_set(tee, "allow-not-linked", TRUE, nullptr);
  Link(source, depayloader);
  Link(depayloader, tee);
  if (!config.nats.url.empty()) AddNats(pipeline.get(), tee, config.nats, robot);
  if (!robot.record.empty()) AddRecorder(pipeline.get(), tee, robot);
  return pipeline;
}

std::string Text(GstMessage* message) {
  GError* raw = nullptr;
  const auto parse = GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR ? gst_message_parse_error
                                                                    : gst_message_parse_warning;
  parse(message, &raw, nullptr);
  const gst::ErrorPtr error(raw);
  return std::string(GST_MESSAGE_SRC_NAME(message)) + ": " + error->message;
}

constexpr const char* kElements[] = {"screamsrc", "rtplidardepay", "natssink", "mcapsink"};

}  // namespace

Receiver::Receiver(const EdgeConfig& config, const RobotConfig& robot)
    : config_(config), robot_(robot), pipeline_(MakePipeline(config, robot)) {}

Receiver::~Receiver() { End(); }

void Receiver::Begin() {
  ++sessions_;
  state_ = State::kWaiting;
  watch_at_.reset();
  bytes_ = 0;
  fast_seconds_ = 0;
  // An error is read from the bus.
  gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
}

void Receiver::End() { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }

void Receiver::Rest(Clock::time_point now, seconds pause, const std::string& why) {
  End();
  state_ = State::kResting;
  begin_at_ = now + pause;
  if (!why.empty()) std::fprintf(stderr, "%s: %s\n", GST_OBJECT_NAME(pipeline_.get()), why.c_str());
}

/// False where the session is over.
bool Receiver::ReadBus(Clock::time_point now) {
  GstBus* bus = GST_ELEMENT_BUS(pipeline_.get());
  while (const MessagePtr message{gst_bus_pop(bus)}) {
    switch (GST_MESSAGE_TYPE(message.get())) {
      case GST_MESSAGE_ERROR:
        ++failures_;
        last_error_ = Text(message.get());
        Rest(now, kAfterFailure, last_error_);
        return false;
      case GST_MESSAGE_WARNING:
        last_error_ = Text(message.get());
        std::fprintf(stderr, "%s: %s\n", GST_OBJECT_NAME(pipeline_.get()), last_error_.c_str());
        break;
      case GST_MESSAGE_EOS:
        Rest(now, seconds(0), "the robot has said goodbye");
        return false;
      default:
        break;
    }
  }
  return true;
}

StructurePtr Receiver::StatsOf(const char* element) const {
  const ElementPtr found(gst_bin_get_by_name(GST_BIN(pipeline_.get()), element));
  GstStructure* raw = nullptr;
  if (found) g_object_get(found.get(), "stats", &raw, nullptr);
  return StructurePtr(raw);
}

guint64 Receiver::BytesReceived() const {
  guint64 bytes = 0;
  if (const StructurePtr stats = StatsOf("screamsrc"))
    gst_structure_get_uint64(stats.get(), "bytes-received", &bytes);
  return bytes;
}

/// Once a second: is the robot there, and does it keep to its limit?
void Receiver::Watch(Clock::time_point now) {
  if (watch_at_ && now < *watch_at_) return;
  const bool first = !watch_at_.has_value();
  const double passed = first ? 1 : 1 + std::chrono::duration<double>(now - *watch_at_).count();
  watch_at_ = now + seconds(1);
  const guint64 bytes = BytesReceived();
  const guint64 more = bytes - std::min(bytes_, bytes);
  bytes_ = bytes;
  if (more > 0) {
    if (state_ == State::kWaiting)
      std::fprintf(stderr, "%s: the robot is here\n", GST_OBJECT_NAME(pipeline_.get()));
    state_ = State::kReceiving;
    heard_at_ = now;
  } else if (state_ == State::kReceiving && now - heard_at_ > kSilence) {
    return Rest(now, seconds(0), "the robot is gone");
  }
  const double mbps = static_cast<double>(more) * 8e-6 / passed;
  const bool fast = robot_.max_mbps > 0 && mbps > robot_.max_mbps;
  fast_seconds_ = fast ? fast_seconds_ + 1 : 0;
  if (fast_seconds_ < kPatience) return;
  ++penalties_;
  Rest(now, kAfterFlood, "the robot sends more than max-mbps, and is shut out for a while");
}

void Receiver::Poll(Clock::time_point now) {
  if (sessions_ == 0 || (state_ == State::kResting && now >= begin_at_)) Begin();
  if (state_ == State::kResting) return;
  if (ReadBus(now)) Watch(now);
}

nlohmann::json Receiver::Statistics() const {
  static constexpr const char* kStates[] = {"waiting", "receiving", "resting"};
  nlohmann::json out = {{"robot", robot_.name},
                        {"sensor", robot_.sensor},
                        {"time", g_get_real_time() * 1000},
                        {"state", kStates[static_cast<int>(state_)]},
                        {"sessions", sessions_},
                        {"failures", failures_},
                        {"penalties", penalties_}};
  if (!last_error_.empty()) out["last-error"] = last_error_;
  for (const char* element : kElements)
    if (const StructurePtr stats = StatsOf(element)) out[element] = ToJson(stats.get());
  return out;
}

void Receiver::AddTo(Exposition* exposition) const {
  const std::string labels = "{robot=\"" + robot_.name + "\",sensor=\"" + robot_.sensor + "\"}";
  exposition->Add("lidar_edge_receiving", labels, state_ == State::kReceiving ? 1 : 0);
  exposition->Add("lidar_edge_sessions", labels, static_cast<double>(sessions_));
  exposition->Add("lidar_edge_failures", labels, static_cast<double>(failures_));
  exposition->Add("lidar_edge_penalties", labels, static_cast<double>(penalties_));
  for (const char* element : kElements)
    if (const StructurePtr stats = StatsOf(element)) exposition->Add(element, labels, stats.get());
}

}  // namespace lidar::edge
