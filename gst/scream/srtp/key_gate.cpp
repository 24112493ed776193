// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/key_gate.h"

#include "gst/common/latency.h"
#include "gst/common/packet_probe.h"

namespace lidar::gst {
namespace {

bool IsFedLive(GstPad* pad) {
  const QueryPtr query(gst_query_new_latency());
  return !gst_pad_peer_query(pad, query.get()) || ReadLatency(query.get()).live;
}

}  // namespace

void KeyGate::Guard(const std::shared_ptr<KeyGate>& gate, GstPad* pad) {
  const std::lock_guard lock(gate->mutex_);
  if (gate->is_open_) return;
  const gulong probe = gst_pad_add_probe(
      pad, static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BLOCK | kPacketProbe),
      [](GstPad* p, GstPadProbeInfo* info, gpointer held) {
        return (*static_cast<std::shared_ptr<KeyGate>*>(held))->OnPackets(p, info);
      },
      new std::shared_ptr<KeyGate>(gate),
      [](gpointer held) { delete static_cast<std::shared_ptr<KeyGate>*>(held); });
  gate->guarded_.emplace_back(GST_PAD(gst_object_ref(pad)), probe);
}

void KeyGate::Open() {
  std::unique_lock lock(mutex_);
  is_open_ = true;
  const auto guarded = std::exchange(guarded_, {});
  lock.unlock();
  for (const auto& [pad, probe] : guarded) gst_pad_remove_probe(pad.get(), probe);
}

GstPadProbeReturn KeyGate::OnPackets(GstPad* pad, GstPadProbeInfo* info) {
  if (is_open_) return GST_PAD_PROBE_PASS;
  if (!IsFedLive(pad)) return GST_PAD_PROBE_OK;  // the pad stays blocked
  const bool is_list = (info->type & GST_PAD_PROBE_TYPE_BUFFER_LIST) != 0;
  dropped_ += is_list ? gst_buffer_list_length(GST_PAD_PROBE_INFO_BUFFER_LIST(info)) : 1;
  return GST_PAD_PROBE_DROP;
}

}  // namespace lidar::gst
