// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the messages of a subject that JetStream keeps, in several pieces, for elements downstream
// of natssrc.
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

/// The messages of a subject that JetStream keeps. Any thread may call Answer(), because a mutex
/// lets only one call run at a time. Each call sends a few requests to the server and waits for the
/// answers.
class History {
 public:
  /// `stream` is the name of JetStream's stream. If it is empty, the stream that keeps the subject
  /// is used.
  History(ConnectionSettings connection, std::string subject, std::string stream);

  /// Returns nothing if no stream of the server keeps the subject, or if there is no connection to
  /// the server. The answer is `unanswered` if the server does not answer a request.
  std::optional<gst::HistoryAnswer> Answer(const gst::HistoryQuestion& question);

 private:
  struct Stored {
    guint64 stored = 0;    // time of storage [ns since 1970]
    guint64 captured = 0;  // capture time, or `stored` if it is unknown
  };
  bool Find();
  natsStatus Last(Stored* last);
  natsStatus First(Stored* first);
  natsStatus Fetch(jsConsumerConfig start, int most, guint64 most_bytes,
                   std::vector<MessagePtr>* messages);
  natsStatus Fill(const gst::HistoryQuestion& question, gst::HistoryAnswer* answer);
  void Take(const std::vector<MessagePtr>& messages, gst::HistoryAnswer* answer);
  StreamFormat::Ptr FormatOf(const std::string& id);

  const ConnectionSettings settings_;
  const std::string subject_;
  std::mutex mutex_;  // guards the members below
  std::string stream_;
  std::unique_ptr<Connection> connection_;
  JetStreamPtr js_;
  FormatBook book_;
};

}  // namespace lidar::nats
