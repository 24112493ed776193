// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/sensor_link.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace lidar::gst {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstRetry{250};
constexpr milliseconds kSlowestRetry{4000};
constexpr milliseconds kPoll{500};  // interval between requests while the sensor starts up

}  // namespace

std::unique_ptr<SensorLink> SensorLink::Create(const OusterSettings& settings,
                                               std::function<void()> notify, std::string* error) {
  auto client = HttpClient::Create(settings.hostname, error);
  if (!client) return nullptr;
  std::unique_ptr<SensorLink> link(new SensorLink(settings, std::move(client), std::move(notify)));
  try {
    link->thread_ = std::thread([raw = link.get()] { raw->Run(); });
  } catch (const std::system_error& e) {
    *error = std::string("cannot start a thread: ") + e.what();
    return nullptr;
  }
  return link;
}

SensorLink::SensorLink(const OusterSettings& settings, std::unique_ptr<HttpClient> client,
                       std::function<void()> notify)
    : settings_(settings), client_(std::move(client)), notify_(std::move(notify)) {}

SensorLink::~SensorLink() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  client_->Cancel();
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void SensorLink::Request() {
  {
    std::lock_guard lock(mutex_);
    requested_ = true;
  }
  changed_.notify_all();
}

bool SensorLink::busy() const {
  std::lock_guard lock(mutex_);
  return requested_;
}

std::optional<SensorLink::Result> SensorLink::Take() {
  std::lock_guard lock(mutex_);
  return std::exchange(result_, std::nullopt);
}

bool SensorLink::Sleep(milliseconds time) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, time, [this] { return stopping_; });
}

SensorLink::Result SensorLink::Ask() {
  SensorApi api(client_.get());
  Result result;
  if (!api.Configure(
          settings_, [this] { return Sleep(kPoll); }, &result.error))
    return result;
  result.metadata = api.FetchMetadata(&result.error);
  if (result.metadata) result.destination = api.Destination();
  return result;
}

void SensorLink::Run() {
  milliseconds retry = kFirstRetry;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stopping_ || requested_; });
      if (stopping_) return;
    }
    Result result = Ask();
    const bool again = !result.metadata && !result.error.permanent && settings_.reconnect;
    {
      std::lock_guard lock(mutex_);
      if (stopping_) return;
      requested_ = again;
      result_ = std::move(result);
    }
    notify_();
    if (again && !Sleep(retry)) return;
    retry = again ? std::min(2 * retry, kSlowestRetry) : kFirstRetry;
  }
}

}  // namespace lidar::gst
