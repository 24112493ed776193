// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages that another program publishes on the subjects of a stream.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/elements/nats/nats_client.h"

namespace lidar::test {

/// A program that is neither natssink nor natssrc, and publishes on the same server.
class Stranger {
 public:
  explicit Stranger(const std::string& url) : client_(url) {}
  void Publish(const char* subject, const std::string& bytes,
               const std::vector<std::pair<const char*, std::string>>& headers = {}) {
    natsMsg* raw = nullptr;
    natsMsg_Create(&raw, subject, nullptr, bytes.data(), static_cast<int>(bytes.size()));
    const nats::MessagePtr message(raw);
    for (const auto& [name, value] : headers) natsMsgHeader_Set(raw, name, value.c_str());
    EXPECT_EQ(natsConnection_PublishMsg(client_.get(), raw), NATS_OK);
  }
  void Flush() { natsConnection_FlushTimeout(client_.get(), NatsClient::kPatienceMs); }

 private:
  const NatsClient client_;
};

}  // namespace lidar::test
