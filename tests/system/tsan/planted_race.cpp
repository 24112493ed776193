// SPDX-License-Identifier: LGPL-2.1-or-later
// Lets two streaming threads increment a counter in callbacks that GStreamer calls, as elements do.
// That is a data race unless the option `--locked` is given. The test shows that tests/run.sh
// --tsan finds such a race.
#include <gst/gst.h>

#include <string>

namespace {

struct Counter {
  bool locked;
  GMutex mutex;
  guint64 buffers;
  guint64 last_time;
};

void Count(Counter* c, GstBuffer* buffer) {
  ++c->buffers;
  c->last_time = GST_BUFFER_PTS(buffer);
}

GstPadProbeReturn OnBuffer(GstPad*, GstPadProbeInfo* info, gpointer data) {
  auto* c = static_cast<Counter*>(data);
  if (c->locked) g_mutex_lock(&c->mutex);
  Count(c, GST_PAD_PROBE_INFO_BUFFER(info));
  if (c->locked) g_mutex_unlock(&c->mutex);
  return GST_PAD_PROBE_OK;
}

void Watch(GstElement* pipeline, const char* name, Counter* c) {
  GstElement* element = gst_bin_get_by_name(GST_BIN(pipeline), name);
  GstPad* pad = gst_element_get_static_pad(element, "sink");
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, OnBuffer, c, nullptr);
  gst_object_unref(pad);
  gst_object_unref(element);
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  static Counter counter{};
  counter.locked = argc == 2 && std::string(argv[1]) == "--locked";
  g_mutex_init(&counter.mutex);
  GstElement* pipeline = gst_parse_launch(
      "fakesrc num-buffers=500 ! identity name=before ! queue ! fakesink name=after", nullptr);
  Watch(pipeline, "before", &counter);
  Watch(pipeline, "after", &counter);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* end = gst_bus_timed_pop_filtered(bus, 60 * GST_SECOND, GST_MESSAGE_EOS);
  if (end != nullptr) gst_message_unref(end);
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  return 0;
}
