// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads what JetStream keeps of a subject, piece by piece, for elements downstream of the source.
#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ext/nats/connection.h"
#include "ext/nats/format_book.h"
#include "gst/common/history_query.h"

namespace lidar::nats {

/// All threads may call Answer(), one at a time. An answer takes a few requests to the server.
class History {
 public:
  /// `stream` names a stream of JetStream; empty: the stream that keeps the subject.
  History(ConnectionSettings connection, std::string subject, std::string stream);

  /// Returns nothing if no stream of the server keeps the subject, or the server is away.
  std::optional<gst::HistoryAnswer> Answer(const gst::HistoryQuestion& question);

 private:
  struct Stored {
    guint64 stored = 0;    // time [ns since 1970]
    guint64 captured = 0;  // the same as `stored` if it is not known
  };
  bool Find();
  std::optional<Stored> Last();
  std::optional<Stored> First();
  std::vector<MessagePtr> Fetch(jsConsumerConfig start, int most, guint64 most_bytes);
  void Take(const std::vector<MessagePtr>& messages, gst::HistoryAnswer* answer);
  StreamFormat::Ptr FormatOf(const std::string& id);

  const ConnectionSettings settings_;
  const std::string subject_;
  std::mutex mutex_;  // guards what follows
  std::string stream_;
  std::unique_ptr<Connection> connection_;
  JetStreamPtr js_;
  FormatBook book_;
};

}  // namespace lidar::nats
