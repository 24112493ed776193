// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the messages of a rosbag2 database (rosbag2_storage_sqlite3) from its tables `topics` and
// `messages`. The file is untrusted: it may contain any bytes and have any schema.
#include <sqlite3.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>

#include "src/tools/lab/codec_lab/message_reader.h"

namespace lidar::tools {
namespace {

constexpr int kMostBytes = 128 << 20;    // most bytes of a message
constexpr int kMostBytesOfAName = 4096;  // most bytes of a name or of a statement of the schema
constexpr std::size_t kMostTopics = 10'000;
constexpr std::size_t kLongestName = 1024;
/// The most instructions that SQLite may run to read the schema or the topics. A damaged schema may
/// use the same pages on each of 20 levels, so that reading it takes almost for ever.
constexpr int kMostInstructions = 500'000;

struct Closer {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Closer>;

class BagDatabase final : public MessageReader {
 public:
  explicit BagDatabase(const std::string& path) : path_(path) {
    // Refuses pipes, because opening a pipe would wait for its writer.
    if (!std::filesystem::is_regular_file(path)) Fail("is not a regular file");
    const std::uint64_t unfinished = SizeOf(path + "-wal") + SizeOf(path + "-journal");
    size_ = std::filesystem::file_size(path) + unfinished;
    // An immutable database is read without any other file. Rows in the -wal file need an index,
    // which is another file unless the locking mode is exclusive. This mode is set below.
    const std::string uri = UriOf(path) + (unfinished > 0 ? "?vfs=unix-none" : "?immutable=1");
    sqlite3* database = nullptr;
    const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_URI;
    const int result = sqlite3_open_v2(uri.c_str(), &database, flags, nullptr);
    database_.reset(database);
    if (result != SQLITE_OK) FailWithItsReason();
    sqlite3_db_config(database, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    // Disables views and virtual tables, because they may compute rows without end.
    sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_drop_modules(database, nullptr);
    sqlite3_limit(database, SQLITE_LIMIT_LENGTH, kMostBytesOfAName);
    sqlite3_progress_handler(
        database, kMostInstructions, [](void*) { return 1; }, nullptr);
    sqlite3_step(Prepare("PRAGMA locking_mode=EXCLUSIVE").get());
    RequireColumns("topics", {"id", "name", "type", "serialization_format"});
    RequireColumns("messages", {"id", "topic_id", "timestamp", "data"});
    ReadTopics();
  }

  std::vector<RecordedTopic> Topics() const override { return topics_; }

  /// Selects the topic of the messages that Next() returns. Data of other messages are not loaded.
  void Select(const std::string& topic) override {
    std::string ids;
    for (std::size_t i = 0; i < topics_.size(); ++i)
      if (topics_[i].name == topic) ids += (ids.empty() ? "" : ",") + std::to_string(ids_[i]);
    sqlite3_limit(database_.get(), SQLITE_LIMIT_LENGTH, kMostBytes);
    sqlite3_progress_handler(database_.get(), 0, nullptr, nullptr);
    // Skips rows that have a text in place of a number. SQLite would have to read the text to reach
    // the data, and a crafted file may use the same pages for the texts of many rows.
    const std::string numbers =
        "typeof(id) IN ('integer', 'null') AND typeof(topic_id) = 'integer' AND "
        "typeof(timestamp) = 'integer'";
    messages_.statement = Prepare(
        "SELECT _rowid_, CASE typeof(data) WHEN 'blob' THEN length(data) END, CASE WHEN " +
        numbers + " THEN timestamp END, CASE WHEN " + numbers + " THEN CASE WHEN topic_id IN (" +
        ids + ") AND typeof(data) = 'blob' AND length(data) <= " + std::to_string(kMostBytes) +
        " THEN data END END FROM messages NOT INDEXED");
    messages_.last_row = INT64_MIN;
    messages_.bytes = 0;
  }

  std::optional<RecordedMessage> Next() override {
    sqlite3_stmt* row = messages_.statement.get();
    while (row != nullptr && Step(&messages_)) {
      if (sqlite3_column_type(row, 2) != SQLITE_INTEGER) continue;
      if (sqlite3_column_type(row, 3) != SQLITE_BLOB) continue;
      const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(row, 3));
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, 3));
      const auto time = static_cast<std::uint64_t>(sqlite3_column_int64(row, 2));
      return RecordedMessage{time, {data, size}};
    }
    return std::nullopt;
  }

 private:
  static std::uint64_t SizeOf(const std::string& path) {
    std::error_code none;
    const std::uint64_t size = std::filesystem::file_size(path, none);
    return none ? 0 : size;
  }

