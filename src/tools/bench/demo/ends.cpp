// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/ends.h"

#include <cmath>
#include <initializer_list>
#include <memory>
#include <vector>

#include "gst/common/structure_json.h"
#include "gst/lidar/gstlidar.h"
#include "src/tools/bench/demo/media_process.h"

namespace lidar::demo {
namespace {

constexpr guint kStatsMs = 50;

std::uint64_t CountReturns(const Cloud& cloud) {
  std::uint64_t returns = 0;
  for (std::size_t i = 0; i + 2 < cloud.xyz.size(); i += 3)
    returns += std::abs(cloud.xyz[i]) + std::abs(cloud.xyz[i + 1]) + std::abs(cloud.xyz[i + 2]) > 0;
  return returns;
}

nlohmann::json Record(const char* type, GstBuffer* buffer) {
  GstLidarSlice slice{};
  gst_lidar_buffer_get_slice(buffer, &slice);
  return {{"type", type},
          {"scan", slice.scan_id},
          {"slice", slice.slice_index},
          {"count", slice.slice_count},
          {"unix_ns", UnixNow()}};
}

/// The time at which a buffer entered an element. The element sends its next output in the same
/// thread, so no lock is needed.
struct Stopwatch {
  std::int64_t entered = 0;
};

void WatchSource(MediaProcess* process) {
  process->OnBuffer("source", "src", [process](GstPad* pad, GstBuffer* buffer) {
    auto record = Record("captured", buffer);
    const GstClockTime duration =
        GST_BUFFER_DURATION_IS_VALID(buffer) ? GST_BUFFER_DURATION(buffer) : GstClockTime{0};
    record["due_ns"] = process->UnixTimeOf(pad, GST_BUFFER_PTS(buffer) + duration);
    if (const auto cloud = ReadCloud(pad, buffer)) {
      record["returns"] = CountReturns(*cloud);
      process->Write(*cloud);
    }
    process->Write(record);
  });
}

void WatchCodec(MediaProcess* process, const char* element, const char* type) {
  auto watch = std::make_shared<Stopwatch>();
  process->OnBuffer(element, "sink", [watch](GstPad*, GstBuffer*) { watch->entered = UnixNow(); });
  process->OnBuffer(element, "src", [process, watch, type](GstPad* pad, GstBuffer* buffer) {
    auto record = Record(type, buffer);
    record["took_ns"] = UnixNow() - watch->entered;
    record["bytes"] = gst_buffer_get_size(buffer);
    if (const auto cloud = ReadCloud(pad, buffer)) process->Write(*cloud);
    process->Write(record);
  });
}

void ReportStats(MediaProcess* process, std::initializer_list<const char*> names) {
  process->Every(kStatsMs, [process, list = std::vector<const char*>(names)] {
    nlohmann::json record{{"type", "stats"}, {"unix_ns", UnixNow()}};
    for (const char* name : list)
      record[name] = gst::StatsAsJson(process->Find(name).get(), gst::FieldNames::kAsTheyAre);
    process->Write(record);
  });
}

}  // namespace

int Send(const std::string& description) {
  MediaProcess process(description);
  WatchSource(&process);
  WatchCodec(&process, "encoder", "encoded");
  process.OnEvent("encoder", "src", [&process](GstEvent* event) {
    GstLidarBitrateBounds bounds{};
    if (!gst_lidar_event_parse_bitrate_bounds(event, &bounds)) return;
    process.Write(nlohmann::json{{"type", "bounds"},
                                 {"min", bounds.min_bitrate},
                                 {"max", bounds.max_bitrate},
                                 {"nominal", bounds.nominal_bitrate},
                                 {"unix_ns", UnixNow()}});
  });
  ReportStats(&process, {"encoder", "sender"});
  return process.Run();
}

int Receive(const std::string& description) {
  MediaProcess process(description);
  WatchCodec(&process, "decoder", "decoded");
  if (process.Find("odometry"))
    process.OnBuffer("odometry", "src", [&process](GstPad*, GstBuffer* buffer) {
      process.Write(Record("posed", buffer));
    });
  ReportStats(&process, {"receiver", "depayloader", "decoder", "odometry"});
  return process.Run();
}

}  // namespace lidar::demo
