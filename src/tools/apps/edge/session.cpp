// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/edge/session.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "src/tools/apps/edge/pipeline.h"
#include "src/tools/apps/edge/shared_port.h"
#include "src/tools/common/elements.h"

namespace lidar::edge {
namespace {

using gst::MessagePtr;
using gst::StructurePtr;
using std::chrono::seconds;
using tools::StatsOf;

constexpr seconds kFirstPause{2};  // pause after the first failure
constexpr seconds kLongestPause{64};
// A failure after a longer session or recording resets the pause.
constexpr seconds kHealthySession{10};
constexpr GstClockTime kFinish = 3 * GST_SECOND;

}  // namespace

Session::Session(const EdgeConfig& config, const RobotConfig& robot, GSocket* socket)
    : robot_(robot),
      socket_(socket),
      pipeline_(MakePipeline(config, robot, socket)),
      robot_watch_(robot.max_mbps),
      failures_(kFirstPause, kLongestPause),
      record_failures_(kFirstPause, kLongestPause) {
  if (!robot.record.empty()) {  // throws here if an element of the recorder is missing
    AddRecorder(pipeline_.get(), robot);
    RemoveRecorder(pipeline_.get());
  }
}

template <class Change>
void Session::Update(Change change) {
  const std::lock_guard lock(mutex_);
  change(&account_);
  account_.state = state_;
}

Session::Account Session::account() const {
  const std::lock_guard lock(mutex_);
  return account_;
}

void Session::Say(const std::string& what) const {
  std::fprintf(stderr, "%s: %s\n", GST_OBJECT_NAME(pipeline_.get()), what.c_str());
}

void Session::Begin(Time now) {
  state_ = State::kWaiting;
  Update([](Account* a) { ++a->sessions; });
  began_at_ = now;
  watch_at_.reset();
  robot_watch_.Begin();
  if (socket_ != nullptr) ShutSocket(socket_, false);
  // Errors are not checked here, because ReadBus() reports them.
  gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
}

void Session::End() {
  if (socket_ != nullptr) ShutSocket(socket_, true);
  gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
  RemoveRecorder(pipeline_.get());
  recording_ = false;
}

/// Waits up to kFinish until the received data are written and sent, and then ends the session.
void Session::Finish(Time now) {
  if (state_ != State::kResting && BytesReceived() > 0)
    Drain(pipeline_.get(), kFinish, [&](GstMessage* message) { NoteError(now, message); });
  End();
}

void Session::Rest(Time now, Duration pause, const std::string& why) {
  End();
  state_ = State::kResting;
  begin_at_ = now + pause;
  Update([](Account*) {});
  Say(why);
}

/// Adds the recorder if the session has none yet, or if the pause after a failure of the recorder
/// is over. The stream continues meanwhile.
void Session::Record(Time now) {
  if (robot_.record.empty() || recording_ || now < record_at_) return;
  recording_ = true;
  record_at_ = now;
  try {
    AddRecorder(pipeline_.get(), robot_);
  } catch (const std::exception& e) {
    NoteRecordFailure(now, e.what());
  }
}

void Session::NoteRecordFailure(Time now, const std::string& why) {
  RemoveRecorder(pipeline_.get());
  recording_ = false;
  if (now - record_at_ > kHealthySession) record_failures_.Reset();
  record_at_ = now + record_failures_.Next();
  Update([&](Account* a) {
    ++a->record_failures;
    a->last_error = why;
  });
  Say(why);
}

/// Handles an error message. Returns false if the error ends the session.
bool Session::NoteError(Time now, GstMessage* message) {
  const std::string text = tools::MessageText(message);
  if (IsFromRecorder(message)) {
    if (recording_) NoteRecordFailure(now, text);  // later errors of this recorder are ignored
    return true;
  }
  if (now - began_at_ > kHealthySession) failures_.Reset();
  Update([&](Account* a) {
    ++a->failures;
    a->last_error = text;
  });
  Rest(now, failures_.Next(), text);
  return false;
}

/// Handles the messages on the bus. Returns false if a message ends the session.
bool Session::ReadBus(Time now) {
  GstBus* bus = GST_ELEMENT_BUS(pipeline_.get());
  while (const MessagePtr message{gst_bus_pop(bus)}) {
    switch (GST_MESSAGE_TYPE(message.get())) {
      case GST_MESSAGE_ERROR:
        if (!NoteError(now, message.get())) return false;
        break;
      case GST_MESSAGE_WARNING: {
        const std::string text = tools::MessageText(message.get());
        Update([&](Account* a) { a->last_error = text; });
        Say(text);
        break;
      }
      case GST_MESSAGE_EOS:
        Rest(now, seconds(0), "the robot has said goodbye");
        return false;
      default:
        break;
    }
  }
  return true;
}

guint64 Session::BytesReceived() const {
  guint64 bytes = 0;
  if (const StructurePtr stats = StatsOf(pipeline_.get(), "screamsrc"))
    gst_structure_get_uint64(stats.get(), "bytes-received", &bytes);
  return bytes;
}

/// Checks once per second whether the robot sends, and whether it exceeds its limit.
void Session::Watch(Time now) {
  if (watch_at_ && now < *watch_at_) return;
  watch_at_ = now + seconds(1);
  robot_watch_.Note(now, BytesReceived());
  if (state_ == State::kWaiting && robot_watch_.is_there()) {
    Say("the robot is here");
    state_ = State::kReceiving;
    Update([](Account*) {});
  }
  if (robot_watch_.IsGone()) return Rest(now, seconds(0), "the robot is gone");
  const Duration pause = robot_watch_.ToShutOut();
  if (pause == Duration{}) return;
  Update([](Account* a) { ++a->penalties; });
  char why[96];
  std::snprintf(why, sizeof why, "the robot sends more than max-mbps, and is shut out for %.0f s",
                std::ceil(Seconds(pause)));
  Rest(now, pause, why);
}

void Session::Poll(Time now) {
  if (state_ == State::kResting) {
    if (now < begin_at_) return;
    Begin(now);
  }
  Record(now);
  if (ReadBus(now)) Watch(now);
}

nlohmann::json Session::Tell(fleet::Exposition* exposition) const {
  static constexpr const char* kStates[] = {"waiting", "receiving", "resting"};
  const Account a = account();
  const std::string labels = fleet::RobotLabels(robot_.name, robot_.sensor);
  exposition->Add("lidar_edge_receiving", labels, a.state == State::kReceiving ? 1 : 0);
  exposition->Add("lidar_edge_sessions", labels, static_cast<double>(a.sessions));
  exposition->Add("lidar_edge_failures", labels, static_cast<double>(a.failures));
  exposition->Add("lidar_edge_penalties", labels, static_cast<double>(a.penalties));
  exposition->Add("lidar_edge_record_failures", labels, static_cast<double>(a.record_failures));
  nlohmann::json report = {{"robot", robot_.name},
                           {"sensor", robot_.sensor},
                           {"time", g_get_real_time() * 1000},
                           {"state", kStates[static_cast<int>(a.state)]},
                           {"sessions", a.sessions},
                           {"failures", a.failures},
                           {"penalties", a.penalties},
                           {"record-failures", a.record_failures}};
  if (!a.last_error.empty()) report["last-error"] = a.last_error;
  fleet::AddStats(pipeline_.get(), {"screamsrc", "rtplidardepay", "natssink", "mcapsink"}, labels,
                  exposition, &report);
  return report;
}

}  // namespace lidar::edge
