// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bond/bond_shared.h"

#include <gst/video/video.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gst/scream/rtp_packet.h"

namespace lidar::gst {

using bonding::PacketId;
using bonding::Scheduler;

namespace {

constexpr DataSize kHeaders = DataSize::Bytes(28);  // UDP and IP
// A new target is sent to the encoder only if it differs from the last one by at least this
// fraction.
constexpr double kWorthTelling = 0.02;
// Requests for key units that follow each other within this time count as one request. They come
// from several links, because a single link waits longer between its requests.
constexpr Duration kKeyUnitInterval = std::chrono::milliseconds(400);

constexpr std::size_t kMaxMisdirected = 64;  // reports that wait for the next tick

class BondLink : public TxLink {
 public:
  BondLink(std::shared_ptr<BondShared> bond, std::size_t index)
      : bond_(std::move(bond)), index_(index) {}

  bool Wants(Time now, guint32 ssrc, guint16 seq) override {
    const std::lock_guard lock(bond_->mutex);
    return bond_->scheduler.Wants(now, index_, {ssrc, seq});
  }
  guint16 OnSent(Time now, guint32 ssrc, guint16 seq) override {
    const std::lock_guard lock(bond_->mutex);
    return bond_->scheduler.OnSent(now, index_, {ssrc, seq});
  }
  bool OnDropped(Time now, guint32 ssrc, guint16 seq) override {
    const std::lock_guard lock(bond_->mutex);
    return bond_->scheduler.OnDropped(now, index_, {ssrc, seq});
  }
  std::optional<rtcp::CongestionFeedback> OnFeedback(
      Time now, const rtcp::CongestionFeedback& report) override {
    const std::lock_guard lock(bond_->mutex);
    auto own = bond_->scheduler.OnFeedback(now, index_, report);
    if (own || bond_->misdirected.size() >= kMaxMisdirected) return own;
    // This thread holds the lock of its own screamtx, and the screamtx that owns the report has
    // another lock. The bond's thread, which holds neither, passes the report on.
    if (const auto owner = bond_->scheduler.OwnerOf(report))
      bond_->misdirected.push_back({*owner, report});
    return own;
  }
  gsize trailer() const override { return bond_->srtp ? bond_->srtp->overhead() : 0; }
  void OnPath(const scream::Statistics& s) override {
    const std::lock_guard lock(bond_->mutex);
    const bool known = s.s_rtt > Duration{0};
    bond_->scheduler.OnPath(index_, {known ? s.ref_wnd / s.s_rtt : DataRate{}, s.s_rtt, s.min_rtt});
  }

 private:
  std::shared_ptr<BondShared> bond_;
  std::size_t index_;
};

}  // namespace

std::shared_ptr<TxLink> NewBondLink(std::shared_ptr<BondShared> bond, std::size_t index) {
  return std::make_shared<BondLink>(std::move(bond), index);
}

void BondShared::KeepLocked(Time now, PacketId id, GstBuffer* buffer, BondStream* stream) {
  while (!order_.empty() && (now - order_.front().first > Scheduler::kMaxAge ||
                             order_.size() >= Scheduler::kMaxPackets)) {
    kept_.erase(order_.front().second);
    order_.pop_front();
  }
  const bool fresh =
      kept_.insert_or_assign(id.key(), Kept{BufferPtr(gst_buffer_ref(buffer)), stream}).second;
  if (fresh) order_.emplace_back(now, id.key());
}

bonding::LinkSet BondShared::Schedule(GstBuffer* buffer, BondStream* stream) {
  const auto header = ReadRtpHeader(buffer);
  if (!header) return 1;  // a buffer that is not RTP is sent over the first link
  const Time now = Now();
  const PacketId id{header->ssrc, header->seq};
  const auto size = static_cast<std::int64_t>(gst_buffer_get_size(buffer));
  const std::lock_guard lock(mutex);
  KeepLocked(now, id, buffer, stream);
  const std::uint32_t slice = header->timestamp ^ header->ssrc;
  return scheduler.OnPacket(now, {id, DataSize::Bytes(size) + kHeaders, slice, header->marker});
}

EventPtr BondShared::DueTargetLocked(BondStream& stream) {
  std::vector<DataRate> rates;
  DataRate most;
  for (const GstLidarTargetBitrate& t : stream.targets) {
    rates.push_back(DataRate::BitsPerSecond(t.bitrate));
    most = std::max(most, DataRate::BitsPerSecond(t.max_bitrate));
  }
  const double bps = std::min(scheduler.Target(Now(), rates), most).bits_per_second();
  if (bps <= 0 ||
      std::abs(bps / std::max(1.0, static_cast<double>(stream.told)) - 1) < kWorthTelling)
    return nullptr;
  stream.told = static_cast<guint>(bps);
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < rates.size(); ++i)
    if (std::abs(rates[i].bits_per_second() - bps) <
        std::abs(rates[nearest].bits_per_second() - bps))
      nearest = i;
  GstLidarTargetBitrate target = stream.targets[nearest];
  target.bitrate = stream.told;
  target.reason = stream.reasons[nearest].c_str();
  return EventPtr(gst_lidar_event_new_target_bitrate(&target));
}

