// SPDX-License-Identifier: LGPL-2.1-or-later
// A client that the test itself uses. Its calls wait even while the server is frozen.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "ext/nats/nats_ptr.h"
#include "tests/support/patience.h"

namespace lidar::test {

class NatsClient {
 public:
  static constexpr std::int64_t kPatienceMs = kPatience / std::chrono::milliseconds(1);

  explicit NatsClient(const std::string& url) {
    natsOptions* raw_options = nullptr;
    natsOptions_Create(&raw_options);
    const nats::OptionsPtr options(raw_options);
    natsOptions_SetURL(raw_options, url.c_str());
    natsOptions_SetTimeout(raw_options, kPatienceMs);
    EXPECT_EQ(natsConnection_Connect(&nc_, raw_options), NATS_OK);
    jsOptions of_requests;
    jsOptions_Init(&of_requests);
    of_requests.Wait = kPatienceMs;
    jsCtx* raw = nullptr;
    EXPECT_EQ(natsConnection_JetStream(&raw, nc_, &of_requests), NATS_OK);
    js_.reset(raw);
  }
  ~NatsClient() {
    js_.reset();
    natsConnection_Destroy(nc_);
  }
  NatsClient(const NatsClient&) = delete;
  NatsClient& operator=(const NatsClient&) = delete;

  natsConnection* get() const { return nc_; }
  jsCtx* js() const { return js_.get(); }
  /// Subscribes to `subject`, and returns when the server has the subscription.
  nats::SubscriptionPtr Subscribe(const std::string& subject) const {
    natsSubscription* raw = nullptr;
    EXPECT_EQ(natsConnection_SubscribeSync(&raw, nc_, subject.c_str()), NATS_OK);
    EXPECT_EQ(natsConnection_FlushTimeout(nc_, kPatienceMs), NATS_OK);
    return nats::SubscriptionPtr(raw, {nc_});
  }

 private:
  natsConnection* nc_ = nullptr;
  nats::JetStreamPtr js_;
};

}  // namespace lidar::test
