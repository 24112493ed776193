// SPDX-License-Identifier: LGPL-2.1-or-later
// Packets and reports of a sender that has a key, and forged packets.
#pragma once
#include <gst/check/gstharness.h>

#include <cstdint>
#include <string>
#include <vector>

#include "gst/scream/srtp/key.h"
#include "src/rtcp/sender_report.h"
#include "tests/elements/scream/rtp_support.h"

namespace lidar::gst {

inline const SrtpPolicy kPolicy = {"aes-128-icm", "hmac-sha1-80", "hmac-sha1-80", 30, 10};
constexpr guint32 kSsrc = 0x1234;
using Sequences = std::vector<guint16>;

inline SrtpKey Key(std::uint8_t digit) { return SrtpKey(kPolicy.key_size, digit); }

/// Encrypts packets as a sender does. Each SSRC has its own rollover counter.
class Protector {
 public:
  explicit Protector(const SrtpKey& key) {
    harness_.reset(NewEncoder(key, "rtp"));
    reports_.reset(NewEncoder(key, "rtcp"));
  }
  BufferPtr Protect(guint16 seq, guint32 ssrc = kSsrc, guint size = 20) {
    test::Rtp r;
    r.seq = seq;
    r.ssrc = ssrc;
    r.size = size;
    return BufferPtr(gst_harness_push_and_pull(harness_.get(), test::NewRtp(r)));
  }
  /// Returns an encrypted sender report of the stream `ssrc`.
  BufferPtr ProtectReport(guint32 ssrc = kSsrc) {
    rtcp::SenderReport report;
    report.ssrc = ssrc;
    GstBuffer* rtcp = test::FromBytes(rtcp::BuildSenderReport(report));
    return BufferPtr(gst_harness_push_and_pull(reports_.get(), rtcp));
  }
  /// Encrypts packets until the sequence number has wrapped one more time.
  void Wrap(guint32 ssrc = kSsrc) {
    for (const guint16 seq : Sequences{20'000, 40'000, 60'000, 5}) Protect(seq, ssrc);
  }

 private:
  static GstHarness* NewEncoder(const SrtpKey& key, const std::string& kind) {
    GstElement* encoder = gst_element_factory_make("srtpenc", nullptr);
    const BufferPtr master(gst_buffer_new_memdup(key.data(), key.size()));
    g_object_set(encoder, "key", master.get(), nullptr);
    GstHarness* harness = gst_harness_new_with_element(encoder, (kind + "_sink_0").c_str(),
                                                       (kind + "_src_0").c_str());
    gst_object_unref(encoder);
    gst_harness_set_src_caps_str(harness, ("application/x-" + kind).c_str());
    return harness;
  }

  test::Harness harness_;
  test::Harness reports_;
};

inline BufferPtr Forged(guint16 seq, guint32 ssrc = kSsrc) {
  test::Rtp r;
  r.seq = seq;
  r.ssrc = ssrc;
  r.size = 30;
  return BufferPtr(test::NewRtp(r));
}

}  // namespace lidar::gst
