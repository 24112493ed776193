// SPDX-License-Identifier: LGPL-2.1-or-later
// Assembles lidar packets into slices of points, each as soon as its columns are complete.
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

/// An azimuth sector of a scan, beam by beam. Columns that are outside the sensor's window or were
/// lost are missing returns, so the width is always the same.
struct Slice {
  std::uint32_t scan_id = 0;  // counts scans, across restarts of the sensor
  std::uint32_t index = 0;
  std::uint32_t count = 0;
  std::uint32_t first_column = 0;
  std::uint32_t width = 0;
  std::uint64_t start = 0;  // ns of the sensor's clock, of the first column
  Time first_arrival{};     // of its first packet
  std::uint32_t missing_columns = 0;
  bool after_gap = false;  // a slice before this one is missing, or the sensor restarted
  std::vector<std::uint8_t> points;
};

struct BatcherStats {
  std::uint64_t packets = 0;
  std::uint64_t lost_packets = 0;  // packets that never came
  std::uint64_t late_packets = 0;  // came after their slice was given out
  std::uint64_t duplicate_packets = 0;
  std::uint64_t stray_packets = 0;  // of a distant scan; enough of them count as a restart
  std::uint64_t restarts = 0;
  std::uint64_t slices = 0;
  std::uint64_t incomplete_slices = 0;
};

/// Handles loss, reordering, duplicates and restarts: a slice is given out when it is complete, or
/// after `reorder_packets` packets of later slices.
class ScanBatcher {
 public:
  struct Options {
    std::uint32_t slices_per_scan = 1;  // divides the columns
    std::uint32_t reorder_packets = 4;
  };

  ScanBatcher(const Metadata& metadata, PointWriter writer, const Options& options);

  void Push(const LidarPacket& packet, Time arrival = {});
  /// The next slice that is ready.
  std::optional<Slice> Pop();
  /// Gives out every slice that has begun. The next packet may belong to any scan.
  void Flush();

  const BatcherStats& stats() const { return stats_; }
  std::uint32_t slice_width() const { return width_; }
  std::uint32_t slices_per_scan() const { return slices_; }

 private:
  using Key = std::int64_t;  // scan number x slices per scan + slice index

  struct OpenSlice {
    Key key = 0;
    std::uint32_t seen = 0;     // columns of the window that came
    std::uint32_t packets = 0;  // packets of this slice
    std::uint32_t later_packets = 0;
    bool timed = false;  // a valid column has set slice.start
    std::vector<bool> columns;
    Slice slice;
  };

  struct ColumnTime {
    std::int64_t column = 0;  // counted across scans
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
  std::vector<std::uint32_t> expected_;  // columns of the window in each slice

  std::deque<OpenSlice> open_;  // in order of key
  std::deque<Slice> ready_;
  std::optional<ColumnTime> last_valid_;   // the valid column that came last
  std::optional<std::uint32_t> frame_id_;  // of scan_
  std::uint32_t init_id_ = 0;
  std::int64_t scan_ = 0;  // newest so far
  Key next_ = 0;           // the first slice not yet given out
  std::uint32_t strays_in_a_row_ = 0;
  bool gap_ = false;
  // Packets before the first received one or after the last do not count as lost.
  Key joined_key_ = 0;
  std::uint32_t joined_column_ = 0;
  std::int64_t newest_scan_ = 0;
  std::uint32_t newest_column_ = 0;
  bool flushing_ = false;
  std::deque<std::int64_t> lost_;  // first columns of the newest losses, as scan x columns + column
  BatcherStats stats_;
};

}  // namespace lidar::ouster
