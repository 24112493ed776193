// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads earlier slices of the stream from a source upstream that keeps them, such as natssrc with
// JetStream.
#pragma once
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "ext/web/archive.h"
#include "ext/web/slice_caps.h"
#include "gst/common/history_query.h"

namespace lidar::web {

class UpstreamArchive final : public Archive {
 public:
  /// Sends a query upstream. Returns false if no element answers.
  using Ask = std::function<bool(GstQuery*)>;
  /// `frame_id` is the frame of the sensor.
  UpstreamArchive(Ask ask, SliceCaps caps, std::string frame_id)
      : ask_(std::move(ask)), caps_(std::move(caps)), frame_id_(std::move(frame_id)) {}

  /// Returns true if a source upstream can return earlier buffers.
  static bool IsThere(const Ask& ask);

  std::optional<Times> Look(std::string* why) override;
  void Seek(std::uint64_t time_ns) override;
  void GoOn(std::uint64_t position) override;
  std::optional<Item> Next() override;
  std::string error() const override { return error_; }
  void Rest() override { items_.clear(); }
  std::uint64_t damaged() const override { return damaged_; }

 private:
  bool Answers(GstQuery* query, gst::HistoryAnswer* answer) const;
  void Read();
  void Take(GstSample* sample);
  bool IsOurs(GstCaps* caps);

  const Ask ask_;
  const SliceCaps caps_;
  const std::string frame_id_;
  gst::HistoryQuestion question_;
  std::uint64_t from_ns_ = 0;  // time of the last Seek(); 0 after GoOn()
  bool ended_ = true;
  std::string error_;
  std::deque<Item> items_;
  std::uint64_t damaged_ = 0;
  gst::CapsPtr known_caps_;
  bool are_ours_ = false;  // the decoder of the stream accepts slices of known_caps_
};

}  // namespace lidar::web
