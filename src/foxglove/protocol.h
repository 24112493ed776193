// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes a server's messages of Foxglove's WebSocket protocol, and parses the messages of clients.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/foxglove/schemas.h"

namespace lidar::foxglove {

/// The protocol of https://docs.foxglove.dev/docs/sdk/websocket-server, and its predecessor. The
/// server handles both in the same way.
inline constexpr std::array<const char*, 2> kSubprotocols = {"foxglove.sdk.v1",
                                                             "foxglove.websocket.v1"};

struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  Schema schema = Schema::kPointCloud;
  std::string stream = {};  // only for kSlice: the result of DescribeSlices()
};

/// The description of a stream of slices, which viewers get before the first slice.
struct SliceStreamInfo {
  bool has_ranges = false;  // false: slices have points in no order
  std::string fields;       // fields of the decoded points
  int framerate_n = 0;      // scans/s; 0/1: not known
  int framerate_d = 1;
  std::vector<std::uint8_t> sensor_model;  // see docs/wire-format.md; empty without ranges
  std::string frame_id;
  std::string clouds;      // topic of the decoded stream
  bool recording = false;  // viewers may replay the stream
};
std::string DescribeSlices(const SliceStreamInfo& stream);

std::string ServerInfo(const std::string& name, const std::string& session_id);
std::string Advertise(const std::vector<Channel>& channels);
std::string Unadvertise(const std::vector<std::uint32_t>& channel_ids);
/// Returns a message that describes what is wrong with a client's request.
std::string ErrorStatus(const std::string& text);

/// The state of a recording and of a viewer's replay. Times are in [ns since 1970].
struct RecordingStatus {
  std::uint32_t subscription = 0;
  std::uint16_t number = 0;   // number of the replay; 0: the viewer is live
  std::uint64_t from_ns = 0;  // from_ns and to_ns are 0 if nothing can be read
  std::uint64_t to_ns = 0;
  std::uint64_t damaged = 0;            // number of parts that the replay skipped
  std::optional<std::uint64_t> end_ns;  // time of the last slice, if no more slices follow
};
std::string Describe(const RecordingStatus& status);

struct Subscription {
  std::uint32_t id = 0;  // chosen by the client
  std::uint32_t channel_id = 0;
};

/// The number of a scan, and the index of a slice in it.
struct SliceName {
  std::uint32_t scan = 0;
  std::uint32_t index = 0;
};

/// A client's request.
struct Request {
  enum class Kind {
    kMalformed,    // `error` says why
    kUnsupported,  // an operation that the server does not offer
    kSubscribe,
    kUnsubscribe,
    kDrawn,           // the viewer has drawn `slice` and all slices before it
    kLacksReference,  // the viewer's decoder lacks a slice to which others refer
    kReplay,          // begins a replay of the recording at `time_ns`
    kLive,            // ends the replay
  };
  Kind kind = Kind::kMalformed;
  std::vector<Subscription> subscriptions;
  std::vector<std::uint32_t> unsubscribed;  // subscription ids
  std::uint32_t subscription = 0;           // id of the subscription that the request is about
  SliceName slice;
  std::uint16_t number = 0;  // number of a replay; never 0
  std::uint64_t time_ns = 0;
  std::string error;
};
/// Parses a client's message. `text` may be any bytes.
Request ParseRequest(std::string_view text);

/// The bytes before the payload of a message: opcode, subscription id and time [ns since 1970].
using MessageHead = std::array<std::uint8_t, 13>;
MessageHead HeadOf(std::uint32_t subscription_id, std::uint64_t unix_ns);

/// The fields of SliceHead. In a message, SliceHead is between MessageHead and the slice or pose.
struct SliceInfo {
  SliceName name;
  std::uint32_t count = 1;  // number of slices in the scan
  std::uint32_t first_column = 0;
  bool is_recoded = false;
  std::uint16_t replay = 0;  // number of the replay; 0: live
  bool is_pose = false;      // the payload is a foxglove.FrameTransform of a replay
};
using SliceHead = std::array<std::uint8_t, 24>;
SliceHead HeadOfSlice(const SliceInfo& slice, std::uint64_t sent_unix_ns);

}  // namespace lidar::foxglove
