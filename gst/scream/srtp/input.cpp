// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/input.h"

#include <algorithm>

#include "gst/common/monotonic_time.h"
#include "gst/scream/rtp_packet.h"

namespace lidar::gst {
namespace {

// The key in use and two others: the previous and the next key, or the next two keys.
constexpr std::size_t kMaxKeys = 3;
constexpr std::chrono::seconds kStragglers{10};
constexpr std::size_t kMaxStreams = 2'048;
// A stream is lost if this many of its packets fail and none passes for this time. The rollover
// counter may have changed during a long loss. The number is small, because a sender that gets no
// feedback sends few packets.
constexpr unsigned kFailuresUntilLost = 20;
constexpr std::chrono::seconds kSilenceUntilLost{2};
constexpr std::uint32_t kMaxRollover = 100'000;  // reached after months
constexpr unsigned kFailuresUntilWarning = 20;
// Each trial derives keys, which takes about 50 us.
constexpr int kMaxTrials = 500;
constexpr std::chrono::seconds kTrialsPeriod{1};
constexpr unsigned kTriedUntilCleared = 64;
constexpr unsigned kMaxGuesses = 32;  // guesses for one packet, which take about 2 ms for each key

SrtpInput* InputOf(GstPad* pad) {
  return static_cast<SrtpInput*>(gst_pad_get_element_private(pad));
}

}  // namespace

SrtpInput::SrtpInput(GstElement* bin, const SrtpPolicy& policy, OnNewKey on_new_key)
    : bin_(bin),
      policy_(policy),
      on_new_key_(std::move(on_new_key)),
      trials_(kMaxTrials, Duration(kTrialsPeriod) / kMaxTrials) {
  gst_pad_set_chain_function(entry_.get(), [](GstPad* p, GstObject*, GstBuffer* datagram) {
    const BufferPtr owner(datagram);
    return InputOf(p)->OnDatagram(datagram);
  });
  for (GstPad* pad : {entry_.get(), exit_.get()}) gst_pad_set_active(pad, TRUE);
}

/// Creates a pad that passes events and queries to the pad on the other side.
PadPtr SrtpInput::NewPad(const char* name, GstPadDirection direction) {
  PadPtr pad(GST_PAD(gst_object_ref_sink(gst_pad_new(name, direction))));
  gst_pad_set_element_private(pad.get(), this);
  gst_pad_set_event_function(pad.get(), [](GstPad* p, GstObject*, GstEvent* event) -> gboolean {
    SrtpInput* self = InputOf(p);
    if (GST_EVENT_TYPE(event) == GST_EVENT_STREAM_START) self->Reset();
    return gst_pad_push_event(self->Other(p), event);
  });
  gst_pad_set_query_function(pad.get(), [](GstPad* p, GstObject*, GstQuery* query) {
    return gst_pad_peer_query(InputOf(p)->Other(p), query);
  });
  return pad;
}

SrtpInput::~SrtpInput() {
  if (const PadPtr peer{gst_pad_get_peer(entry_.get())}) gst_pad_unlink(peer.get(), entry_.get());
  if (const PadPtr peer{gst_pad_get_peer(exit_.get())}) gst_pad_unlink(exit_.get(), peer.get());
  for (GstPad* pad : {entry_.get(), exit_.get()}) gst_pad_set_active(pad, FALSE);
}

bool SrtpInput::Link(GstPad* socket, GstPad* target) {
  return gst_pad_link(exit_.get(), target) == GST_PAD_LINK_OK &&
         gst_pad_link(socket, entry_.get()) == GST_PAD_LINK_OK;
}

bool SrtpInput::AddKey(const SrtpKey& key) {
  Key added{0, SrtpDecoder::Create(bin_, policy_, key), SrtpDecoder::Create(bin_, policy_, key),
            SrtpDecoder::Create(bin_, policy_, key)};
  if (!added.media || !added.rtcp || !added.trial) return false;
  std::lock_guard lock(mutex_);
  added.serial = ++serial_;
  if (serial_ > 1) ++waiting_;
  added_.push_back(std::move(added));
  return true;
}

SrtpCounts SrtpInput::counts() const {
  const std::uint64_t refused = refused_, copies = copied_;
  return {passed_ + refused + copies, refused, copies, key_changes_};
}

void SrtpInput::Reset() {
  streams_.clear();
  copies_.Clear();
  for (const Key& key : keys_)
    for (SrtpDecoder* decoder : {key.media.get(), key.rtcp.get(), key.trial.get()})
      decoder->Clear();
}

SrtpInput::Head SrtpInput::HeadOf(GstBuffer* datagram) {
  guint8 bytes[12] = {};
  const gsize size = gst_buffer_extract(datagram, 0, bytes, sizeof bytes);
  Head head;
  head.rtcp = IsRtcp(datagram);
  head.sequence = GST_READ_UINT16_BE(bytes + 2);
  const gsize at = head.rtcp ? 4 : 8;
  if (size >= at + 4) head.ssrc = GST_READ_UINT32_BE(bytes + at);
  return head;
}

GstFlowReturn SrtpInput::OnDatagram(GstBuffer* datagram) {
  if (on_dtls_ && IsDtls(datagram)) {
    on_dtls_(datagram);
    return GST_FLOW_OK;
  }
  UpdateKeys();
  const Head head = HeadOf(datagram);
  if (!head.rtcp) copies_.OnArrival(datagram);
  if (BufferPtr copy = head.rtcp ? nullptr : copies_.Take(datagram)) {
    ++copied_;
    return gst_pad_push(exit_.get(), copy.release());
  }
  if (BufferPtr decoded = Decode(datagram, head)) {
    ++passed_;
    if (!head.rtcp) copies_.OnPassed(datagram, decoded.get());
    return gst_pad_push(exit_.get(), decoded.release());
  }
  ++refused_;
  const auto found = streams_.find(head.stream());
  const bool known = found != streams_.end() && found->second.known;
  if (!known && !keys_.empty() && refused_ >= kFailuresUntilWarning) Warn();
  return GST_FLOW_OK;
}

BufferPtr SrtpInput::Decode(GstBuffer* datagram, const Head& head) {
  const auto found = streams_.find(head.stream());
  const bool known = found != streams_.end() && found->second.known;
  if (known) {
    if (BufferPtr decoded = DecodeKnown(datagram, head)) return decoded;
    ++found->second.failures;
  }
  // An RTCP stream is never lost, because each RTCP packet carries its index. A packet that fails
  // is therefore a replay.
  if (!known || (!head.rtcp && IsLost(found->second))) return TryStranger(datagram, head);
  return nullptr;
}

BufferPtr SrtpInput::DecodeKnown(GstBuffer* datagram, const Head& head) {
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    // Tries the key of the last packet first, because each packet would otherwise fail with another
    // key first.
    const std::size_t n = (in_use_ + i) % keys_.size();
    BufferPtr decoded = keys_[n].DecoderOf(head).Decode(datagram);
    if (!decoded) continue;
    OnPassed(head, n, 0);
    return decoded;
  }
  return nullptr;
}

