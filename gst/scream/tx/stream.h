// SPDX-License-Identifier: LGPL-2.1-or-later
// The state of a sink pad of screamtx: its queue and the measurements of its stream.
#pragma once
#include <gst/gst.h>

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "gst/scream/rtp_packet.h"
#include "gst/scream/tx/gstscreamtxpad.h"
#include "gst/scream/tx/receipts.h"
#include "src/scream/controller.h"
#include "src/scream/target_notifier.h"

namespace lidar::gst {

/// A packet, or an event that keeps its place among the packets.
struct TxItem {
  BufferPtr buffer;
  EventPtr event;
  RtpHeader header;
  DataSize size;  // on the wire
  Time queued{};
};

/// Measures the share of the media's payload in the bytes on the wire, which also carry RTP, UDP
/// and IP headers, retransmission and FEC.
class OverheadMeter {
 public:
  void Add(gsize payload, DataSize wire) {
    payload_ = payload_ * kShareMemoryPerPacket + static_cast<double>(payload);
    wire_ = wire_ * kShareMemoryPerPacket + static_cast<double>(wire.bytes());
  }
  double payload_share() const { return payload_ / wire_; }

 private:
  static constexpr double kShareMemoryPerPacket = 1 - 1.0 / 128;  // packets
  // Starts as packets of 1200 bytes are.
  double payload_ = 1188;
  double wire_ = 1228;
};

struct StreamCounters {
  guint64 packets_queued = 0;
  guint64 frames_dropped = 0;
  guint64 malformed = 0;
};

/// A flush begins the running time anew, but without a preroll the base time stays: the stream then
/// enters so much later, until the pipeline has a new base time.
struct EntryShift {
  bool due = false;  // to be measured with the next buffer
  GstClockTime base_time = GST_CLOCK_TIME_NONE;
  GstClockTime shift = 0;
};

struct TxStream {
  GstPad* pad = nullptr;
  scream::StreamId id = -1;
  std::deque<TxItem> queue;
  OverheadMeter overhead;
  scream::TargetNotifier notifier;
  std::optional<GstLidarBitrateBounds> bounds;
  std::optional<guint32> ssrc;         // of the media: from caps, or the first seen
  std::optional<guint8> payload_type;  // likewise
  scream::StreamConfig config;         // as the controller has it
  double configured_share = 1;         // payload share that `config` was made with
  GstSegment segment{};                // of the pad, for the entry and for a merged output
  GstClockID entry_wait = nullptr;     // not owned
  EntryShift entry_shift;
  std::optional<bool> live;  // not known before the first buffer
  bool has_caps = false;
  bool is_video = false;
  bool wants_receipts = false;  // its payloader makes use of them
  bool eos = false;
  bool flushing = false;
  // Work for the control thread
  bool target_due = false;
  bool key_unit_due = false;
  std::optional<Time> last_key_unit;
  guint key_units = 0;
  guint64 lost_seen = 0;
  PacketReceipts receipts;
  StreamCounters counters;

  /// Age of the first packet in the queue.
  Duration HeadAge(Time now) const;
};

using TxStreams = std::vector<std::unique_ptr<TxStream>>;

/// The present on the system's clock, as the controller takes it.
Time TimeOf(GstClock* clock);
/// The controller's configuration of a stream: the pad's settings, else the element's, within the
/// encoder's bounds, which are without overhead.
scream::StreamConfig MakeConfig(const TxStream& stream, const TxPadSettings& pad,
                                const TxSettings& element);
/// The encoder's part of `wire` [bit/s].
guint ToEncoder(const TxStream& stream, DataRate wire);

}  // namespace lidar::gst
