// SPDX-License-Identifier: LGPL-2.1-or-later
// Records streams into MCAP files.
#pragma once
#include <gst/gst.h>

#include <map>
#include <string>

#include "ext/mcap/buffer_writer.h"
#include "src/base/scalar_caps.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_MCAP_SINK (gst_lidar_mcap_sink_get_type())
G_DECLARE_FINAL_TYPE(GstLidarMcapSink, gst_lidar_mcap_sink, GST, LIDAR_MCAP_SINK, GstBin)
GST_ELEMENT_REGISTER_DECLARE(mcapsink)
G_END_DECLS

namespace lidar::gst {

/// The channels of a stream: the channel for the next messages, and all channels by their caps.
struct RecordedStream {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::map<std::string, std::uint16_t> channels;  // by the caps of each channel
};

/// The functions below are called by the streams of the sink, in the streams' threads. Errors are
/// posted on the sink.
bool McapSinkAddChannel(GstLidarMcapSink* sink, const BufferWriter& writer,
                        const std::string& topic, const ScalarCaps& caps, RecordedStream* stream);
/// `running_time` may be GST_CLOCK_TIME_NONE.
GstFlowReturn McapSinkTake(GstLidarMcapSink* sink, BufferWriter* writer, RecordedStream* stream,
                           GstBuffer* buffer, GstClockTime running_time);
/// Notes the end of a stream. If all streams have ended, completes the recording.
void McapSinkStreamEnded(GstLidarMcapSink* sink);
/// Must be called when running times restart.
void McapSinkFlushed(GstLidarMcapSink* sink);
/// Returns a topic that no other stream has: `wanted`, or `wanted` and a number.
std::string McapSinkFreeTopic(GstLidarMcapSink* sink, const std::string& wanted);

}  // namespace lidar::gst
