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

/// An item of a queue: a packet, or an event that is sent between two packets.
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
  // The initial share is that of RTP packets of 1200 bytes.
  double payload_ = 1188;
  double wire_ = 1228;
};

/// The correction of entry times after a flush. A flush restarts the running time, but the pipeline
/// keeps its base time unless it prerolls. Without a correction, all entry times would be in the
/// past. The shift applies until a preroll gives the pipeline a new base time. A pause changes the
/// base time, too, but the shift remains valid.
struct EntryShift {
  bool due = false;    // the next buffer measures the shift
  bool moved = false;  // the next buffer stores the new base time
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
  scream::StreamConfig config;         // as last given to the controller
  double configured_share = 1;         // payload share with which `config` was computed
  GstSegment segment{};                // of the packets that enter the queue
  GstSegment leaving_segment{};        // of the packets that leave the queue
  GstClockID entry_wait = nullptr;     // not owned
  EntryShift entry_shift;
  std::optional<bool> live;  // unknown before the first buffer
  bool has_caps = false;
  bool is_video = false;
  bool wants_receipts = false;  // its payloader uses receipts
  bool eos = false;
  bool flushing = false;
  bool flushes_src = false;  // its FLUSH_START was sent downstream
  // Work for the reporter's thread:
  bool target_due = false;
  bool key_unit_due = false;
  std::optional<Time> last_key_unit;
  guint key_units = 0;
  guint64 lost_seen = 0;
  PacketReceipts receipts;
  StreamCounters counters;

  /// Returns the age of the oldest packet in the queue, or 0 if there is none.
  Duration HeadAge(Time now) const;
};

using TxStreams = std::vector<std::unique_ptr<TxStream>>;

/// Returns the time of `clock` in the type that the controller uses.
Time TimeOf(GstClock* clock);
/// Returns the controller's configuration of `stream`. A bitrate that is 0 in `pad` is taken from
/// `element`. The encoder's bounds, increased by the overhead of the headers, limit max_bitrate and
/// set needed_bitrate.
scream::StreamConfig MakeConfig(const TxStream& stream, const TxPadSettings& pad,
                                const TxSettings& element);
/// Converts `wire`, which includes all headers, to the encoder's bitrate [bit/s].
guint ToEncoder(const TxStream& stream, DataRate wire);

}  // namespace lidar::gst
