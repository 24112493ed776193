// SPDX-License-Identifier: LGPL-2.1-or-later
// Holds back sticky events on a pad whose caps are not known before the first buffer.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "gst/common/refs.h"

namespace lidar::gst {

/// A queue of events that are pushed after the caps, in the order of their arrival. A new event
/// replaces an earlier event of the same type.
class HeldEvents {
 public:
  /// Takes a sticky event that must be pushed after the caps. Also takes a GAP event and drops it,
  /// because it has no meaning before the caps. For any other event returns false, and the caller
  /// keeps the event.
  bool Take(GstEvent* event) {
    const GstEventType type = GST_EVENT_TYPE(event);
    const bool waits = GST_EVENT_IS_SERIALIZED(event) && GST_EVENT_IS_STICKY(event) &&
                       type > GST_EVENT_CAPS && type != GST_EVENT_EOS;
    if (waits) {
      const GstStructure* what = gst_event_get_structure(event);
      Drop([&](GstEvent* held) {
        return GST_EVENT_TYPE(held) == type &&
               (what == nullptr || gst_event_has_name(held, gst_structure_get_name(what)));
      });
      held_.emplace_back(event);
    } else if (type == GST_EVENT_GAP) {
      gst_event_unref(event);
    }
    return waits || type == GST_EVENT_GAP;
  }

  /// Pushes the caps and then the held events. If downstream refuses the caps, GStreamer sends them
  /// again before the next buffer, and pushing that buffer returns the error.
  void PushCapsTo(GstPad* pad, GstCaps* caps) {
    gst_pad_push_event(pad, gst_event_new_caps(caps));
    PushTo(pad);
  }

  /// Pushes the held events, for example before an EOS if no caps were sent. The push may call this
  /// object again, because it may flush the pad.
  void PushTo(GstPad* pad) {
    for (EventPtr& event : std::exchange(held_, {})) gst_pad_push_event(pad, event.release());
  }

  /// Drops a held segment, because a flush ends it. Keeps tags and all other events, because they
  /// are sent only once.
  void OnFlush() {
    Drop([](GstEvent* held) { return GST_EVENT_TYPE(held) == GST_EVENT_SEGMENT; });
  }

  void Clear() { held_.clear(); }

 private:
  template <class Predicate>
  void Drop(Predicate goes) {
    held_.erase(std::remove_if(held_.begin(), held_.end(),
                               [&](const EventPtr& held) { return goes(held.get()); }),
                held_.end());
  }

  std::vector<EventPtr> held_;
};

}  // namespace lidar::gst
