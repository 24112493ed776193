// SPDX-License-Identifier: LGPL-2.1-or-later
// Assembles lidar packets into slices of points. A slice is ready as soon as its columns are
// complete.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "src/base/time.h"
#include "src/ouster/lidar_packet.h"
#include "src/ouster/metadata.h"
#include "src/ouster/point_writer.h"

namespace lidar::ouster {

/// An azimuth sector of a scan, row by row; a row has the points of one beam. All slices have the
/// same width: columns that were lost, or that are outside the sensor's window, have missing
/// returns.
struct Slice {
  std::uint32_t scan_id = 0;  // number of the scan; it increases even if the sensor restarts
  std::uint32_t index = 0;
  std::uint32_t count = 0;
  std::uint32_t first_column = 0;
  std::uint32_t width = 0;
  std::uint64_t start = 0;  // time of the first column by the sensor's clock [ns]
  Time first_arrival{};     // arrival of the slice's first packet
  std::uint32_t missing_columns = 0;
  bool after_gap = false;  // a slice before this slice is missing, or the sensor restarted
  std::vector<std::uint8_t> points;
};

struct BatcherStats {
  std::uint64_t packets = 0;
  std::uint64_t lost_packets = 0;  // packets that never arrived
  std::uint64_t late_packets = 0;  // packets that arrived after their slice was given out
  std::uint64_t duplicate_packets = 0;
  std::uint64_t stray_packets = 0;  // packets of a distant scan; several in a row cause a restart
  std::uint64_t restarts = 0;
  std::uint64_t slices = 0;
  std::uint64_t incomplete_slices = 0;
};

/// Handles lost, reordered and duplicate packets, and restarts of the sensor. A slice is given out
/// when it is complete, or after `reorder_packets` packets of later slices have arrived.
class ScanBatcher {
 public:
  struct Options {
    std::uint32_t slices_per_scan = 1;  // a divisor of the number of columns
    std::uint32_t reorder_packets = 4;
  };

  ScanBatcher(const Metadata& metadata, PointWriter writer, const Options& options);

  void Push(const LidarPacket& packet, Time arrival = {});
  /// Returns the next slice that is ready, or nothing.
  std::optional<Slice> Pop();
  /// Gives out every slice that has begun. The next packet may belong to any scan.
  void Flush();

  const BatcherStats& stats() const { return stats_; }
  std::uint32_t slice_width() const { return width_; }
  std::uint32_t slices_per_scan() const { return slices_; }

 private:
  using Key = std::int64_t;  // scan number x slices per scan + index of the slice

  struct OpenSlice {
    Key key = 0;
    std::uint32_t seen = 0;     // number of columns in the sensor's window that arrived
    std::uint32_t packets = 0;  // number of packets with columns of this slice
    std::uint32_t later_packets = 0;
    bool timed = false;  // true once a valid column has set slice.start
    std::vector<bool> columns;
    Slice slice;
  };

  struct ColumnTime {
    std::int64_t column = 0;  // scan number x columns per scan + column
    std::uint64_t time = 0;
    Time arrival{};
  };

  std::int64_t Locate(const PacketHeader& header);
  bool Admit(const LidarPacket& packet, std::int64_t* scan);
  void Restart(const LidarPacket& packet);
  void AddColumns(const LidarPacket& packet, std::int64_t scan, Time arrival);
  bool AddColumn(const PacketColumn& column, OpenSlice* open);
  OpenSlice& Open(Key key, Time arrival);
  Slice NewSlice(Key key) const;
  void CountLaterPacket(Key key);
  Key NextExpected() const;
  bool IsReady(const OpenSlice& open) const;
  void GiveOutReady();
  void GiveOut(OpenSlice open);
  void GiveOutBlanks(Key first, Key last, ColumnTime reference);
  std::uint64_t StartOf(Key key, const ColumnTime& reference) const;
  void CountLost(Key key, const std::vector<bool>* columns);
  void CountTooLate(std::int64_t scan, std::uint32_t column);
  bool InWindow(std::uint32_t column) const;
  bool LeadsPacket(std::uint32_t column) const;

  PointWriter writer_;
  ColumnWindow window_;
  std::uint32_t columns_per_scan_;
  std::uint32_t columns_per_packet_;
  std::uint32_t beams_;
  std::uint64_t frame_id_modulus_;
  std::uint32_t slices_;
  std::uint32_t width_;
  std::uint32_t reorder_packets_;
  double column_period_;                 // time from one column to the next [ns]
  std::vector<std::uint32_t> expected_;  // number of columns in the sensor's window, for each slice

  std::deque<OpenSlice> open_;  // sorted by key
  std::deque<Slice> ready_;
  std::optional<ColumnTime> last_valid_;   // the valid column that arrived last
  std::optional<std::uint32_t> frame_id_;  // frame id of the scan scan_
  std::uint32_t init_id_ = 0;
  std::int64_t scan_ = 0;  // number of the newest scan so far
  Key next_ = 0;           // the first slice that has not been given out yet
  std::uint32_t strays_in_a_row_ = 0;
  bool gap_ = false;
  // The positions of the first packet since the last restart, and of the newest packet. Packets
  // before the first packet, or after the newest packet, do not count as lost.
  Key joined_key_ = 0;
  std::uint32_t joined_column_ = 0;
  std::int64_t newest_scan_ = 0;
  std::uint32_t newest_column_ = 0;
  bool flushing_ = false;
  // First columns of the newest lost packets: scan number x columns per scan + column.
  std::deque<std::int64_t> lost_;
  BatcherStats stats_;
};

}  // namespace lidar::ouster