  static std::string UriOf(const std::string& path) {
    std::string uri = "file:";
    for (const char c : std::filesystem::absolute(path).string())
      if (c == '%' || c == '?' || c == '#')
        uri += c == '%' ? "%25" : c == '?' ? "%3f" : "%23";
      else
        uri += c;
    return uri;
  }

  /// Requires that `names` are the first columns of the table, because SQLite must read past any
  /// column that lies before the columns to read. Refuses generated columns, because they are
  /// computed when they are read.
  void RequireColumns(const std::string& table, const std::array<const char*, 4>& names) {
    const Statement columns = Prepare("PRAGMA table_xinfo(" + table + ")");
    int result = SQLITE_ROW;
    for (std::size_t i = 0; (result = sqlite3_step(columns.get())) == SQLITE_ROW; ++i) {
      const auto* chars = sqlite3_column_text(columns.get(), 1);
      const std::string name(chars == nullptr ? "" : reinterpret_cast<const char*>(chars));
      if (sqlite3_column_int(columns.get(), 6) != 0)
        Fail("the table " + table + " has the generated column " + name);
      if (i < names.size() ? name != names[i] : sqlite3_stricmp(name.c_str(), "_rowid_") == 0)
        Fail("the table " + table + " is not that of a ROS 2 bag: it has the column " + name);
    }
    if (result != SQLITE_DONE) FailWithItsReason();
  }

  /// The rows of a table in the order of the file, which is the order of recording. The statement
  /// says NOT INDEXED to avoid a sort, which would hold all rows in memory. Its column 0 is the
  /// number of the row, and its column 1 is the size of the row's data in bytes.
  struct Rows {
    Statement statement;
    std::int64_t last_row = INT64_MIN;
    std::uint64_t bytes = 0;
  };

  void ReadTopics() {
    Rows rows;
    rows.statement =
        Prepare("SELECT _rowid_, 0, id, name, type, serialization_format FROM topics NOT INDEXED");
    const auto text = [&](int column) {
      const auto* chars = sqlite3_column_text(rows.statement.get(), column);
      const auto size =
          static_cast<std::size_t>(sqlite3_column_bytes(rows.statement.get(), column));
      if (size > kLongestName) Fail("the name of a topic is too long");
      return chars == nullptr ? "" : std::string(reinterpret_cast<const char*>(chars), size);
    };
    for (std::size_t count = 0; Step(&rows); ++count) {
      if (count == kMostTopics) Fail("too many topics");
      if (text(5) != "cdr") continue;
      topics_.push_back({text(3), text(4)});
      ids_.push_back(sqlite3_column_int64(rows.statement.get(), 2));
    }
  }

  Statement Prepare(const std::string& sql) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK)
      FailWithItsReason();
    return Statement(statement);
  }

  /// Steps to the next row. Returns false at the end. Refuses a damaged file whose pages form a
  /// loop, because its rows have no end.
  bool Step(Rows* rows) {
    sqlite3_stmt* row = rows->statement.get();
    const int result = sqlite3_step(row);
    if (result == SQLITE_DONE) return false;
    if (result != SQLITE_ROW) FailWithItsReason();
    const std::int64_t number = sqlite3_column_int64(row, 0);
    rows->bytes += static_cast<std::uint64_t>(sqlite3_column_int64(row, 1));
    if (number <= rows->last_row || rows->bytes > size_)
      Fail("the file is damaged: its rows repeat");
    rows->last_row = number;
    return true;
  }

  [[noreturn]] void Fail(const std::string& why) const {
    throw std::runtime_error(path_ + ": " + why);
  }
  [[noreturn]] void FailWithItsReason() const {
    std::string advice;
    switch (sqlite3_errcode(database_.get())) {
      case SQLITE_CORRUPT:
        advice = "; save the rest: sqlite3 " + path_ + " .recover | sqlite3 saved.db3";
        break;
      case SQLITE_READONLY:
        advice = "; its last write was interrupted; undo it: sqlite3 " + path_ + " .tables";
        break;
      default:
        break;
    }
    Fail(std::string("cannot be read as a ROS 2 bag: ") + sqlite3_errmsg(database_.get()) + advice);
  }

  std::string path_;
  std::uint64_t size_ = 0;  // size of the file, including the files of an unfinished write
  std::unique_ptr<sqlite3, Closer> database_;
  std::vector<RecordedTopic> topics_;
  std::vector<std::int64_t> ids_;  // id of each topic
  Rows messages_;
};

}  // namespace

std::unique_ptr<MessageReader> OpenBagDatabase(const std::string& path) {
  return std::make_unique<BagDatabase>(path);
}

}  // namespace lidar::tools
