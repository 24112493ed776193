// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/edge/pipeline.h"

#include <stdexcept>
#include <string>

#include "src/tools/apps/fleet/connection.h"
#include "src/tools/common/elements.h"

namespace lidar::edge {
namespace {

using gst::ElementPtr;
using gst::PadPtr;
using tools::SetText;

// Limits of the queue in front of the recorder, which fills while the disk is slow. The limit of
// buffers bounds the overhead of tiny buffers. The limit of time bounds the number of events
// between the buffers.
constexpr guint kRecordQueue = 8U << 20;  // bytes
constexpr guint kRecordQueueBuffers = 16'384;
constexpr GstClockTime kRecordQueueTime = 30 * GST_SECOND;
constexpr GstClockTime kDrainTimeout = GST_SECOND;
constexpr const char* kRecorder = "recorder";

GstElement* Add(GstElement* bin, const char* factory) {
  return tools::AddElement(bin, factory, factory);
}

void Link(GstElement* from, GstElement* to) {
  if (!gst_element_link(from, to)) throw std::runtime_error("elements cannot be linked");
}

/// Adds a sink that publishes the stream to NATS. If `nats.jetstream` is set, the sinks of all
/// robots use this JetStream stream, which the first of the sinks creates.
void AddNats(GstElement* pipeline, GstElement* from, const NatsConfig& nats,
             const RobotConfig& robot) {
  GstElement* sink = Add(pipeline, "natssink");
  g_object_set(sink, "sync", FALSE, "async", FALSE, "keep-trying", TRUE, "subject",
               StreamSubject(nats, robot).c_str(), "jetstream-subjects",
               (nats.prefix + ".*.lidar.>").c_str(), "replicas", static_cast<guint>(nats.replicas),
               "max-age", nats.max_age_s * GST_SECOND, "max-bytes", nats.max_bytes, "buffer-size",
               static_cast<guint>(nats.buffer_size), "drain-timeout", kDrainTimeout, nullptr);
  SetText(sink, "jetstream", nats.jetstream);
  fleet::SetConnection(sink, *nats.connection);
  Link(from, sink);
}

ElementPtr RecorderOf(GstElement* pipeline) {
  return ElementPtr(gst_bin_get_by_name(GST_BIN(pipeline), kRecorder));
}

/// Makes the pad report success upstream, whatever happens downstream.
void Shield(GstPad* pad) {
  gst_pad_set_chain_function(pad, [](GstPad* self, GstObject* parent, GstBuffer* buffer) {
    gst_proxy_pad_chain_default(self, parent, buffer);
    return GST_FLOW_OK;
  });
  gst_pad_set_chain_list_function(pad, [](GstPad* self, GstObject* parent, GstBufferList* list) {
    gst_proxy_pad_chain_list_default(self, parent, list);
    return GST_FLOW_OK;
  });
}

}  // namespace

ElementPtr MakePipeline(const EdgeConfig& config, const RobotConfig& robot, GSocket* socket) {
  const std::string name = robot.name + "-" + robot.sensor;
  ElementPtr pipeline(GST_ELEMENT(gst_object_ref_sink(gst_pipeline_new(name.c_str()))));
  GstElement* source = Add(pipeline.get(), "screamsrc");
  g_object_set(source, "eos-on-bye", TRUE, "socket", socket, "close-socket", FALSE, nullptr);
  if (robot.port != 0) g_object_set(source, "port", static_cast<guint>(robot.port), nullptr);
  SetText(source, "address", config.address);
  SetText(source, "srtp-key", robot.srtp_key);
  SetText(source, "srtp-cipher", robot.srtp_cipher);
  SetText(source, "dtls-certificate", robot.dtls_certificate);
  SetText(source, "dtls-peer-certificate", robot.dtls_peer_certificate);
  GstElement* depayloader = Add(pipeline.get(), "rtplidardepay");
  GstElement* tee = Add(pipeline.get(), "tee");
  g_object_set(tee, "allow-not-linked", TRUE, nullptr);
  Link(source, depayloader);
  Link(depayloader, tee);
  if (config.nats.connection) AddNats(pipeline.get(), tee, config.nats, robot);
  return pipeline;
}

void AddRecorder(GstElement* pipeline, const RobotConfig& robot) {
  GstElement* recorder = gst_bin_new(kRecorder);
  gst_bin_add(GST_BIN(pipeline), recorder);
  // If the disk is slow, the queue drops data, so that only the recording suffers.
  GstElement* queue = Add(recorder, "queue");
  gst_util_set_object_arg(G_OBJECT(queue), "leaky", "downstream");
  g_object_set(queue, "max-size-buffers", kRecordQueueBuffers, "max-size-time", kRecordQueueTime,
               "max-size-bytes", kRecordQueue, nullptr);
  GstElement* sink = Add(recorder, "mcapsink");
  g_object_set(sink, "location", robot.record.c_str(), "max-file-size", robot.record_max_file_size,
               "max-files", static_cast<guint>(robot.record_max_files), nullptr);
  Link(queue, sink);
  const PadPtr inner(gst_element_get_static_pad(queue, "sink"));
  GstPad* entry = gst_ghost_pad_new("sink", inner.get());
  Shield(entry);
  gst_element_add_pad(recorder, entry);
  gst_element_sync_state_with_parent(recorder);  // errors appear on the bus
  const ElementPtr tee(gst_bin_get_by_name(GST_BIN(pipeline), "tee"));
  Link(tee.get(), recorder);
}

void RemoveRecorder(GstElement* pipeline) {
  const ElementPtr recorder = RecorderOf(pipeline);
  if (!recorder) return;
  const ElementPtr tee(gst_bin_get_by_name(GST_BIN(pipeline), "tee"));
  const PadPtr entry(gst_element_get_static_pad(recorder.get(), "sink"));
  const PadPtr exit(entry ? gst_pad_get_peer(entry.get()) : nullptr);
  if (exit) gst_element_release_request_pad(tee.get(), exit.get());
  gst_element_set_locked_state(recorder.get(), TRUE);
  gst_element_set_state(recorder.get(), GST_STATE_NULL);
  gst_bin_remove(GST_BIN(pipeline), recorder.get());
}

bool IsFromRecorder(GstMessage* message) {
  // Compares names, because the recorder may have been removed from the pipeline already.
  for (const char* name : {kRecorder, "queue", "mcapsink"})
    if (g_strcmp0(GST_MESSAGE_SRC_NAME(message), name) == 0) return true;
  return false;
}

bool Drain(GstElement* pipeline, GstClockTime timeout,
           const std::function<void(GstMessage*)>& on_recorder_error) {
  const GstClockTime end = gst_util_get_timestamp() + timeout;
  const ElementPtr source(gst_bin_get_by_name(GST_BIN(pipeline), "screamsrc"));
  gst_element_send_event(source.get(), gst_event_new_eos());
  while (true) {
    const GstClockTime now = gst_util_get_timestamp();
    const gst::MessagePtr message(gst_bus_timed_pop_filtered(
        GST_ELEMENT_BUS(pipeline), end > now ? end - now : 0,
        static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR)));
    if (!message) return false;
    if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS) return true;
    if (!IsFromRecorder(message.get())) return false;
    on_recorder_error(message.get());
  }
}

}  // namespace lidar::edge
