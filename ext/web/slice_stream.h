// SPDX-License-Identifier: LGPL-2.1-or-later
// Offers a stream of coded slices to clients. If a client needs decoded slices, a thread of the
// stream decodes them.
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
    std::string topic;     // of the decoded clouds; the topic of the slices adds kSlicesEnding
    std::string frame_id;  // frame of both channels
    std::string recording = {};  // location of mcapsink's files of the stream; empty: none
    UpstreamArchive::Ask ask_upstream = {};  // used if there is no recording; null: no history
    guint max_points = 0;                    // per decoded message; 0: no limit
  };
  struct Counters {
    std::atomic<guint64>& points;     // decoded points sent to clients
    std::atomic<guint64>& malformed;  // slices that cannot be decoded
  };
  /// Opens both channels. Returns nothing and sets `why` if the slices cannot be decoded, or if
  /// another stream uses a topic. `server` and the `counters` must outlive the stream.
  static std::unique_ptr<SliceStream> Open(Server* server, const GstCaps* caps, Settings settings,
                                           Counters counters, std::string* why);
  /// Closes the channels.
  ~SliceStream();
  SliceStream(const SliceStream&) = delete;
  SliceStream& operator=(const SliceStream&) = delete;

  /// Publishes a slice. Called in the streaming thread. Returns false if no decoder accepts the
  /// slice.
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
  /// Returns true if the thread must decode, because a client needs decoded slices or the backlog
  /// is full. The caller holds the lock.
  bool IsWanted();

  Server* const server_;
  const Settings settings_;
  const Counters counters_;
  SharedTopic slices_;
  SharedTopic clouds_;
  bool has_ranges_ = false;
  std::unique_ptr<Decoding> decoding_;  // used only by the thread

  std::mutex mutex_;  // guards the members below
  std::condition_variable change_;
  viewer::Backlog backlog_;
  gint64 recoded_wanted_us_ = 0;  // last time at which recoded slices were wanted
  bool recodes_ = false;          // recoded slices were wanted recently
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace lidar::web
