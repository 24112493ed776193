// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/system/faults/ends.h"

#include <malloc.h>
#include <sys/resource.h>

#include <stdexcept>
#include <thread>

#include "gst/common/buffer_map.h"
#include "src/base/crc.h"

namespace lidar::test {
namespace {

using std::chrono::milliseconds;

// The number of slices whose hashes are kept. The sensor needs about four minutes for this number
// of slices.
constexpr std::size_t kRemembered = 20'000;

/// Calls `call(buffer)` for each buffer that passes the pad.
template <class Call>
void Watch(GstElement* element, const char* pad_name, Call* call) {
  const gst::PadPtr pad(gst_element_get_static_pad(element, pad_name));
  gst_pad_add_probe(
      pad.get(),
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST),
      [](GstPad*, GstPadProbeInfo* info, gpointer data) {
        auto& f = *static_cast<Call*>(data);
        if ((info->type & GST_PAD_PROBE_TYPE_BUFFER) != 0) {
          f(GST_PAD_PROBE_INFO_BUFFER(info));
        } else {
          GstBufferList* list = GST_PAD_PROBE_INFO_BUFFER_LIST(info);
          for (guint i = 0; i < gst_buffer_list_length(list); ++i) f(gst_buffer_list_get(list, i));
        }
        return GST_PAD_PROBE_OK;
      },
      call, [](gpointer data) { delete static_cast<Call*>(data); });
}

}  // namespace

std::uint32_t Hash(GstBuffer* buffer) {
  const gst::BufferMap map(buffer, GST_MAP_READ);
  return Crc32(map.view());
}

void SentSlices::Add(std::uint32_t hash) {
  std::lock_guard lock(mutex_);
  hashes_.insert(hash);
  order_.push_back(hash);
  if (order_.size() <= kRemembered) return;
  hashes_.erase(hashes_.find(order_.front()));
  order_.pop_front();
}

bool SentSlices::Has(std::uint32_t hash) const {
  std::lock_guard lock(mutex_);
  return hashes_.count(hash) != 0;
}

Pipeline::Pipeline(const std::string& description) {
  GError* error = nullptr;
  pipeline_.reset(gst_parse_launch(description.c_str(), &error));
  if (error != nullptr) throw std::runtime_error(description + ": " + error->message);
}

Pipeline::~Pipeline() { SetState(GST_STATE_NULL); }

void Pipeline::SetState(GstState state) {
  gst_element_set_state(get(), state);
  gst_element_get_state(get(), nullptr, nullptr, 5 * GST_SECOND);
}

bool Pipeline::Finish(milliseconds limit) {
  gst_element_send_event(get(), gst_event_new_eos());
  return AwaitEnd(limit);
}

bool Pipeline::AwaitEnd(milliseconds limit) {
  GstBus* bus = gst_element_get_bus(get());
  const gst::MessagePtr message(gst_bus_timed_pop_filtered(
      bus, static_cast<GstClockTime>(limit.count()) * GST_MSECOND, GST_MESSAGE_EOS));
  gst_object_unref(bus);
  return message != nullptr;
}

gst::ElementPtr Pipeline::Child(const char* name) const {
  return gst::ElementPtr(gst_bin_get_by_name(GST_BIN(get()), name));
}

std::uint64_t Pipeline::Stat(const char* element, const char* name) const {
  GstStructure* stats = nullptr;
  g_object_get(Child(element).get(), "stats", &stats, nullptr);
  if (stats == nullptr) return UINT64_MAX;
  const gst::StructurePtr owner(stats);
  guint64 value = G_MAXUINT64;
  guint small = 0;
  if (gst_structure_get_uint(stats, name, &small)) return small;
  gst_structure_get_uint64(stats, name, &value);
  return value;
}

std::string Pipeline::Error() const {
  GstBus* bus = gst_element_get_bus(get());
  const gst::MessagePtr message(gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR));
  gst_object_unref(bus);
  if (!message) return "";
  GError* error = nullptr;
  gst_message_parse_error(message.get(), &error, nullptr);
  const gst::ErrorPtr owner(error);
  return error->message;
}

unsigned Pipeline::Messages(GstMessageType type) const {
  GstBus* bus = gst_element_get_bus(get());
  unsigned n = 0;
  while (GstMessage* m = gst_bus_pop_filtered(bus, type)) {
    gst_message_unref(m);
    ++n;
  }
  gst_object_unref(bus);
  return n;
}

SendingEnd::SendingEnd(SentSlices* sent, std::uint16_t port, const std::string& sink_options)
    : pipeline_(
          "lidartestsrc is-live=true model=os0-32 mode=512x10 ! dracoenc max-error=0.05 ! "
          "rtplidarpay name=pay mtu=1200 ! screamsink name=net max-bitrate=20000000 port=" +
          std::to_string(port) + " " + sink_options) {
  Watch(pipeline_.Child("pay").get(), "sink",
        new auto([sent](GstBuffer* b) { sent->Add(Hash(b)); }));
}

ReceivingEnd::ReceivingEnd(const SentSlices* sent, std::uint16_t port,
                           const std::string& source_options)
    : sent_(sent),
      pipeline_("screamsrc name=net port=" + std::to_string(port) + " " + source_options +
                " ! rtplidardepay name=depay ! dracodec ! "
                "fakesink name=out sync=false async=false") {
  Watch(pipeline_.Child("depay").get(), "src", new auto([this](GstBuffer* b) {
          if (sent_ != nullptr && !sent_->Has(Hash(b))) ++foreign_;
        }));
  Watch(pipeline_.Child("out").get(), "sink", new auto([this](GstBuffer*) { ++clouds_; }));
}

Accounts ReceivingEnd::accounts() const {
  const auto stat = [this](const char* name) { return pipeline_.Stat("depay", name); };
  Accounts a;
  a.received = stat("slices-received");
  a.lost = stat("slices-lost");
  a.damaged = stat("slices-damaged");
  a.mismatch = stat("slices-config-mismatch");
  a.skipped = stat("slices-skipped");
  a.complete = stat("scans-complete");
  a.incomplete = stat("scans-incomplete");
  a.scans_lost = stat("scans-lost");
  a.restarts = stat("sender-restarts");
  a.outages = stat("outages");
  return a;
}

milliseconds ReceivingEnd::NextCloud(milliseconds limit) const {
  const auto start = std::chrono::steady_clock::now();
  const std::uint64_t before = clouds_;
  while (clouds_ == before) {
    const auto waited = std::chrono::steady_clock::now() - start;
    if (waited > limit) return milliseconds::max();
    std::this_thread::sleep_for(milliseconds(2));
  }
  return std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - start);
}

std::uint64_t AllocatedBytes() {
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

milliseconds CpuTime() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto of = [](const timeval& t) {
    return std::chrono::seconds(t.tv_sec) + std::chrono::microseconds(t.tv_usec);
  };
  return std::chrono::duration_cast<milliseconds>(of(usage.ru_utime) + of(usage.ru_stime));
}

}  // namespace lidar::test
