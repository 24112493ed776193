// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages of mcapsrc about recordings that it cannot play, or not whole.
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

/// Error: no topic of the recording can be played, or not the one that is wanted.
void PostNothingToPlay(GstElement* element, const mcap::Playback& playback,
                       const std::string& location, const std::string& topic);
/// Warns of files that break off or cannot be read; `why` belongs to the last one.
void WarnOfFiles(GstElement* element, const mcap::Playback& playback, const std::string& why);
/// Error where nothing could be read, a warning where parts are left out, else nothing.
void PostDamage(GstElement* element, const PlayedCounts& counts);
/// Posts an error: downstream takes the caps of no pad.
void PostNotTaken(GstElement* element);

}  // namespace lidar::gst
