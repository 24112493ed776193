// SPDX-License-Identifier: LGPL-2.1-or-later
// Offers a stream of coded slices as it is, and decoded in a thread of its own if a client needs
// that.
#pragma once
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "ext/web/server.h"
#include "ext/web/slice_caps.h"
#include "ext/web/upstream_archive.h"
#include "src/viewer/backlog.h"

namespace lidar::web {

class SliceStream {
 public:
  struct Settings {
    std::string topic;           // of the decoded clouds; the slices' topic adds kSlicesEnding
    std::string frame_id;        // of both channels
    std::string recording = {};  // location of mcapsink's files of the stream; empty: none
    UpstreamArchive::Ask ask_upstream = {};  // used without a recording; null: no history
    guint max_points = 0;                    // of a decoded message; 0: no limit
  };
  struct Counters {
    std::atomic<guint64>& points;     // decoded points sent to clients
    std::atomic<guint64>& malformed;  // slices that cannot be decoded
  };
  /// Opens both channels. Returns nothing and sets `why` if the caps are not those of slices to
  /// decode, or another stream uses a topic. `server` and the `counters` outlive the stream.
  static std::unique_ptr<SliceStream> Open(Server* server, const GstCaps* caps, Settings settings,
                                           Counters counters, std::string* why);
  /// Closes the channels.
  ~SliceStream();
  SliceStream(const SliceStream&) = delete;
  SliceStream& operator=(const SliceStream&) = delete;

  /// Called in the streaming thread. Returns false for a slice that no decoder takes.
  bool Push(SliceMessage slice);

  static constexpr const char* kSlicesEnding = "/slices";

 private:
  class Decoding;

  SliceStream(Server* server, Settings settings, Counters counters);
  bool OpenTopics(SliceCaps caps, std::string* why);
  std::unique_ptr<Archive> MakeArchive(SliceCaps caps) const;
  void Wake();
  void Run();
  void Publish(const SliceMessage& slice, bool recodes);
  /// Returns true if the thread must decode: a client wants decoded slices, or the backlog is full.
  /// The lock is held.
  bool IsWanted();

  Server* const server_;
  const Settings settings_;
  const Counters counters_;
  SharedTopic slices_;
  SharedTopic clouds_;
  bool has_ranges_ = false;
  std::unique_ptr<Decoding> decoding_;  // used by the thread

  std::mutex mutex_;  // guards what follows
  std::condition_variable change_;
  viewer::Backlog backlog_;
  gint64 recoded_wanted_us_ = 0;  // last time that recoded slices were wanted
  bool recodes_ = false;          // recoded slices were wanted recently
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace lidar::web
