// SPDX-License-Identifier: LGPL-2.1-or-later
// The files that mcapsink has written, or still writes.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "ext/web/archive.h"
#include "ext/web/slice_caps.h"
#include "src/mcap/playback.h"

namespace lidar::web {

/// Only the element's user names the files, no viewer can.
class FileArchive final : public Archive {
 public:
  /// `location` is that of mcapsink; `caps` those of the stream.
  FileArchive(std::string location, SliceCaps caps)
      : location_(std::move(location)), caps_(std::move(caps)) {}

  std::optional<Times> Look(std::string* why) override;
  void Seek(std::uint64_t time_ns) override;
  void GoOn(std::uint64_t position) override { Seek(position); }
  std::optional<Item> Next() override;
  void Rest() override { Seek(0); }
  std::uint64_t damaged() const override { return damaged_; }

 private:
  std::optional<Item> Read();
  std::shared_ptr<SliceMessage> ReadSlice(const mcap::Message& message) const;
  bool IsOurs(const mcap::Schema& schema, const mcap::Channel& channel);

  const std::string location_;
  const SliceCaps caps_;
  std::unique_ptr<mcap::Playback> playback_;
  std::optional<Item> ahead_;               // the item after the one that Next() returned last
  std::uint64_t damaged_ = 0;               // chunks left out before `ahead_` was read
  std::map<std::string, bool> known_caps_;  // as text; true: of our stream
  std::string topic_;                       // the first one of our stream
};

}  // namespace lidar::web
