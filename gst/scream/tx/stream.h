// SPDX-License-Identifier: LGPL-2.1-or-later
// The state of a sink pad of screamtx: its queue, and measurements of its stream.
#pragma once
#include <gst/gst.h>

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "gst/scream/rtp_packet.h"
#include "gst/scream/tx/figures.h"
#include "gst/scream/tx/gstscreamtxpad.h"
#include "gst/scream/tx/receipts.h"
#include "src/base/target_notifier.h"
#include "src/scream/controller.h"

namespace lidar::gst {

/// A packet, or an event at its place among the packets.
struct TxItem {
  BufferPtr buffer;
  EventPtr event;
  RtpHeader header;
  DataSize size;  // on the wire
  Time queued{};
};

/// Measures the media payload's share of the bytes on the wire. The remainder is RTP, UDP and IP
/// headers, retransmission and FEC.
class OverheadMeter {
 public:
  void Add(gsize payload, DataSize wire) {
    payload_ = payload_ * kShareMemoryPerPacket + static_cast<double>(payload);
    wire_ = wire_ * kShareMemoryPerPacket + static_cast<double>(wire.bytes());
  }
  double payload_share() const { return payload_ / wire_; }

 private:
  static constexpr double kShareMemoryPerPacket = 1 - 1.0 / 128;
  // Starts with the share of packets of 1200 bytes.
  double payload_ = 1188;
  double wire_ = 1228;
};

/// A flush restarts the running time, but without a preroll the base time stays. Entry times are
/// shifted until a preroll gives the pipeline a new base time. A pause only moves the base time.
struct EntryShift {
  bool due = false;    // measure the shift with the next buffer
  bool moved = false;  // take the base time of the next buffer
  GstClockTime base_time = GST_CLOCK_TIME_NONE;
  GstClockTime shift = 0;
};

struct TxStream {
  GstPad* pad = nullptr;
  scream::StreamId id = -1;
  std::deque<TxItem> queue;
  OverheadMeter overhead;
  TargetNotifier notifier;
  std::optional<GstLidarBitrateBounds> bounds;
  std::optional<guint32> ssrc;         // from the caps, or of the first media packet
  std::optional<guint8> payload_type;  // from the caps, or of the first media packet
  scream::StreamConfig config;         // as given to the controller
  double configured_share = 1;         // payload share in `config`
  GstSegment segment{};                // of the packets that come in
  GstSegment leaving_segment{};        // of the packets that leave
  GstClockID entry_wait = nullptr;     // not owned
  EntryShift entry_shift;
  std::optional<bool> live;  // unknown before the first buffer
  bool has_caps = false;
  bool is_video = false;
  bool wants_receipts = false;  // its payloader uses receipts
  bool eos = false;
  bool flushing = false;
  bool flushes_src = false;  // its flush went downstream
  // Work for the reporter's thread:
  bool target_due = false;
  bool key_unit_due = false;
  std::optional<Time> last_key_unit;
  guint key_units = 0;
  guint64 lost_seen = 0;
  PacketReceipts receipts;
  StreamCounters counters;

  /// Age of the oldest packet in the queue.
  Duration HeadAge(Time now) const;
};

using TxStreams = std::vector<std::unique_ptr<TxStream>>;

/// Present time on the system's clock, as the controller takes it.
Time TimeOf(GstClock* clock);
/// Returns the controller's configuration from the pad's settings, else the element's. The
/// encoder's bounds, with overhead added, limit max_bitrate and set needed_bitrate.
scream::StreamConfig MakeConfig(const TxStream& stream, const TxPadSettings& pad,
                                const TxSettings& element);
/// Converts `wire` to the encoder's bitrate [bit/s].
guint ToEncoder(const TxStream& stream, DataRate wire);

}  // namespace lidar::gst
