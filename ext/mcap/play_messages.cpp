// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/play_messages.h"

#include <set>

#include "gst/common/refs.h"

namespace lidar::gst {
namespace {

std::string TopicNames(const mcap::Playback& playback) {
  std::string names;
  for (const auto& topic : playback.topics())
    names += (names.empty() ? "" : ", ") + topic.channel.topic + " (" + topic.schema.name + ")";
  return names.empty() ? "none" : names;
}

/// Returns the media types of the pads, without duplicates.
std::string MediaTypes(GstElement* element) {
  std::set<std::string> types;
  gst_element_foreach_src_pad(
      element,
      [](GstElement*, GstPad* pad, gpointer to) -> gboolean {
        const CapsPtr caps(gst_pad_get_current_caps(pad));
        if (caps)
          static_cast<std::set<std::string>*>(to)->insert(
              gst_structure_get_name(gst_caps_get_structure(caps.get(), 0)));
        return TRUE;
      },
      &types);
  std::string text;
  for (const std::string& type : types) text += (text.empty() ? "" : ", ") + type;
  return text;
}

}  // namespace

void PostNothingToPlay(GstElement* element, const mcap::Playback& playback,
                       const std::string& location, const std::string& topic) {
  GST_ELEMENT_ERROR(element, STREAM, WRONG_TYPE,
                    ("\"%s\" has no topic that can be played.", location.c_str()),
                    ("wanted topic: %s; topics of the recording: %s",
                     topic.empty() ? "any" : topic.c_str(), TopicNames(playback).c_str()));
}

void WarnOfUnclosed(GstElement* element, guint64 files) {
  GST_ELEMENT_WARNING(
      element, STREAM, DEMUX,
      ("%" G_GUINT64_FORMAT " files of the recording were not closed, or are still being written. "
       "They are played up to their last whole chunk.",
       files),
      (nullptr));
}

void WarnOfUnreadable(GstElement* element, guint64 files, const std::string& why) {
  GST_ELEMENT_WARNING(element, RESOURCE, READ,
                      ("%" G_GUINT64_FORMAT " files of the recording cannot be read.", files),
                      ("the last one: %s", why.c_str()));
}

void PostDamage(GstElement* element, const PlayedCounts& counts) {
  const bool nothing = counts.messages == counts.messages_dropped;
  const bool damaged = counts.chunks_damaged > 0 || counts.messages_dropped > 0;
  if (!counts.has_pads || (nothing && damaged))
    GST_ELEMENT_ERROR(element, STREAM, DEMUX, ("No message of the recording can be read."),
                      ("damaged: %" G_GUINT64_FORMAT " chunks, %" G_GUINT64_FORMAT " messages",
                       counts.chunks_damaged, counts.messages_dropped));
  else if (damaged)
    GST_ELEMENT_WARNING(element, STREAM, DEMUX,
                        ("The recording is damaged: %" G_GUINT64_FORMAT
                         " chunks and %" G_GUINT64_FORMAT " messages are left out.",
                         counts.chunks_damaged, counts.messages_dropped),
                        (nullptr));
}

void PostNotTaken(GstElement* element) {
  GST_ELEMENT_ERROR(element, STREAM, WRONG_TYPE,
                    ("The next element does not accept any stream of the recording: %s.",
                     MediaTypes(element).c_str()),
                    (nullptr));
}

}  // namespace lidar::gst
