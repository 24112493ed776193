// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that send coded scans over several links, with each coder.
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/lidar/gstlidar.h"
#include "tests/elements/scream/bonded_ends.h"

namespace lidar::test {
namespace {

struct Coding {
  const char* name;
  const char* encoder;
  const char* decoder;
  int slices_per_scan;
};

std::string NameOf(const ::testing::TestParamInfo<Coding>& info) { return info.param.name; }

/// Records the coded slices that pass an identity element: the scan, index, count and bytes of each
/// slice.
class PassingSlices {
 public:
  explicit PassingSlices(const ElementPtr& identity) {
    g_object_set(identity.get(), "signal-handoffs", TRUE, nullptr);
    g_signal_connect(identity.get(), "handoff", G_CALLBACK(OnSlice), this);
  }
  /// Returns the slices in sorted order, because the links may change the order.
  std::vector<std::string> sorted() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> slices = slices_;
    std::sort(slices.begin(), slices.end());
    return slices;
  }

 private:
  static void OnSlice(GstElement*, GstBuffer* buffer, PassingSlices* self) {
    GstLidarSlice slice{};
    EXPECT_TRUE(gst_lidar_buffer_get_slice(buffer, &slice));
    const gst::BufferMap map(buffer, GST_MAP_READ);
    const std::lock_guard lock(self->mutex_);
    self->slices_.push_back(std::to_string(slice.scan_id) + ": " +
                            std::to_string(slice.slice_index) + " of " +
                            std::to_string(slice.slice_count) + ": " +
                            std::string(map.data(), map.data() + map.size()));
  }

  mutable std::mutex mutex_;
  std::vector<std::string> slices_;
};

class BondedScans : public ::testing::TestWithParam<Coding> {};

TEST_P(BondedScans, ComeOnceAndWholeOverTwoLinks) {
  constexpr int kScans = 10;
  const Coding& coding = GetParam();
  const ElementPtr is_built(gst_element_factory_make(coding.decoder, nullptr));
  if (!is_built) GTEST_SKIP() << coding.decoder << " is not built";
  Pipeline receiver(
      std::string("screamsrc name=in port=0 ! rtplidardepay max-reorder-time=5000000000 "
                  "! identity name=seen ! ") +
      coding.decoder + " name=decoder ! fakesink sync=false");
  const PassingSlices got(receiver.Get("seen"));
  receiver.Play();
  const std::string to = "127.0.0.1:" + BoundPort(receiver);
  Pipeline sender("lidartestsrc is-live=true model=os1-32 mode=512x10 slices-per-scan=" +
                  std::to_string(coding.slices_per_scan) + " num-buffers=" +
                  std::to_string(kScans * coding.slices_per_scan) + " ! " + coding.encoder +
                  " max-error=0.05 ! identity name=seen ! rtplidarpay ! "
                  "screamsink name=out max-queue-delay=5000000000 bonding-addresses=\"" +
                  to + "@127.0.0.1," + to + "@127.0.0.2\"");
  const PassingSlices sent(sender.Get("seen"));
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.Ends());
  // Compares with the slices that were sent, not with all slices of the scans, because a live
  // encoder that is late omits slices.
  const std::vector<std::string> slices = sent.sorted();
  EXPECT_FALSE(slices.empty());
  const std::vector<std::string> came = got.sorted();
  EXPECT_TRUE(std::includes(slices.begin(), slices.end(), came.begin(), came.end()));
  EXPECT_TRUE(came.size() == slices.size() || TooOld(sender.Get("out").get()) > 0)
      << came.size() << " of " << slices.size();
  const Stats decoder(receiver.Get("decoder").get());
  EXPECT_EQ(decoder["slices"], came.size());
  EXPECT_EQ(decoder["slices-dropped"], 0U);
  for (const guint64 accepted : OfLinks(sender.Get("out").get(), "feedback-accepted"))
    EXPECT_GT(accepted, 0U) << "both links are in use";
  EXPECT_EQ(OfLinks(receiver.Get("in").get(), "packets-received").size(), 2U);
}
INSTANTIATE_TEST_SUITE_P(
    Codings, BondedScans,
    ::testing::Values(Coding{"WholeScans", "lidarenc effort=1", "lidardec", 1},
                      Coding{"Points", "lidarenc effort=1 geometry=xyz", "lidardec", 8},
                      Coding{"WholeScansOfPoints", "lidarenc effort=1 geometry=xyz", "lidardec", 1},
                      Coding{"DracoRanges", "dracoenc", "dracodec", 8},
                      Coding{"DracoPoints", "dracoenc geometry=xyz", "dracodec", 8},
                      Coding{"DracoFiles", "dracoenc geometry=xyz", "dracodec", 1}),
    NameOf);

}  // namespace
}  // namespace lidar::test
