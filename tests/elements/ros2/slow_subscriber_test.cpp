// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of ros2sink with a subscriber that is slow or does not read at all, and of the sink's
// counters.
#include <dds/dds.h>

#include "ext/ros2/raw_type.h"
#include "tests/elements/ros2/ros2_support.h"

namespace lidar::test {
namespace {

using gst::BufferPtr;

constexpr const char* kSlow = "A subscriber is too slow";
constexpr gsize kSampleSize = 32;
constexpr const char* kCaps = "application/x-imu,sample-size=32";

/// A reliable subscriber to IMU samples. It has room for only one sample.
class SlowReader {
 public:
  explicit SlowReader(std::uint32_t domain)
      : participant_(dds_create_participant(domain, nullptr, nullptr)) {
    ddsi_sertype* type = dds::NewRawType("sensor_msgs::msg::dds_::Imu_", 1U << 20);
    const dds_entity_t topic =
        dds_create_topic_sertype(participant_, "rt/points", &type, nullptr, nullptr, nullptr);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, 0);
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
    dds_qset_resource_limits(qos, 1, 1, 1);
    const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos, 1, &xcdr1);
    reader_ = dds_create_reader(participant_, topic, qos, nullptr);
    dds_delete_qos(qos);
    EXPECT_GT(reader_, 0) << dds_strretcode(-reader_);
  }
  ~SlowReader() { dds_delete(participant_); }
  SlowReader(const SlowReader&) = delete;
  SlowReader& operator=(const SlowReader&) = delete;

  /// Takes a message from the reader. Returns the size of the message, or 0 if there is none.
  std::size_t Take() {
    ddsi_serdata* data = nullptr;
    dds_sample_info_t info{};
    if (dds_takecdr(reader_, &data, 1, &info, DDS_ANY_STATE) <= 0) return 0;
    const dds::MessagePtr message(data);
    return dds::BytesOf(data).size;
  }

 private:
  dds_entity_t participant_;
  dds_entity_t reader_ = 0;
};

class Ros2SlowSubscriber : public Ros2Test {
 protected:
  void SetUp() override {
    Start("ros2sink", "topic=/points sync=false");
    gst_harness_set_src_caps_str(h_.get(), kCaps);
    // The sink makes its topic when it gets the first message.
    Push(1);
    reader_ = std::make_unique<SlowReader>(TestDomain());
    ASSERT_TRUE(WaitForStat("subscribers", 1));
  }
  void TearDown() override {
    reader_.reset();
    Ros2Test::TearDown();
  }
  void Push(gsize samples) {
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, kSampleSize * samples, nullptr);
    gst_buffer_memset(buffer, 0, 0, kSampleSize * samples);
    ASSERT_EQ(gst_harness_push(h_.get(), buffer), GST_FLOW_OK);
  }
  int Complaints(const char* text) {
    int count = 0;
    for (std::string next = NextComplaint(0); !next.empty(); next = NextComplaint(0))
      count += next.find(text) != next.npos;
    return count;
  }

  std::unique_ptr<SlowReader> reader_;
};

TEST_F(Ros2SlowSubscriber, IsToldOfOnceUntilItTakesAMessageAndTheBytesAreThoseOfWhatWasSent) {
  guint64 bytes = 0;
  for (guint64 round = 0; round < 2; ++round) {
    Push(1);
    EXPECT_EQ(Stat("messages"), round + 1);
    for (guint64 i = 1; i <= 2; ++i) {
      Push(1);
      EXPECT_EQ(Stat("messages-timed-out"), 2 * round + i);
    }
    EXPECT_EQ(Stat("messages"), round + 1);
    EXPECT_EQ(Complaints(kSlow), 1) << round;
    bytes += reader_->Take();
    EXPECT_EQ(Stat("bytes"), bytes) << round;
  }
  EXPECT_EQ(Stat("buffers-refused"), 0U);
  EXPECT_EQ(Stat("messages-without-subscriber"), 1U);
  reader_.reset();  // otherwise the stop of the element would end the reader's domain
  StartAgain(kCaps);
  for (const char* counter : {"messages", "bytes", "messages-timed-out"})
    EXPECT_EQ(Stat(counter), 0U) << counter;
  reader_ = std::make_unique<SlowReader>(TestDomain());
  ASSERT_TRUE(WaitForStat("subscribers", 1));
  for (int i = 0; i < 3; ++i) Push(1);
  EXPECT_EQ(Complaints(kSlow), 1) << "in each run";
}

/// The sink waits a tenth of a second for a slow subscriber. It must wait once per buffer, not for
/// each sample.
TEST_F(Ros2SlowSubscriber, IsWaitedForOnceForAllSamplesOfABuffer) {
  Push(1);
  const gint64 begin = g_get_monotonic_time();
  Push(300);
  EXPECT_LT(g_get_monotonic_time() - begin, 15 * G_USEC_PER_SEC);
  EXPECT_EQ(Stat("messages-timed-out"), 300U);
  EXPECT_EQ(Stat("messages"), 1U);
  reader_->Take();
  Push(1);
  EXPECT_EQ(Stat("messages"), 2U) << "a buffer later it is waited for again";
}

}  // namespace
}  // namespace lidar::test
