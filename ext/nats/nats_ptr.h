// SPDX-License-Identifier: LGPL-2.1-or-later
// Owning pointers of libnats' types.
#pragma once
#include <nats/nats.h>

#include <cstdint>
#include <memory>

namespace lidar::nats {

struct Destroy {
  void operator()(natsOptions* p) const { natsOptions_Destroy(p); }
  void operator()(natsMsg* p) const { natsMsg_Destroy(p); }
  void operator()(jsCtx* p) const { jsCtx_Destroy(p); }
  void operator()(jsStreamInfo* p) const { jsStreamInfo_Destroy(p); }
  void operator()(jsConsumerInfo* p) const { jsConsumerInfo_Destroy(p); }
  void operator()(jsMsgMetaData* p) const { jsMsgMetaData_Destroy(p); }
  void operator()(natsStatistics* p) const { natsStatistics_Destroy(p); }
  void operator()(natsInbox* p) const { natsInbox_Destroy(p); }
};

/// Unsubscribes, waits for the server, and frees the subscription. libnats 3.4 may free a
/// subscription while its reading thread still delivers a message to the subscription. The flush
/// prevents this: it waits for an answer of the server, which the reading thread reads only after
/// all such messages. If the connection is closed, the flush returns at once.
struct EndSubscription {
  static constexpr std::int64_t kTimeoutMs = 1'000;
  natsConnection* connection = nullptr;
  void operator()(natsSubscription* p) const {
    natsSubscription_Unsubscribe(p);
    natsConnection_FlushTimeout(connection, kTimeoutMs);
    natsSubscription_Destroy(p);
  }
};

using OptionsPtr = std::unique_ptr<natsOptions, Destroy>;
using SubscriptionPtr = std::unique_ptr<natsSubscription, EndSubscription>;
using MessagePtr = std::unique_ptr<natsMsg, Destroy>;
using JetStreamPtr = std::unique_ptr<jsCtx, Destroy>;
using StreamInfoPtr = std::unique_ptr<jsStreamInfo, Destroy>;
using ConsumerInfoPtr = std::unique_ptr<jsConsumerInfo, Destroy>;
using MetaDataPtr = std::unique_ptr<jsMsgMetaData, Destroy>;
using StatisticsPtr = std::unique_ptr<natsStatistics, Destroy>;
using InboxPtr = std::unique_ptr<natsInbox, Destroy>;

}  // namespace lidar::nats
