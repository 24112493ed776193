// SPDX-License-Identifier: LGPL-2.1-or-later
// Posts messages of mcapsrc about recordings that it cannot play, or can play only in part.
#pragma once
#include <gst/gst.h>

#include <string>

#include "src/mcap/playback.h"

namespace lidar::gst {

struct PlayedCounts {
  guint64 messages;
  guint64 messages_dropped;
  guint64 chunks_damaged;
  bool has_pads;
};

/// Posts an error, because no topic of the recording can be played, or because the wanted topic
/// cannot be played.
void PostNothingToPlay(GstElement* element, const mcap::Playback& playback,
                       const std::string& location, const std::string& topic);
/// Posts a warning about incomplete files.
void WarnOfUnclosed(GstElement* element, guint64 files);
/// Posts a warning about files that cannot be read. `why` is the reason for the last of these
/// files.
void WarnOfUnreadable(GstElement* element, guint64 files, const std::string& why);
/// Posts an error if no message could be read. Posts a warning if parts of the recording were
/// skipped.
void PostDamage(GstElement* element, const PlayedCounts& counts);
/// Posts an error, because downstream does not accept the caps of any pad.
void PostNotTaken(GstElement* element);

}  // namespace lidar::gst
