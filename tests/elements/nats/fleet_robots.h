// SPDX-License-Identifier: LGPL-2.1-or-later
// Robots of a fleet that send slices, and a list of what each robot has sent.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "gst/common/refs.h"
#include "tests/elements/mcap/recording.h"
#include "tests/elements/nats/fleet_books.h"

namespace lidar::test {

/// Returns the time of the clock that gives the times of sent slices [s].
inline double WallTime() { return static_cast<double>(g_get_real_time()) * 1e-6; }

/// Simulated robots. All of them share one sensor, but each robot codes its slices and sends them
/// over its own connection.
class Robots {
 public:
  Robots(const std::vector<std::string>& names, const std::vector<int>& ports) : names_(names) {
    std::string text =
        "lidartestsrc name=source is-live=true model=os0-32 mode=512x10 slices-per-scan=4 "
        "speed=10 ! tee name=t";
    for (std::size_t i = 0; i < names.size(); ++i)
      text +=
          " t. ! queue ! lidarenc effort=0 max-error=0.1 key-interval=1000000000 ! "
          "rtplidarpay name=pay" +
          std::to_string(i) + " ! screamsink name=net" + std::to_string(i) +
          " host=127.0.0.1 port=" + std::to_string(ports[i]);
    GError* raw = nullptr;
    pipeline_.reset(gst_parse_launch(text.c_str(), &raw));
    const gst::ErrorPtr error(raw);
    EXPECT_FALSE(error) << error->message;
    sent_.resize(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const gst::ElementPtr pay(ElementOf("pay", i));
      const gst::PadPtr pad(gst_element_get_static_pad(pay.get(), "sink"));
      gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_BUFFER, OnSlice, &sent_[i], nullptr);
    }
  }
  ~Robots() { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }
  void Play() { gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING); }
  /// Stops the sensor. The robots send no goodbyes.
  void Hold() {
    const gst::ElementPtr source(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "source"));
    const gst::PadPtr pad(gst_element_get_static_pad(source.get(), "src"));
    gst_pad_add_probe(
        pad.get(), GST_PAD_PROBE_TYPE_BUFFER,
        [](GstPad*, GstPadProbeInfo*, gpointer) { return GST_PAD_PROBE_DROP; }, nullptr, nullptr);
  }

  const std::vector<std::string>& names() const { return names_; }
  /// Returns the slices that `robot` sent. May be called only after Hold().
  const std::vector<SentSlice>& SentBy(std::size_t robot) const { return sent_[robot].slices; }
  const std::map<guint, GstClockTime>& ScansOf(std::size_t robot) const {
    return sent_[robot].scans;
  }
  /// Returns a text with the losses that the robots' SCReAM senders counted.
  std::string SenderLosses() const {
    guint64 dropped = 0;
    guint64 lost = 0;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const gst::ElementPtr net(ElementOf("net", i));
      dropped += StatOf(net.get(), "packets-dropped");
      lost += StatOf(net.get(), "packets-lost");
    }
    return "the robots' SCReAM dropped " + std::to_string(dropped) + " packets and counted " +
           std::to_string(lost) + " as lost";
  }

 private:
  struct Account {
    std::vector<SentSlice> slices;        // the streaming thread writes it until Hold()
    std::map<guint, GstClockTime> scans;  // by scan number: the capture time of the first slice
  };

  gst::ElementPtr ElementOf(const char* kind, std::size_t robot) const {
    return gst::ElementPtr(
        gst_bin_get_by_name(GST_BIN(pipeline_.get()), (kind + std::to_string(robot)).c_str()));
  }
  static GstPadProbeReturn OnSlice(GstPad*, GstPadProbeInfo* info, gpointer data) {
    auto* account = static_cast<Account*>(data);
    const Kept kept = Keep(GST_PAD_PROBE_INFO_BUFFER(info));
    account->slices.push_back({kept.slice.scan_id, kept.slice.slice_index, WallTime(),
                               std::hash<std::string>()(kept.bytes)});
    account->scans.try_emplace(kept.slice.scan_id, kept.capture_time);
    return GST_PAD_PROBE_OK;
  }

  const std::vector<std::string> names_;
  gst::ElementPtr pipeline_;
  std::vector<Account> sent_;
};

}  // namespace lidar::test
