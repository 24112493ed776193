// SPDX-License-Identifier: LGPL-2.1-or-later
// Holds sticky events of a pad whose caps come from the data of the first buffer.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "gst/common/refs.h"

namespace lidar::gst {

/// Events leave after the caps, in order of arrival. A new event replaces an older one of its type.
class HeldEvents {
 public:
  /// Holds a sticky event that belongs after the caps. Drops a gap, which has no meaning before
  /// caps. Returns false, and leaves `event` to the caller, for other events.
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

  /// Pushes the caps, then the held events. If downstream refuses the caps, GStreamer sends them
  /// again before the next buffer, and the push of that buffer returns the error.
  void PushCapsTo(GstPad* pad, GstCaps* caps) {
    gst_pad_push_event(pad, gst_event_new_caps(caps));
    PushTo(pad);
  }

  /// Pushes the held events, for example before an EOS without caps. A push may flush the pad and
  /// so call this object again.
  void PushTo(GstPad* pad) {
    for (EventPtr& event : std::exchange(held_, {})) gst_pad_push_event(pad, event.release());
  }

  /// A flush ends the segment. Tags and other events stay, because they come only once.
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
