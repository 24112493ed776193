// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/twcc/session_numbers.h"

#include <gst/rtp/gstrtpbuffer.h>

#include <cstdio>
#include <vector>

namespace lidar::gst {
namespace {

constexpr const char* kEvent = "RTPTWCCPackets";
constexpr guint kMaxId = 14;  // greatest id of extensions with one-byte headers

/// Returns the URI in an extmap field. The field is a string with the URI, or an array of
/// direction, URI and attributes.
const gchar* UriOf(const GValue* field) {
  if (field == nullptr) return nullptr;
  if (G_VALUE_HOLDS_STRING(field)) return g_value_get_string(field);
  if (!GST_VALUE_HOLDS_ARRAY(field) || gst_value_array_get_size(field) < 2) return nullptr;
  const GValue* uri = gst_value_array_get_value(field, 1);
  return G_VALUE_HOLDS_STRING(uri) ? g_value_get_string(uri) : nullptr;
}

/// A packet that an event of rtpsession reports. `arrival` is unset if the packet is lost or has no
/// time.
struct Reported {
  guint number = 0;
  std::optional<Duration> arrival;
};
std::optional<Reported> Read(const GstStructure* s) {
  Reported r;
  guint64 remote = 0;
  gboolean lost = TRUE;
  if (!gst_structure_get_uint(s, "seqnum", &r.number)) return std::nullopt;
  if (!gst_structure_get_boolean(s, "lost", &lost)) return std::nullopt;
  if (!lost && gst_structure_get_uint64(s, "remote-ts", &remote) &&
      GST_CLOCK_TIME_IS_VALID(remote)) {
    // A later time is invalid: the reference time of a report is below one period, and the sum of
    // its deltas is below another period.
    if (remote > static_cast<guint64>((2 * rtcp::kTwccPeriod).count())) return std::nullopt;
    r.arrival = Duration{static_cast<std::int64_t>(remote)};
  }
  return r;
}

/// Returns the packets of a report, or none if `event` is not a report. If the report is too long,
/// returns kMaxTwccPackets + 1 packets.
std::vector<const GstStructure*> PacketsOf(GstEvent* event) {
  std::vector<const GstStructure*> packets;
  const GstStructure* s = gst_event_get_structure(event);
  if (s == nullptr || !gst_structure_has_name(s, kEvent)) return packets;
  const GValue* list = gst_structure_get_value(s, "packets");
  // Finds the type by its name, because GLib deprecates GValueArray, which rtpsession uses.
  if (list == nullptr || !G_VALUE_HOLDS(list, g_type_from_name("GValueArray"))) return packets;
  const auto* array = static_cast<const GValueArray*>(g_value_get_boxed(list));
  for (guint i = 0; array != nullptr && i < array->n_values; ++i)
    if (packets.size() <= rtcp::kMaxTwccPackets && GST_VALUE_HOLDS_STRUCTURE(&array->values[i]))
      packets.push_back(gst_value_get_structure(&array->values[i]));
  return packets;
}

}  // namespace

void SessionNumbers::OnCaps(const GstCaps* caps) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  id_ = 0;
  for (guint id = 1; id <= kMaxId; ++id) {
    char name[16];
    std::snprintf(name, sizeof name, "extmap-%u", id);
    if (g_strcmp0(UriOf(gst_structure_get_value(s, name)), rtcp::kTwccUri) == 0)
      id_ = static_cast<guint8>(id);
  }
}

void SessionNumbers::OnPacket(GstBuffer* buffer) {
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  if (id_ == 0 || !gst_rtp_buffer_map(buffer, GST_MAP_READ, &rtp)) return;
  gpointer data = nullptr;
  guint size = 0;
  if (gst_rtp_buffer_get_extension_onebyte_header(&rtp, id_, 0, &data, &size)) {
    mapper_.OnSent(next_++, gst_rtp_buffer_get_ssrc(&rtp), gst_rtp_buffer_get_seq(&rtp));
    sizes_.push_back(gst_rtp_buffer_get_payload_len(&rtp));
    if (sizes_.size() > rtcp::kMaxTwccPackets) sizes_.pop_front();
  }
  gst_rtp_buffer_unmap(&rtp);
}

/// Returns false if the reported packet has another size than the packet that passed here under the
/// same number. It is then a different packet.
bool SessionNumbers::IsOurs(const GstStructure* packet) const {
  guint number = 0;
  guint size = 0;
  if (!gst_structure_get_uint(packet, "seqnum", &number)) return false;
  if (!gst_structure_get_uint(packet, "size", &size) || size == 0) return true;
  const auto back = static_cast<std::uint16_t>(next_ - number);
  return back == 0 || back > sizes_.size() || sizes_[sizes_.size() - back] == size;
}

std::optional<rtcp::CongestionFeedback> SessionNumbers::OnEvent(GstEvent* event) {
  const auto packets = PacketsOf(event);
  if (packets.empty()) return std::nullopt;
  ++stats_.reports;
  std::size_t ours = 0;
  std::optional<std::uint16_t> first;
  rtcp::TwccFeedback feedback;
  for (const GstStructure* packet : packets) {
    const auto reported = Read(packet);
    if (!reported) continue;
    const auto number = static_cast<std::uint16_t>(reported->number);
    if (!first) first = number;
    const auto index = static_cast<std::uint16_t>(number - *first);
    if (index >= rtcp::kMaxTwccPackets) continue;
    if (feedback.arrivals.size() <= index) feedback.arrivals.resize(std::size_t{index} + 1);
    feedback.arrivals[index] = reported->arrival;
    ours += IsOurs(packet);
  }
  if (!first) return std::nullopt;
  if (ours < packets.size()) {
    ++stats_.mismatched;
    return std::nullopt;
  }
  stats_.packets += packets.size();
  feedback.base_number = *first;
  return mapper_.Map(feedback);
}

}  // namespace lidar::gst
