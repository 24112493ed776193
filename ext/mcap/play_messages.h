// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages of mcapsrc about recordings that it cannot play, or only in part.
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

/// Posts an error: no topic of the recording can be played, or the wanted one cannot.
void PostNothingToPlay(GstElement* element, const mcap::Playback& playback,
                       const std::string& location, const std::string& topic);
/// Warns of files that break off.
void WarnOfUnclosed(GstElement* element, guint64 files);
/// Warns of files that cannot be read; `why` is the reason for the last one.
void WarnOfUnreadable(GstElement* element, guint64 files, const std::string& why);
/// Posts an error if nothing could be read, and a warning if parts are left out.
void PostDamage(GstElement* element, const PlayedCounts& counts);
/// Posts an error: the caps of no pad are accepted downstream.
void PostNotTaken(GstElement* element);

}  // namespace lidar::gst
