// SPDX-License-Identifier: LGPL-2.1-or-later
// A client that the test itself uses. Its calls wait even while the server is frozen.
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

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
  /// Returns the numbers of the messages that `stream` has of `subject`. A natssink stores its caps
  /// again each second, so the numbers of its messages may have gaps.
  std::vector<std::uint64_t> NumbersOf(const std::string& stream,
                                       const std::string& subject) const {
    jsStreamInfo* raw_info = nullptr;
    EXPECT_EQ(js_GetStreamInfo(&raw_info, js(), stream.c_str(), nullptr, nullptr), NATS_OK);
    const nats::StreamInfoPtr info(raw_info);
    std::vector<std::uint64_t> numbers;
    for (std::uint64_t n = 1; info && n <= info->State.LastSeq; ++n) {
      natsMsg* raw = nullptr;
      EXPECT_EQ(js_GetMsg(&raw, js(), stream.c_str(), n, nullptr, nullptr), NATS_OK);
      const nats::MessagePtr message(raw);
      if (message && natsMsg_GetSubject(raw) == subject) numbers.push_back(n);
    }
    return numbers;
  }

 private:
  natsConnection* nc_ = nullptr;
  nats::JetStreamPtr js_;
};

/// A durable consumer of r1.front. Another program made it before natssrc uses it.
class DurableConsumer {
 public:
  DurableConsumer(const std::string& url, std::int64_t ack_wait_ns, std::int64_t max_pending)
      : client_(url) {
    jsConsumerConfig config;
    jsConsumerConfig_Init(&config);
    config.Durable = "slam";
    config.DeliverSubject = "slam-delivery";
    config.FilterSubject = "r1.front";
    config.AckPolicy = js_AckExplicit;
    config.AckWait = ack_wait_ns;
    config.MaxAckPending = max_pending;
    EXPECT_EQ(js_AddConsumer(nullptr, client_.js(), "box", &config, nullptr, nullptr), NATS_OK);
  }
  /// Returns the number of unacknowledged messages that the server has sent more than once.
  std::int64_t again() const { return Info()->NumRedelivered; }
  /// Returns the number of unacknowledged messages that the server has sent.
  std::int64_t unacknowledged() const { return Info()->NumAckPending; }
  /// Returns the number of unacknowledged messages, including those that the server has not sent
  /// yet.
  std::uint64_t open() const {
    const auto info = Info();
    return info->NumPending + static_cast<std::uint64_t>(info->NumAckPending);
  }

 private:
  nats::ConsumerInfoPtr Info() const {
    jsConsumerInfo* info = nullptr;
    EXPECT_EQ(js_GetConsumerInfo(&info, client_.js(), "box", "slam", nullptr, nullptr), NATS_OK);
    return nats::ConsumerInfoPtr(info);
  }

  const NatsClient client_;
};

}  // namespace lidar::test
