// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/encoder/receivers.h"

#include <utility>

#include "gst/common/refs.h"

namespace lidar::gst {
namespace {

// The index in an entry without a slice. Such an entry is for an event that only names the
// receiver.
constexpr guint kNoSlice = G_MAXUINT;

/// Returns the linked pads to which the element of `sink` may send data from `sink`. Returns at
/// most two.
std::vector<PadPtr> WaysOut(GstPad* sink) {
  std::vector<PadPtr> ways;
  GstIterator* it = gst_pad_iterate_internal_links(sink);
  if (it == nullptr) return ways;
  GValue value = G_VALUE_INIT;
  for (bool more = true; more && ways.size() < 2;) {
    switch (gst_iterator_next(it, &value)) {
      case GST_ITERATOR_OK: {
        auto* pad = GST_PAD(g_value_get_object(&value));
        if (gst_pad_is_linked(pad)) ways.emplace_back(GST_PAD(gst_object_ref(pad)));
        g_value_reset(&value);
        break;
      }
      case GST_ITERATOR_RESYNC:
        ways.clear();
        gst_iterator_resync(it);
        break;
      default:
        more = false;
        break;
    }
  }
  g_value_unset(&value);
  gst_iterator_free(it);
  return ways;
}

}  // namespace

bool HasOneWay(GstPad* src) {
  constexpr int kMostHops = 64;
  PadPtr pad(GST_PAD(gst_object_ref(src)));
  for (int hop = 0; hop < kMostHops; ++hop) {
    const PadPtr sink(gst_pad_get_peer(pad.get()));
    if (!sink) return true;
    auto ways = WaysOut(sink.get());
    if (ways.empty()) return true;
    if (ways.size() > 1) return false;
    pad = std::move(ways.front());
  }
  return false;
}

bool ReceiverEvents::OnEvent(GstEvent* event) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_CUSTOM_UPSTREAM &&
      gst_event_has_name(event, "GstForceKeyUnit")) {
    std::lock_guard lock(mutex_);
    news_.key_requested = true;
    return true;
  }
  GstLidarSlicesReceived received{};
  if (!gst_lidar_event_parse_slices_received(event, &received)) return false;
  std::lock_guard lock(mutex_);
  if (received.count == 0 && news_.received.size() < kMostSlices)
    news_.received.push_back({received.receiver, 0, kNoSlice});
  for (guint i = 0; i < received.count && news_.received.size() < kMostSlices; ++i) {
    const GstLidarReceivedSlice& slice = received.slices[i];
    news_.received.push_back({received.receiver, slice.scan_id, slice.slice_index});
  }
  return true;
}

void ReceiverEvents::Forget() {
  std::lock_guard lock(mutex_);
  news_ = {};
}

ReceiverEvents::News ReceiverEvents::Take(GstPad* src) {
  News news;
  {
    std::lock_guard lock(mutex_);
    news = std::exchange(news_, {});
  }
  const gint64 now = g_get_monotonic_time();
  constexpr gint64 kLookInterval = G_USEC_PER_SEC / 10;
  if (looked_at_us_ == 0 || now - looked_at_us_ >= kLookInterval) {
    looked_at_us_ = now;
    const bool had_one_way = std::exchange(one_way_, HasOneWay(src));
    // The data now also reach a second receiver, which does not have the earlier slices.
    news.key_requested = news.key_requested || (had_one_way && !one_way_);
  }
  if (!one_way_) news.received.clear();
  return news;
}

}  // namespace lidar::gst
