// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the files of mcapsink, which may still be writing them.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "ext/web/archive.h"
#include "ext/web/slice_caps.h"
#include "src/mcap/playback.h"

namespace lidar::web {

/// An archive in files of mcapsink. The user of the element sets their location, and viewers cannot
/// change it.
class FileArchive final : public Archive {
 public:
  /// `location` has the value of mcapsink's property. `caps` are the caps of the stream.
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
  std::optional<Item> ahead_;               // the item after the last item that Next() returned
  std::uint64_t damaged_ = 0;               // number of skipped chunks before `ahead_` was read
  std::map<std::string, bool> known_caps_;  // caps as text; true if they are of the stream
  std::string topic_;                       // the first topic of the stream
};

}  // namespace lidar::web
