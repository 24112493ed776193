// SPDX-License-Identifier: LGPL-2.1-or-later
// A session with a sensor on the network. It fetches the sensor's metadata, notices restarts of the
// sensor, and waits while no packets arrive.
#pragma once
#include <atomic>
#include <memory>
#include <string>

#include "ext/ouster/sensor_link.h"
#include "ext/ouster/session.h"
#include "ext/ouster/udp_feed.h"

namespace lidar::gst {

class LiveSession : public Session {
 public:
  LiveSession(GstBaseSrc* element, const OusterSettings& settings);
  ~LiveSession() override;

  bool Open() override;
  void Unlock() override;
  void UnlockStop() override;
  void Resume() override { resumed_ = true; }

 protected:
  GstFlowReturn Poll() override;
  void AddCounters(Counters* counters) const override;

 private:
  bool OpenFeed();
  bool OpenLink();
  bool OpenSockets(const ouster::Metadata& metadata);
  bool HandleAnswer(SensorLink::Result result);
  bool TakeMetadata(ouster::Metadata metadata);
  void HandlePacket(const ReceivedDatagram& datagram, Time now, Time utc_now);
  void HandleNewInitId(ByteView payload, const ouster::Arrival& arrival);
  void HandleWrongSize(gsize size);
  bool CheckSilence(gint64 now_us);
  bool WaitWhileSwitchedOff();
  void LeavePauseBehind();
  void SetConnected(bool connected, const std::string& reason);
  void Ask();
  /// Returns the time of the pipeline's clock, or of the system's clock if there is none [us].
  gint64 Now() const;

  std::unique_ptr<SensorLink> link_;  // null if hostname is empty
  UdpFeed udp_;
  std::atomic<bool> flushing_{false};
  std::atomic<bool> resumed_{false};  // true if Resume() was called since the last Poll()
  bool polled_ = false;
  guint receive_buffer_ = 0;
  bool connected_ = false;
  bool lost_once_ = false;
  bool heard_ = false;  // true once a packet of the sensor has arrived
  guint reconnects_ = 0;
  std::string destination_;    // where the sensor sends packets, as in its configuration
  gint64 last_packet_us_ = 0;  // a time of Now()
  gint64 new_init_id_us_ = 0;  // when the first packet with an unknown init id arrived
  gint64 last_question_us_ = 0;
  guint wrong_sizes_in_a_row_ = 0;
  bool size_reported_ = false;
  bool silence_reported_ = false;
  bool api_reported_ = false;
};

}  // namespace lidar::gst