/// Tries to decode a packet of an unknown or lost stream. RTP does not carry the rollover counter,
/// so its value must be guessed. While enough trials are left, many values are tried for one
/// packet, because a sender that gets no feedback sends few packets. Half of the trials are
/// reserved for the first values of other packets.
BufferPtr SrtpInput::TryStranger(GstBuffer* datagram, const Head& head) {
  const Time now = MonotonicTime();
  if (!trials_.Take(now)) return nullptr;
  BufferPtr decoded = TryRollover(datagram, head, 0);
  // RTCP carries its index, so that there is nothing to guess.
  const unsigned guesses = head.rtcp ? 0 : kMaxGuesses;
  for (unsigned n = 0; !decoded && n < guesses && (n == 0 || trials_.Take(now, kMaxTrials / 2));
       ++n)
    decoded = TryRollover(datagram, head, StreamOf(head.stream()).search.Next());
  Stream& stream = StreamOf(head.stream());
  if (!decoded && !stream.known) ++stream.failures;
  return decoded;
}

/// Tries one rollover counter with each key. The counter of a lost stream has grown, so a packet
/// with the old counter or a lower one is a replay. `ahead` is added to the lowest counter that is
/// possible.
BufferPtr SrtpInput::TryRollover(GstBuffer* datagram, const Head& head, std::uint32_t ahead) {
  const Stream& stream = StreamOf(head.stream());
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const std::size_t n = (in_use_ + i) % keys_.size();
    const bool behind = stream.known && keys_[n].serial <= stream.key;
    if (stream.known && keys_[n].serial < stream.key) continue;
    const std::uint32_t rollover = (behind ? stream.rollover + 1 : 0) + ahead;
    if (!Fits(keys_[n], datagram, head.ssrc, rollover)) continue;
    // The trial was successful. The key's own decoder now decodes the packet, too, so that it
    // refuses a replay of the packet later.
    SrtpDecoder& decoder = keys_[n].DecoderOf(head);
    decoder.Restart(head.ssrc, rollover);
    BufferPtr decoded = decoder.Decode(datagram);
    if (decoded) OnPassed(head, n, rollover);
    return decoded;
  }
  return nullptr;
}

