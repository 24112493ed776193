// SPDX-License-Identifier: LGPL-2.1-or-later
#include "scream/srtp_input.h"

#include <algorithm>

namespace lidar::gst {
namespace {

// The one in use, the one before and the one to come.
constexpr std::size_t kMaxKeys = 3;
constexpr gint64 kStragglersUs = 10 * G_USEC_PER_SEC;
constexpr std::size_t kMaxStreams = 1'024;
// Losses long enough to lose count of a rollover look like this.
constexpr unsigned kFailuresUntilLost = 500;
constexpr std::uint32_t kMaxRollover = 100'000;  // months
constexpr unsigned kFailuresUntilWarning = 20;

SrtpInput* InputOf(GstPad* pad) {
  return static_cast<SrtpInput*>(gst_pad_get_element_private(pad));
}

/// Where RTP and RTCP have the SSRC of the sender; 0 where there is none.
std::uint32_t SsrcOf(GstBuffer* datagram) {
  guint8 head[12] = {};
  const gsize size = gst_buffer_extract(datagram, 0, head, sizeof head);
  const bool rtcp = head[1] >= 192 && head[1] <= 223;
  const gsize at = rtcp ? 4 : 8;
  return size >= at + 4 ? GST_READ_UINT32_BE(head + at) : 0;
}

}  // namespace

SrtpInput::SrtpInput(GstElement* bin, const SrtpPolicy& policy, OnNewKey on_new_key)
    : bin_(bin), policy_(policy), on_new_key_(std::move(on_new_key)) {
  InstallEntry();
  InstallExit();
}

void SrtpInput::InstallEntry() {
  entry_.reset(GST_PAD(gst_object_ref_sink(gst_pad_new("entry", GST_PAD_SINK))));
  GstPad* pad = entry_.get();
  gst_pad_set_element_private(pad, this);
  gst_pad_set_chain_function(pad, [](GstPad* p, GstObject*, GstBuffer* datagram) {
    const BufferPtr owner(datagram);
    return InputOf(p)->OnDatagram(datagram);
  });
  gst_pad_set_event_function(pad, [](GstPad* p, GstObject*, GstEvent* event) -> gboolean {
    SrtpInput* self = InputOf(p);
    if (GST_EVENT_TYPE(event) == GST_EVENT_STREAM_START) self->Reset();
    return gst_pad_push_event(self->exit_.get(), event);
  });
  gst_pad_set_query_function(pad, [](GstPad* p, GstObject*, GstQuery* query) {
    return gst_pad_peer_query(InputOf(p)->exit_.get(), query);
  });
  gst_pad_set_active(pad, TRUE);
}

void SrtpInput::InstallExit() {
  exit_.reset(GST_PAD(gst_object_ref_sink(gst_pad_new("exit", GST_PAD_SRC))));
  GstPad* pad = exit_.get();
  gst_pad_set_element_private(pad, this);
  gst_pad_set_event_function(pad, [](GstPad* p, GstObject*, GstEvent* event) -> gboolean {
    return gst_pad_push_event(InputOf(p)->entry_.get(), event);
  });
  gst_pad_set_query_function(pad, [](GstPad* p, GstObject*, GstQuery* query) {
    return gst_pad_peer_query(InputOf(p)->entry_.get(), query);
  });
  gst_pad_set_active(pad, TRUE);
}

SrtpInput::~SrtpInput() {
  for (GstPad* pad : {entry_.get(), exit_.get()}) {
    const PadPtr peer(gst_pad_get_peer(pad));
    if (peer && pad == entry_.get()) gst_pad_unlink(peer.get(), pad);
    if (peer && pad == exit_.get()) gst_pad_unlink(pad, peer.get());
    gst_pad_set_active(pad, FALSE);
  }
}

bool SrtpInput::Link(GstPad* socket, GstPad* target) {
  return gst_pad_link(exit_.get(), target) == GST_PAD_LINK_OK &&
         gst_pad_link(socket, entry_.get()) == GST_PAD_LINK_OK;
}

bool SrtpInput::AddKey(const SrtpKey& key) {
  auto decoder = SrtpDecoder::Create(bin_, policy_, key, exit_.get());
  if (!decoder) return false;
  std::lock_guard lock(mutex_);
  added_.push_back(std::move(decoder));
  return true;
}

SrtpCounts SrtpInput::counts() const { return {received_, refused_, key_changes_}; }

void SrtpInput::Reset() {
  streams_.clear();
  for (const auto& decoder : decoders_) decoder->Reset();
}

GstFlowReturn SrtpInput::OnDatagram(GstBuffer* datagram) {
  UpdateKeys();
  ++received_;
  const std::uint32_t ssrc = SsrcOf(datagram);
  for (std::size_t i = 0; i < decoders_.size(); ++i) {
    // The key that the last packet had comes first; the others fail once for each packet.
    const std::size_t n = (in_use_ + i) % decoders_.size();
    GstFlowReturn flow = GST_FLOW_OK;
    if (decoders_[n]->Decode(datagram, &flow)) {
      OnPassed(ssrc, n);
      return flow;
    }
    if (flow == GST_FLOW_FLUSHING) return flow;
  }
  OnRefused(ssrc);
  return GST_FLOW_OK;
}

void SrtpInput::UpdateKeys() {
  std::size_t drop = 0;
  {
    std::lock_guard lock(mutex_);
    for (auto& decoder : added_) decoders_.push_back(std::move(decoder));
    added_.clear();
  }
  if (decoders_.size() > kMaxKeys) drop = decoders_.size() - kMaxKeys;
  if (forget_old_at_ != 0 && g_get_monotonic_time() > forget_old_at_) {
    drop = std::max(drop, newest_used_);
    forget_old_at_ = 0;
  }
  decoders_.erase(decoders_.begin(), decoders_.begin() + static_cast<std::ptrdiff_t>(drop));
  in_use_ -= std::min(in_use_, drop);
  newest_used_ -= std::min(newest_used_, drop);
}

SrtpInput::Stream& SrtpInput::StreamOf(std::uint32_t ssrc) {
  const auto forget = [this](unsigned failures) {
    for (auto it = streams_.begin(); it != streams_.end();)
      it = it->second.known || it->second.failures > failures ? std::next(it) : streams_.erase(it);
  };
  // Garbage must not fill the memory with streams that do not exist, nor hide one that does.
  if (streams_.size() >= kMaxStreams) forget(1);
  if (streams_.size() >= kMaxStreams) forget(UINT_MAX);
  if (streams_.size() >= kMaxStreams) streams_.clear();
  return streams_[ssrc];
}

void SrtpInput::OnPassed(std::uint32_t ssrc, std::size_t decoder) {
  in_use_ = decoder;
  Stream& stream = StreamOf(ssrc);
  stream.known = true;
  stream.failures = 0;
  if (decoder <= newest_used_) return;
  newest_used_ = decoder;
  forget_old_at_ = g_get_monotonic_time() + kStragglersUs;
  ++key_changes_;
  on_new_key_(decoders_[decoder]->key());
}

/// RTP does not carry its rollover counter. A stream that nobody knows is tried with the next one
/// for each of its packets; one that is known begins at 0 with a new key, as its sender does.
void SrtpInput::OnRefused(std::uint32_t ssrc) {
  ++refused_;
  Stream& stream = StreamOf(ssrc);
  ++stream.failures;
  const bool warn = !warned_ && !stream.known && refused_ >= kFailuresUntilWarning;
  const bool lost = stream.known && stream.failures >= kFailuresUntilLost;
  if (!stream.known || lost) {
    stream.rollover = lost ? 0 : (stream.rollover + 1) % kMaxRollover;
    stream.known = false;
    for (const auto& decoder : decoders_) decoder->Restart(ssrc, stream.rollover);
  }
  if (!warn) return;
  warned_ = true;
  GST_ELEMENT_WARNING(bin_, STREAM, DECRYPT,
                      ("Packets arrive that do not fit the SRTP key, and are dropped."),
                      ("check that both ends have the same srtp-key, srtp-cipher and srtp-auth; "
                       "this is said once, the property stats counts them"));
}

}  // namespace lidar::gst
