// SPDX-License-Identifier: LGPL-2.1-or-later
// A sender of audio over several links, and its receiver.
#pragma once
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "tests/elements/scream/pipeline.h"
#include "tests/elements/scream/rtp_support.h"

namespace lidar::test {

inline const std::string kBondedAudio =
    "audiotestsrc name=src num-buffers=150 samplesperbuffer=441 is-live=true ! "
    "audio/x-raw,rate=44100,channels=1,format=S16BE ! rtpL16pay ! ";

/// Of the screamsrc `in`.
inline std::string BoundPort(Pipeline& pipeline) {
  GSocket* socket = nullptr;
  g_object_get(pipeline.Get("in").get(), "used-socket", &socket, nullptr);
  GSocketAddress* address = g_socket_get_local_address(socket, nullptr);
  const auto port = g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(address));
  g_object_unref(address);
  g_object_unref(socket);
  return std::to_string(port);
}

/// A screamsrc of raw audio on a free port, and what comes out of it.
struct BondReceiver {
  explicit BondReceiver(const std::string& options = "")
      : pipeline("screamsrc name=in port=0 " + options +
                 " caps=\"application/x-rtp,media=audio,encoding-name=L16,"
                 "clock-rate=44100,channels=1,payload=96\" ! fakesink name=out sync=false "
                 "signal-handoffs=true") {
    const ElementPtr out = pipeline.Get("out");
    g_signal_connect(
        out.get(), "handoff",
        G_CALLBACK(+[](GstElement*, GstBuffer*, GstPad*, std::atomic<guint>* n) { ++*n; }),
        &passed);
    pipeline.Play();
    port = BoundPort(pipeline);
  }
  std::atomic<guint> passed{0};
  Pipeline pipeline;
  std::string port;
};

inline std::string Bonded(const std::string& addresses, const std::string& more = "") {
  return kBondedAudio + "screamsink name=out bonding-addresses=\"" + addresses + "\" " + more;
}

/// Of each element of the array `links` in `stats`.
inline std::vector<guint64> OfLinks(GstElement* element, const char* field) {
  GstStructure* raw = nullptr;
  g_object_get(element, "stats", &raw, nullptr);
  const gst::StructurePtr stats(raw);
  std::vector<guint64> values;
  const GValue* links = gst_structure_get_value(stats.get(), "links");
  for (guint i = 0; links != nullptr && i < gst_value_array_get_size(links); ++i) {
    guint64 value = 0;
    const GValue* link = gst_value_array_get_value(links, i);
    EXPECT_TRUE(gst_structure_get_uint64(gst_value_get_structure(link), field, &value)) << field;
    values.push_back(value);
  }
  return values;
}

}  // namespace lidar::test
