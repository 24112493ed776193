// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/file_session.h"

#include <utility>

#include "gst/common/refs.h"

#include "ext/ouster/debug.h"

namespace lidar::gst {

bool FileSession::Open() {
  auto metadata = LoadMetadata();
  if (!metadata || !SetMetadata(*std::move(metadata))) return false;
  std::string why;
  const std::string& path = settings().location;
  pcap_ = PcapFeed::Open(path, stream()->metadata(), settings().loop, &why);
  if (pcap_) {
    timeline_.emplace(path, stream()->metadata().packet_interval());
    return true;
  }
  GST_ELEMENT_ERROR(element(), RESOURCE, OPEN_READ,
                    ("Cannot read the capture %s: %s.", path.c_str(), why.c_str()),
                    ("it must be a pcap or pcapng file, as 'tcpdump -i eth0 -s 0 -w FILE udp' "
                     "writes where the sensor's packets arrive"));
  return false;
}

void FileSession::Unlock() {
  std::lock_guard lock(wait_mutex_);
  flushing_ = true;
  if (timeline_) timeline_->Cancel();
  if (wait_ != nullptr) gst_clock_id_unschedule(wait_);
}

void FileSession::UnlockStop() {
  std::lock_guard lock(wait_mutex_);
  flushing_ = false;
  if (timeline_) timeline_->Allow();
}

std::optional<GstClockTime> FileSession::duration() {
  return seekable() && timeline_ ? timeline_->duration() : std::nullopt;
}

void FileSession::Seek(const GstSegment& segment) {
  Session::Seek(segment);
  if (begun_ || segment.start > 0) target_ = ToTime(segment.start);
}

/// Continues at the beginning of the slice that contains the target of the seek.
GstFlowReturn FileSession::GoToTarget() {
  // The greatest drift of the sensor's clock relative to the clock of the capture.
  constexpr Duration kLead = std::chrono::seconds(1);
  // The reading starts two scans earlier, because the packets of the target's slice may be out of
  // order.
  skip_to_ = *target_ - 2 * stream()->metadata().scan_period();
  const auto place = timeline_->Find(skip_to_->time_since_epoch() - kLead);
  if (!place && timeline_->cancelled()) return GST_FLOW_FLUSHING;
  target_.reset();
  stream()->Reposition();
  if (place && pcap_->Reposition(place->first, place->offset)) return GST_FLOW_OK;
  GST_ELEMENT_ERROR(element(), RESOURCE, SEEK,
                    ("Cannot seek in the capture %s.", settings().location.c_str()), (nullptr));
  return GST_FLOW_ERROR;
}

bool FileSession::IsBeforeTarget(const PcapFeed::Packet& packet) const {
  if (!skip_to_) return false;
  const auto sampled = stream()->SampledAt({packet.payload.data(), packet.payload.size()});
  return sampled.value_or(Time(packet.due)) < *skip_to_;
}

/// Waits until `running_time` on the pipeline's clock. Returns false if Unlock() ends the wait.
bool FileSession::WaitUntil(GstClockTime running_time) {
  const std::unique_ptr<GstClock, Unref> clock(gst_element_get_clock(gst_element()));
  if (!clock) return true;
  const GstClockTime base_time = gst_element_get_base_time(gst_element());
  std::unique_lock lock(wait_mutex_);
  if (flushing_) return false;
  GstClockID id = gst_clock_new_single_shot_id(clock.get(), base_time + running_time);
  wait_ = id;
  lock.unlock();
  const GstClockReturn outcome = gst_clock_id_wait(id, nullptr);
  lock.lock();
  wait_ = nullptr;
  gst_clock_id_unref(id);
  return outcome != GST_CLOCK_UNSCHEDULED;
}

void FileSession::WarnIfCutShort() {
  if (pcap_->error().empty() || cut_reported_) return;
  cut_reported_ = true;
  GST_ELEMENT_WARNING(element(), STREAM, DECODE,
                      ("The capture %s is cut short.", settings().location.c_str()),
                      ("%s", pcap_->error().c_str()));
}

GstFlowReturn FileSession::EndOfCapture() {
  const char* path = settings().location.c_str();
  constexpr const char* kRemedy =
      "set the property metadata to the file that was saved with the capture";
  if (!pcap_->found_lidar_packets()) {
    GST_ELEMENT_ERROR(element(), STREAM, WRONG_TYPE,
                      ("The capture %s does not match the metadata: %s.", path,
                       pcap_->DescribeContents().c_str()),
                      ("%s", kRemedy));
    return GST_FLOW_ERROR;
  }
  if (stream()->batcher().stats().packets == 0) {
    GST_ELEMENT_ERROR(
        element(), STREAM, WRONG_TYPE,
        ("The capture %s has packets of another sensor than the metadata (serial number %s).", path,
         stream()->metadata().serial_text.c_str()),
        ("%s", kRemedy));
    return GST_FLOW_ERROR;
  }
  WarnIfCutShort();
  stream()->Flush();
  End();
  UpdateCounters();
  return GST_FLOW_OK;
}

GstFlowReturn FileSession::Poll() {
  // A seek is performed only after the first packets of the file have set the clock.
  if (target_ && stream()->knows_time()) {
    const GstFlowReturn flow = GoToTarget();
    if (flow != GST_FLOW_OK) return flow;
  }
  const auto packet = pcap_->Next();
  if (!packet) return EndOfCapture();
  begun_ = true;
  if (IsBeforeTarget(*packet)) return GST_FLOW_OK;
  return Take(*packet);
}

GstFlowReturn FileSession::Take(const PcapFeed::Packet& packet) {
  ouster::Arrival arrival{Time(packet.due), packet.captured, packet.sender};
  if (settings().is_live) {
    if (!GST_CLOCK_TIME_IS_VALID(pace_start_)) pace_start_ = RunningTime();
    const auto due = static_cast<GstClockTime>(packet.due.count());
    if (!WaitUntil(pace_start_ + due)) return GST_FLOW_FLUSHING;
    arrival.local = ToTime(pace_start_) + packet.due;
    const Duration offset = utc_offset_;
    arrival.utc = arrival.local + offset;
    stream()->ShiftUtc(offset - std::exchange(taken_utc_offset_, offset));
  }
  if (packet.starts_over) {
    WarnIfCutShort();
    stream()->Restart();
  }
  const ByteView payload{packet.payload.data(), packet.payload.size()};
  if (Push(payload, arrival) != ouster::PacketVerdict::kNewInitId) return GST_FLOW_OK;
  if (!restart_reported_)
    GST_ELEMENT_WARNING(
        element(), STREAM, WRONG_TYPE,
        ("The sensor was restarted or reconfigured between its metadata and its packets."),
        ("points are right as long as its mode and profile are the same"));
  restart_reported_ = true;
  stream()->AcceptNewInitId();
  Push(payload, arrival);
  return GST_FLOW_OK;
}

}  // namespace lidar::gst