bool SrtpInput::Fits(const Key& key, GstBuffer* datagram, std::uint32_t ssrc,
                     std::uint32_t rollover) {
  if (++tried_ >= kTriedUntilCleared) {
    for (const Key& k : keys_) k.trial->Clear();
    tried_ = 0;
  }
  key.trial->Restart(ssrc, rollover);
  return key.trial->Decode(datagram) != nullptr;
}

void SrtpInput::UpdateKeys() {
  {
    std::lock_guard lock(mutex_);
    // The search starts again, because under the new key a stream may have any rollover counter.
    if (!added_.empty())
      for (auto& [id, stream] : streams_) stream.search = {};
    for (Key& key : added_) keys_.push_back(std::move(key));
    added_.clear();
  }
  while (keys_.size() > kMaxKeys) DropKey(newest_used_ > 0 ? 0 : 1);
  if (!forget_old_at_ || MonotonicTime() <= *forget_old_at_) return;
  while (newest_used_ > 0) DropKey(0);
  forget_old_at_.reset();
}

void SrtpInput::DropKey(std::size_t index) {
  keys_.erase(keys_.begin() + static_cast<std::ptrdiff_t>(index));
  if (index > newest_used_) --waiting_;
  if (index < in_use_) --in_use_;
  if (index < newest_used_) --newest_used_;
}

SrtpInput::Stream& SrtpInput::StreamOf(const StreamId& id) {
  if (const auto found = streams_.find(id); found != streams_.end()) return found->second;
  const auto forget = [this](unsigned failures) {
    for (auto it = streams_.begin(); it != streams_.end();)
      it = it->second.known || it->second.failures > failures ? std::next(it) : streams_.erase(it);
  };
  // Forged packets can name any number of streams. These streams must neither fill the memory nor
  // replace a stream from which packets have passed.
  if (streams_.size() >= kMaxStreams) forget(1);
  if (streams_.size() >= kMaxStreams) forget(UINT_MAX);
  if (streams_.size() >= kMaxStreams) streams_.clear();
  return streams_[id];
}

/// Updates the stream of a decoded packet. `rollover` is the counter that a trial has found, else
/// 0.
void SrtpInput::OnPassed(const Head& head, std::size_t key, std::uint32_t rollover) {
  in_use_ = key;
  Stream& stream = StreamOf(head.stream());
  const std::uint64_t serial = keys_[key].serial;
  if (!stream.known || serial > stream.key || rollover > stream.rollover) {
    stream.rollover = rollover;
    stream.sequence = head.sequence;
    stream.key = serial;
  } else if (serial == stream.key && !head.rtcp &&
             static_cast<std::int16_t>(head.sequence - stream.sequence) > 0) {
    if (head.sequence < stream.sequence) ++stream.rollover;
    stream.sequence = head.sequence;
  }
  stream.known = true;
  stream.failures = 0;
  stream.passed_at = MonotonicTime();
  stream.search = {};
  if (key <= newest_used_) return;
  waiting_ -= std::min<std::size_t>(waiting_, key - newest_used_);
  newest_used_ = key;
  forget_old_at_ = MonotonicTime() + kStragglers;
  ++key_changes_;
  on_new_key_(keys_[key].media->key());
}

/// Returns true if no packet of the stream has passed for so long that the rollover counter may
/// have changed. A forger cannot make a stream lost while the stream's own packets pass.
bool SrtpInput::IsLost(const Stream& stream) {
  return stream.failures >= kFailuresUntilLost &&
         MonotonicTime() - stream.passed_at >= kSilenceUntilLost;
}

std::uint32_t SrtpInput::Search::Next() {
  if (left_ == 0) {
    round_ = round_ == kMaxRollover ? 4 : std::min(4 * round_, kMaxRollover);
    left_ = round_;
    at_ = g_random_int() % round_;
  }
  --left_;
  return 1 + at_++ % round_;
}

void SrtpInput::Warn() {
  if (warned_) return;
  warned_ = true;
  GST_ELEMENT_WARNING(bin_, STREAM, DECRYPT,
                      ("Packets that do not match the SRTP key arrive and are dropped."),
                      ("check that both ends have the same srtp-key, srtp-cipher and srtp-auth; "
                       "this warning comes once, the property stats counts the packets"));
}

}  // namespace lidar::gst
