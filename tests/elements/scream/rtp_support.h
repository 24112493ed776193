// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions for RTP and RTCP buffers and for the statistics of elements, and a test clock that
// replaces the system clock.
#pragma once
#include <gio/gio.h>
#include <gst/check/gsttestclock.h>
#include <gst/net/gstnetaddressmeta.h>
#include <gst/rtp/gstrtpbuffer.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/rtcp/ccfb.h"
#include "src/rtp/payload_header.h"
#include "tests/support/element_stats.h"
#include "tests/support/harness.h"

namespace lidar::test {

using gst::BufferPtr;
using gst::EventPtr;
using gst::StructurePtr;

constexpr const char* kRtpCaps =
    "application/x-rtp,media=(string)application,clock-rate=90000,encoding-name=(string)TEST,"
    "payload=96";
constexpr const char* kVideoCaps =
    "application/x-rtp,media=(string)video,clock-rate=90000,encoding-name=(string)H264,payload=96";

struct Rtp {
  guint16 seq = 0;
  guint32 timestamp = 0;
  bool marker = false;
  guint32 ssrc = 0x1234;
  guint8 payload_type = 96;
  guint size = 1188;  // of the payload, if `payload` is empty [bytes]
  std::vector<std::uint8_t> payload{};
};

/// Returns the payload of an RTP packet that contains a whole slice.
inline std::vector<std::uint8_t> WholeSlice(std::uint64_t capture_ntp = 0) {
  lidar::rtp::Unit unit;
  const std::vector<std::uint8_t> bytes(100, 7);
  unit.length = 100;
  unit.body = {bytes.data(), bytes.size()};
  unit.info.capture_ntp = capture_ntp;
  unit.crc = lidar::rtp::UnitCrc(unit, unit.body);
  std::vector<std::uint8_t> payload;
  lidar::rtp::WriteHeader(unit, &payload);
  payload.insert(payload.end(), bytes.begin(), bytes.end());
  return payload;
}

inline GstBuffer* NewRtp(const Rtp& r) {
  const auto size = r.payload.empty() ? r.size : static_cast<guint>(r.payload.size());
  GstBuffer* buffer = gst_rtp_buffer_new_allocate(size, 0, 0);
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  gst_rtp_buffer_map(buffer, GST_MAP_WRITE, &rtp);
  gst_rtp_buffer_set_seq(&rtp, r.seq);
  gst_rtp_buffer_set_timestamp(&rtp, r.timestamp);
  gst_rtp_buffer_set_marker(&rtp, r.marker);
  gst_rtp_buffer_set_ssrc(&rtp, r.ssrc);
  gst_rtp_buffer_set_payload_type(&rtp, r.payload_type);
  // Sets the whole payload to 0 first, so that packets with equal fields are equal byte for byte.
  auto* payload = static_cast<std::uint8_t*>(gst_rtp_buffer_get_payload(&rtp));
  std::fill_n(payload, size, std::uint8_t{0});
  std::copy(r.payload.begin(), r.payload.end(), payload);
  gst_rtp_buffer_unmap(&rtp);
  return buffer;
}

inline GstBuffer* FromBytes(const std::vector<std::uint8_t>& bytes) {
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, bytes.size(), nullptr);
  gst_buffer_fill(buffer, 0, bytes.data(), bytes.size());
  return buffer;
}

inline std::vector<std::uint8_t> ToBytes(GstBuffer* buffer) {
  std::vector<std::uint8_t> bytes(gst_buffer_get_size(buffer));
  gst_buffer_extract(buffer, 0, bytes.data(), bytes.size());
  return bytes;
}

