// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/scan_batcher.h"

#include <algorithm>
#include <utility>

#include "src/ouster/clock_mapper.h"

namespace lidar::ouster {
namespace {

// The frame id of a single packet may be damaged, and must not discard a scan. So a packet that is
// further ahead than kMaxScansAhead, or more than one scan behind, is a stray. Only if
// kStraysForRestart strays arrive in a row does the batcher restart with their scan.
constexpr std::int64_t kMaxScansAhead = 8;
constexpr std::uint32_t kStraysForRestart = 4;
constexpr std::size_t kRememberedLosses = 256;

}  // namespace

ScanBatcher::ScanBatcher(const Metadata& metadata, PointWriter writer, const Options& options)
    : writer_(std::move(writer)),
      window_(metadata.window),
      columns_per_scan_(metadata.model.columns_per_scan),
      columns_per_packet_(metadata.format.columns_per_packet),
      beams_(metadata.format.beams),
      frame_id_modulus_(metadata.format.frame_id_modulus()),
      slices_(SlicesDividing(columns_per_scan_, options.slices_per_scan)),
      width_(columns_per_scan_ / slices_),
      reorder_packets_(options.reorder_packets),
      column_period_(1e9 / metadata.scans_per_second / columns_per_scan_),
      expected_(slices_, 0) {
  for (std::uint32_t m = 0; m < columns_per_scan_; ++m)
    if (InWindow(m)) ++expected_[m / width_];
}

bool ScanBatcher::InWindow(std::uint32_t column) const {
  return (column + columns_per_scan_ - window_.first) % columns_per_scan_ < window_.count;
}

bool ScanBatcher::LeadsPacket(std::uint32_t column) const {
  return column % columns_per_packet_ == 0 || column == window_.first;
}

/// Returns the number of scans by which the packet is ahead of the newest scan; negative if the
/// packet belongs to an earlier scan.
std::int64_t ScanBatcher::Locate(const PacketHeader& header) {
  const auto modulus = static_cast<std::int64_t>(frame_id_modulus_);
  std::int64_t distance = (std::int64_t{header.frame_id} - *frame_id_) % modulus;
  if (distance >= modulus / 2) distance -= modulus;
  if (distance < -modulus / 2) distance += modulus;
  return distance;
}

void ScanBatcher::Restart(const LidarPacket& packet) {
  const bool first = !frame_id_ && stats_.packets == 0;
  if (!first) {
    if (frame_id_) ++stats_.restarts;
    Flush();
    scan_ = next_ == 0 ? 0 : (next_ - 1) / slices_ + 1;
    gap_ = true;
  }
  frame_id_ = packet.header().frame_id;
  init_id_ = packet.header().init_id;
  strays_in_a_row_ = 0;
  joined_column_ = columns_per_scan_;
  for (std::uint32_t i = 0; i < packet.columns(); ++i)
    joined_column_ = std::min(joined_column_, packet.Column(i).measurement_id);
  joined_key_ = scan_ * slices_ + std::min(joined_column_, columns_per_scan_ - 1) / width_;
  next_ = scan_ * slices_;
  newest_scan_ = scan_;
  newest_column_ = 0;
}

bool ScanBatcher::Admit(const LidarPacket& packet, std::int64_t* scan) {
  if (!frame_id_ || packet.header().init_id != init_id_) Restart(packet);
  std::int64_t distance = Locate(packet.header());
  const bool stray = distance > kMaxScansAhead || distance < -1;
  if (stray) {
    ++stats_.stray_packets;
    if (++strays_in_a_row_ < kStraysForRestart) return false;
    Restart(packet);
    distance = 0;
  }
  strays_in_a_row_ = 0;
  if (distance > 0) {
    scan_ += distance;
    frame_id_ = packet.header().frame_id;
  }
  *scan = scan_ + std::min<std::int64_t>(distance, 0);
  return true;
}

void ScanBatcher::Push(const LidarPacket& packet, Time arrival) {
  std::int64_t scan = 0;
  const bool admitted = Admit(packet, &scan);
  ++stats_.packets;
  if (!admitted) return;
  AddColumns(packet, scan, arrival);
  GiveOutReady();
}

void ScanBatcher::AddColumns(const LidarPacket& packet, std::int64_t scan, Time arrival) {
  bool duplicate = false;
  Key newest = -1;
  for (std::uint32_t i = 0; i < packet.columns(); ++i) {
    const PacketColumn column = packet.Column(i);
    if (column.measurement_id >= columns_per_scan_) continue;
    if (column.valid())
      last_valid_ = {scan * columns_per_scan_ + column.measurement_id, column.timestamp, arrival};
    if (!InWindow(column.measurement_id)) continue;
    const Key key = scan * slices_ + column.measurement_id / width_;
    if (key < next_) {
      if (LeadsPacket(column.measurement_id)) CountTooLate(scan, column.measurement_id);
      continue;
    }
    OpenSlice& open = Open(key, arrival);
    if (key != newest) ++open.packets;
    newest = std::max(newest, key);
    duplicate = !AddColumn(column, &open) || duplicate;
    if (scan > newest_scan_) newest_column_ = 0;
    newest_scan_ = std::max(newest_scan_, scan);
    if (scan == newest_scan_) newest_column_ = std::max(newest_column_, column.measurement_id);
  }
  stats_.duplicate_packets += duplicate ? 1 : 0;
  if (newest >= 0 && !duplicate) CountLaterPacket(newest);
}

bool ScanBatcher::AddColumn(const PacketColumn& column, OpenSlice* open) {
  Slice& slice = open->slice;
  const std::uint32_t i = column.measurement_id - slice.first_column;
  if (open->columns[i]) return false;
  open->columns[i] = true;
  ++open->seen;
  if (!column.valid()) return true;
  if (i == 0 || !open->timed) {
    const auto sweep = static_cast<std::uint64_t>(column_period_ * static_cast<double>(i));
    slice.start = column.timestamp - std::min(column.timestamp, sweep);
  }
  open->timed = true;
  writer_.WriteColumn(column, {slice.points.data(), width_, slice.first_column, slice.start});
  return true;
}

ScanBatcher::OpenSlice& ScanBatcher::Open(Key key, Time arrival) {
  const auto at = std::lower_bound(open_.begin(), open_.end(), key,
                                   [](const OpenSlice& o, Key k) { return o.key < k; });
  if (at != open_.end() && at->key == key) return *at;
  OpenSlice open;
  open.key = key;
  open.columns.resize(width_);
  open.slice = NewSlice(key);
  open.slice.first_arrival = arrival;
  return *open_.insert(at, std::move(open));
}

Slice ScanBatcher::NewSlice(Key key) const {
  Slice slice;
  slice.scan_id = static_cast<std::uint32_t>(key / slices_);
  slice.index = static_cast<std::uint32_t>(key % slices_);
  slice.count = slices_;
  slice.first_column = slice.index * width_;
  slice.width = width_;
  slice.points.resize(std::size_t{width_} * beams_ * writer_.point_step());
  writer_.FillMissing(&slice.points);
  return slice;
}

void ScanBatcher::CountLaterPacket(Key key) {
  for (OpenSlice& open : open_)
    if (open.key < key) ++open.later_packets;
}

/// Returns the first slice that is not given out yet and that has columns in the sensor's window.
ScanBatcher::Key ScanBatcher::NextExpected() const {
  Key key = std::max(next_, joined_key_);
  while (expected_[static_cast<std::size_t>(key % slices_)] == 0) ++key;
  return key;
}

bool ScanBatcher::IsReady(const OpenSlice& open) const {
  if (open.later_packets >= reorder_packets_) return true;
  if (open.seen < expected_[static_cast<std::size_t>(open.key % slices_)]) return false;
  // Packets of an earlier slice may still be on their way, even if no packet of that slice has
  // arrived yet.
  return open.key <= NextExpected() || open.packets >= reorder_packets_;
}

void ScanBatcher::GiveOutReady() {
  while (!open_.empty() && IsReady(open_.front())) {
    OpenSlice open = std::move(open_.front());
    open_.pop_front();
    GiveOut(std::move(open));
  }
}

void ScanBatcher::GiveOut(OpenSlice open) {
  const Key key = open.key;
  const Key scan_start = key / slices_ * slices_;
  for (Key k = next_; k < key; ++k) {
    CountLost(k, nullptr);
    gap_ = gap_ || (k >= joined_key_ && expected_[static_cast<std::size_t>(k % slices_)] > 0);
  }
  if (!open.timed && last_valid_) open.slice.start = StartOf(key, *last_valid_);
  const ColumnTime reference{key * width_, open.slice.start, open.slice.first_arrival};
  GiveOutBlanks(std::max(next_, scan_start), key, reference);
  const auto index = static_cast<std::size_t>(key % slices_);
  open.slice.missing_columns = expected_[index] - open.seen;
  if (open.slice.missing_columns > 0) {
    CountLost(key, &open.columns);
    ++stats_.incomplete_slices;
  }
  open.slice.after_gap = std::exchange(gap_, false);
  ready_.push_back(std::move(open.slice));
  ++stats_.slices;
  next_ = key + 1;
  const bool last_of_scan = std::all_of(expected_.begin() + static_cast<std::ptrdiff_t>(index) + 1,
                                        expected_.end(), [](std::uint32_t n) { return n == 0; });
  if (last_of_scan) {
    GiveOutBlanks(next_, scan_start + slices_, reference);
    next_ = scan_start + slices_;
  }
}

/// Gives out blank slices for all slices in [first, last) that are outside the sensor's window.
void ScanBatcher::GiveOutBlanks(Key first, Key last, ColumnTime reference) {
  for (Key key = first; key < last; ++key) {
    const auto index = static_cast<std::uint32_t>(key % slices_);
    if (expected_[index] > 0) continue;
    Slice slice = NewSlice(key);
    slice.start = StartOf(key, reference);
    slice.first_arrival = reference.arrival;
    ready_.push_back(std::move(slice));
    ++stats_.slices;
  }
}

/// Returns the time of the slice's first column, extrapolated from the time of `reference`.
std::uint64_t ScanBatcher::StartOf(Key key, const ColumnTime& reference) const {
  const auto columns = static_cast<double>(key * width_ - reference.column);
  const auto shift = static_cast<std::int64_t>(columns * column_period_);
  return static_cast<std::uint64_t>(
      std::max<std::int64_t>(0, SinceSensorEpoch(reference.time).count() + shift));
}

/// Counts the lost packets whose first column is in the slice. If no column of the slice arrived,
/// `columns` is null.
void ScanBatcher::CountLost(Key key, const std::vector<bool>* columns) {
  const std::int64_t scan = key / slices_;
  const auto first = static_cast<std::uint32_t>(key % slices_) * width_;
  for (std::uint32_t i = 0; i < width_; ++i) {
    const std::uint32_t m = first + i;
    const bool not_yet_joined =
        scan == joined_key_ / slices_ && (key < joined_key_ || m < joined_column_);
    const bool not_yet_sent = flushing_ && scan == newest_scan_ && m > newest_column_;
    if ((columns != nullptr && (*columns)[i]) || not_yet_joined || not_yet_sent) continue;
    if (!InWindow(m) || !LeadsPacket(m)) continue;
    ++stats_.lost_packets;
    lost_.push_back(scan * columns_per_scan_ + m);
    if (lost_.size() > kRememberedLosses) lost_.pop_front();
  }
}

/// Counts a packet that arrived after its slice was given out. The packet is either one that was
/// counted as lost, or a duplicate.
void ScanBatcher::CountTooLate(std::int64_t scan, std::uint32_t column) {
  const auto found = std::find(lost_.begin(), lost_.end(), scan * columns_per_scan_ + column);
  if (found == lost_.end()) {
    ++stats_.duplicate_packets;
    return;
  }
  lost_.erase(found);
  --stats_.lost_packets;
  ++stats_.late_packets;
}

std::optional<Slice> ScanBatcher::Pop() {
  if (ready_.empty()) return std::nullopt;
  Slice slice = std::move(ready_.front());
  ready_.pop_front();
  return slice;
}

void ScanBatcher::Flush() {
  flushing_ = true;
  while (!open_.empty()) {
    OpenSlice open = std::move(open_.front());
    open_.pop_front();
    GiveOut(std::move(open));
  }
  flushing_ = false;
  frame_id_.reset();
}

}  // namespace lidar::ouster