EventPtr BondShared::Combine(BondStream& stream, GstPad* src, const GstLidarTargetBitrate& target) {
  const std::lock_guard lock(mutex);
  for (std::size_t i = 0; i < stream.srcs.size(); ++i) {
    if (stream.srcs[i] != src) continue;
    stream.reasons[i] = target.reason != nullptr ? target.reason : "update";
    stream.targets[i] = target;
  }
  return DueTargetLocked(stream);
}

bool BondShared::IsRepeatedRequest(BondStream& stream, GstEvent* event) {
  if (!gst_video_event_is_force_key_unit(event)) return false;
  const Time now = Now();
  const std::lock_guard lock(mutex);
  if (stream.key_unit_at && now - *stream.key_unit_at < kKeyUnitInterval) return true;
  stream.key_unit_at = now;
  return false;
}

BondWork BondShared::TakeWorkLocked(const std::vector<std::unique_ptr<BondStream>>& streams) {
  BondWork work;
  work.reports.swap(misdirected);
  for (const Scheduler::Copy& copy : scheduler.TakeCopies(Now())) {
    const auto kept = kept_.find(copy.id.key());
    if (kept == kept_.end()) continue;
    work.copies.emplace_back(PadPtr(GST_PAD(gst_object_ref(kept->second.stream->srcs[copy.link]))),
                             BufferPtr(gst_buffer_ref(kept->second.buffer.get())));
  }
  for (const auto& stream : streams)
    if (stream->told != 0)
      if (EventPtr due = DueTargetLocked(*stream))
        work.targets.emplace_back(PadPtr(GST_PAD(gst_object_ref(stream->sink.get()))),
                                  std::move(due));
  return work;
}

void BondShared::ForgetPacketsLocked(const BondStream* stream) {
  std::set<std::uint32_t> ssrcs;
  for (auto it = kept_.begin(); it != kept_.end();) {
    const bool gone = it->second.stream == stream;
    if (gone) ssrcs.insert(static_cast<std::uint32_t>(it->first >> 16));
    it = gone ? kept_.erase(it) : std::next(it);
  }
  for (const std::uint32_t ssrc : ssrcs) scheduler.Abandon(ssrc);
}

void BondShared::Clear(const std::vector<std::unique_ptr<BondStream>>& streams) {
  const std::lock_guard lock(mutex);
  kept_.clear();
  order_.clear();
  misdirected.clear();
  scheduler.Restart();
  for (const auto& stream : streams) {
    stream->told = 0;
    stream->key_unit_at.reset();
    std::fill(stream->targets.begin(), stream->targets.end(), GstLidarTargetBitrate{});
  }
}

}  // namespace lidar::gst