inline Rtp ReadRtp(GstBuffer* buffer) {
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  Rtp r;
  if (!gst_rtp_buffer_map(buffer, GST_MAP_READ, &rtp)) return r;
  r.seq = gst_rtp_buffer_get_seq(&rtp);
  r.timestamp = gst_rtp_buffer_get_timestamp(&rtp);
  r.marker = gst_rtp_buffer_get_marker(&rtp) != FALSE;
  r.ssrc = gst_rtp_buffer_get_ssrc(&rtp);
  r.payload_type = gst_rtp_buffer_get_payload_type(&rtp);
  r.size = gst_rtp_buffer_get_payload_len(&rtp);
  gst_rtp_buffer_unmap(&rtp);
  return r;
}

inline GSocketAddress* Address(const char* host, guint port) {
  return g_inet_socket_address_new_from_string(host, port);
}

inline void SetSource(GstBuffer* buffer, const char* host, guint port) {
  GSocketAddress* address = Address(host, port);
  gst_buffer_add_net_address_meta(buffer, address);
  g_object_unref(address);
}

/// A copy of the property `stats` of an element.
class Stats {
 public:
  explicit Stats(GstElement* element) : stats_(StatsOf(element)) {}
  explicit Stats(const GstStructure* stats) : stats_(gst_structure_copy(stats)) {}
  /// Returns the element `index` of the array `name`, which is itself a structure.
  Stats Of(const char* name, guint index) const {
    const GValue* array = gst_structure_get_value(stats_.get(), name);
    if (array == nullptr || gst_value_array_get_size(array) <= index) {
      ADD_FAILURE() << "no member " << index << " of " << name;
      return *this;
    }
    return Stats(gst_value_get_structure(gst_value_array_get_value(array, index)));
  }
  Stats(const Stats& other) : Stats(other.stats_.get()) {}
  Stats& operator=(const Stats&) = delete;

  guint64 operator[](const char* field) const {
    guint64 wide = 0;
    guint narrow = 0;
    if (gst_structure_get_uint64(stats_.get(), field, &wide)) return wide;
    if (gst_structure_get_uint(stats_.get(), field, &narrow)) return narrow;
    ADD_FAILURE() << "no field " << field;
    return 0;
  }
  bool True(const char* field) const {
    gboolean value = FALSE;
    if (!gst_structure_get_boolean(stats_.get(), field, &value))
      ADD_FAILURE() << "no field " << field;
    return value != FALSE;
  }
  std::string Text(const char* field) const {
    const gchar* text = gst_structure_get_string(stats_.get(), field);
    return text != nullptr ? text : "";
  }

 private:
  StructurePtr stats_;
};

/// A clock that replaces the system clock. Only the test advances it.
class FakeTime {
 public:
  FakeTime() : clock_(gst_test_clock_new_with_start_time(1000 * GST_SECOND)) {
    gst_system_clock_set_default(clock_);
  }
  ~FakeTime() {
    gst_system_clock_set_default(nullptr);
    gst_object_unref(clock_);
  }
  FakeTime(const FakeTime&) = delete;
  FakeTime& operator=(const FakeTime&) = delete;

  GstTestClock* clock() const { return GST_TEST_CLOCK(clock_); }
  GstClockTime now() const { return gst_clock_get_time(clock_); }
  /// Advances the clock to `goal`. Wakes each thread that waits on the clock when its time comes.
  void AdvanceTo(GstClockTime goal) {
    for (;;) {
      GstClockID id = nullptr;
      gst_test_clock_wait_for_next_pending_id(clock(), &id);
      const GstClockTime due = gst_clock_id_get_time(id);
      gst_clock_id_unref(id);
      if (due > goal) break;
      if (due > now()) gst_test_clock_set_time(clock(), due);
      if (GstClockID done = gst_test_clock_process_next_clock_id(clock())) gst_clock_id_unref(done);
    }
    if (goal > now()) gst_test_clock_set_time(clock(), goal);
  }
  /// Waits until the element's thread has finished its work and waits on the clock.
  void Settle() const { gst_test_clock_wait_for_next_pending_id(clock(), nullptr); }
  void Advance(GstClockTime time) { AdvanceTo(now() + time); }

 private:
  GstClock* clock_;
};

}  // namespace lidar::test
