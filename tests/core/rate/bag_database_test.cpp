// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests bags of ROS 2 in SQLite databases as input of lidar-eval.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "src/cdr/messages.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "tests/core/rate/test_clouds.h"
#include "tests/support/files.h"

namespace lidar::tools {
namespace {

using std::chrono::milliseconds;

/// The SQL that rosbag2_storage_sqlite3 uses to create its tables.
constexpr const char* kTables =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
    "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,"
    "timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);";
/// The SQL for tables with the same names, whose columns have no types.
constexpr const char* kAnyTables =
    "CREATE TABLE topics(id,name,type,serialization_format);"
    "CREATE TABLE messages(id,topic_id,timestamp,data);";
constexpr const char* kPointsTopic =
    "INSERT INTO topics VALUES(1,'/points','sensor_msgs/msg/PointCloud2','cdr','');";

std::vector<std::uint8_t> CloudMessage(milliseconds stamp, float x = 1) {
  const std::vector<TestPoint> one = {{x, 2, 3, 4}};
  cdr::PointCloud2 cloud = CloudOf(one, 1);
  cloud.header.stamp = Time{} + stamp;
  return WritePointCloud2(cloud);
}

class BagDatabaseFile : public test::FolderTest {
 protected:
  ~BagDatabaseFile() override { Close(); }

  /// Copies the open bag and the file that SQLite keeps beside it (the name of the bag and `end`),
  /// as a writer leaves them that dies. Closes the bag and sets the path to the copy.
  void LeaveAsADeadWriter(const std::string& end) {
    const std::string copy = folder_ + "/copy";
    std::filesystem::create_directory(copy);
    for (const std::string& file : {std::string(), end})
      std::filesystem::copy(path_ + file, copy + "/drive_0.db3" + file);
    Close();
    path_ = copy + "/drive_0.db3";
  }
  void Open(const std::string& path) {
    ASSERT_EQ(sqlite3_open(path.c_str(), &database_), SQLITE_OK);
    Run("PRAGMA synchronous=OFF");
  }
  void Run(const std::string& sql) {
    char* why = nullptr;
    ASSERT_EQ(sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, &why), SQLITE_OK) << why;
  }
  void Add(int topic, milliseconds time, const std::vector<std::uint8_t>& message) {
    std::ostringstream sql;
    sql << "INSERT INTO messages(topic_id,timestamp,data) VALUES(" << topic << ","
        << Duration(time).count() << ",x'" << std::hex;
    for (const std::uint8_t byte : message) sql << (byte < 16 ? "0" : "") << int{byte};
    Run(sql.str() + "')");
  }
  void Close() {
    sqlite3_close(database_);
    database_ = nullptr;
  }
  /// Writes a bag of `clouds` clouds, ten per second.
  void WriteBag(const std::string& path, int clouds) {
    Open(path);
    Run(std::string("BEGIN;") + kTables + kPointsTopic);
    for (int i = 0; i < clouds; ++i)
      Add(1, milliseconds(100 * i), CloudMessage(milliseconds(100 * i + 1)));
    Run("COMMIT");
    Close();
  }
  std::set<std::string> FilesBeside() const {
    std::set<std::string> names;
    const auto folder = std::filesystem::path(path_).parent_path();
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      names.insert(entry.path().filename().string());
    return names;
  }
  std::string Content() const { return test::ReadFile(path_); }
  void Replace(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
  }
  /// Reads all scans of `source`, and returns the text of the error that this throws, or "".
  static std::string RefusalOf(const std::string& source) {
    try {
      LoadScans(source, {0});
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  }

  std::string path_ = folder_ + "/drive_0.db3";
  sqlite3* database_ = nullptr;
};

TEST_F(BagDatabaseFile, CloudsComeWithTheTimesOfTheirStamps) {
  Open(path_);
  Run(kTables);
  Run("INSERT INTO topics VALUES(1,'/odom','nav_msgs/msg/Odometry','cdr','')");
  Run("INSERT INTO topics VALUES(7,'/points','sensor_msgs/msg/PointCloud2','cdr','')");
  for (const int ms : {5000, 5050, 5100}) {
    Add(1, milliseconds(ms), cdr::WriteOdometry({}));
    Add(7, milliseconds(ms + 9), CloudMessage(milliseconds(ms)));
  }
  Add(7, milliseconds(5150), CloudMessage(milliseconds(0)));
  Close();
  for (const std::string& source : {path_, folder_, folder_ + ",/points"}) {
    const auto scans = OpenScans(source, {});
    EXPECT_DOUBLE_EQ(scans->scans_per_second(), 20);
    for (const int ms : {5000, 5050, 5100, 5150}) {
      const auto scan = scans->Next();
      ASSERT_TRUE(scan) << source << ms;
      EXPECT_EQ(scan->start, Time{} + milliseconds(ms)) << "the last has no stamp";
      EXPECT_EQ(scan->scan.xyz, (std::vector<float>{1, 2, 3}));
    }
    EXPECT_FALSE(scans->Next());
  }
}

TEST_F(BagDatabaseFile, PartsFollowTheirNumbers) {
  for (const int part : {2, 10}) {
    Open(folder_ + "/drive_" + std::to_string(part) + ".db3");
    Run(kTables);
    Run(kPointsTopic);
    Add(1, milliseconds(1), CloudMessage(milliseconds(100 * part), static_cast<float>(part)));
    Close();
  }
  std::ofstream(folder_ + "/metadata.yaml") << "rosbag2_bagfile_information:";
  const auto scans = OpenScans(folder_, {});
  EXPECT_EQ(scans->Next()->scan.xyz[0], 2);
  EXPECT_EQ(scans->Next()->scan.xyz[0], 10);
  EXPECT_FALSE(scans->Next());
  std::ofstream(folder_ + "/drive.mcap") << "";
  EXPECT_NE(RefusalOf(folder_).find("name one"), std::string::npos);
}

TEST_F(BagDatabaseFile, AFolderWithABagAndACloudIsRefusedWithBothNames) {
  WriteBag(path_, 1);
  const std::string cloud = folder_ + "/map.pcd";
  std::ofstream(cloud) << "";
  for (const std::string& source : {folder_, folder_ + ",/points"}) {
    EXPECT_NE(RefusalOf(source).find(path_), std::string::npos) << RefusalOf(source);
    EXPECT_NE(RefusalOf(source).find(cloud), std::string::npos) << RefusalOf(source);
    EXPECT_NE(RefusalOf(source).find("name one"), std::string::npos) << RefusalOf(source);
  }
}

TEST_F(BagDatabaseFile, OneOfSeveralTopicsHasToBeNamed) {
  WriteBag(path_, 1);
  Open(path_);
  Run("INSERT INTO topics VALUES(2,'/rear','sensor_msgs/msg/PointCloud2','cdr','')");
  Run("INSERT INTO topics VALUES(3,'/other','sensor_msgs/msg/PointCloud2','flat','')");
  Add(2, milliseconds(1), CloudMessage(milliseconds(1), 9));
  Close();
  EXPECT_NE(RefusalOf(path_).find("/points, /rear"), std::string::npos) << RefusalOf(path_);
  EXPECT_NE(RefusalOf(path_ + ",/other").find("/other"), std::string::npos);
  EXPECT_EQ(OpenScans(path_ + ",/rear", {})->Next()->scan.xyz[0], 9);
}

TEST_F(BagDatabaseFile, ValuesOfAnotherTypeAreLeftOut) {
  Open(path_);
  Run(kAnyTables);
  Run("INSERT INTO topics VALUES(x'00ff',1,2.5,NULL)");
  Run("INSERT INTO topics VALUES(1,'/points','sensor_msgs/msg/PointCloud2','cdr')");
  for (const char* values : {"1,'noon',x'00'", "1,1,'text'", "1,1,NULL", "1,1,7", "NULL,1,x'00'",
                             "'one',1,x'00'", "1,1,x''", "1,1,x'0001000001'"})
    Run(std::string("INSERT INTO messages VALUES(1,") + values + ")");
  EXPECT_NE(RefusalOf(path_).find("no cloud on /points"), std::string::npos) << RefusalOf(path_);
  Add(1, milliseconds(1), CloudMessage(milliseconds(1)));
  Close();
  EXPECT_EQ(LoadScans(path_, {}).scans.size(), 1U);
}

TEST_F(BagDatabaseFile, MessagesBeyondTheLimitAreLeftOut) {
  Open(path_);
  Run(kTables);
  Run(kPointsTopic);
  Run("PRAGMA journal_mode=OFF");
  Run("INSERT INTO messages VALUES(1,1,1,zeroblob((128<<20)+1))");
  Add(1, milliseconds(1), CloudMessage(milliseconds(1)));
  Close();
  EXPECT_EQ(LoadScans(path_, {}).scans.size(), 1U);
}

TEST_F(BagDatabaseFile, TopicsHaveLimits) {
  Open(path_);
  Run(kAnyTables);
  Run("INSERT INTO topics VALUES(1,printf('/%.2000c','a'),'sensor_msgs/msg/PointCloud2','cdr')");
  EXPECT_NE(RefusalOf(path_).find("too long"), std::string::npos) << RefusalOf(path_);
  Run("UPDATE topics SET name = '/a' || char(0) || name");
  EXPECT_NE(RefusalOf(path_).find("too long"), std::string::npos) << RefusalOf(path_);
  for (const char* format : {"cdr", "flat"}) {
    Run("DELETE FROM topics");
    Run("WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i+1 FROM n LIMIT 10001)"
        "INSERT INTO topics SELECT i,'/a','b','" +
        std::string(format) + "' FROM n");
    EXPECT_NE(RefusalOf(path_).find("too many"), std::string::npos) << RefusalOf(path_);
  }
}

TEST_F(BagDatabaseFile, TextInPlaceOfNumbersIsNotLoaded) {
  Open(path_);
  Run(kAnyTables);
  Run("INSERT INTO topics VALUES(1,'/points','sensor_msgs/msg/PointCloud2','cdr')");
  for (const char* values : {"%,1,1,x'00'", "1,%,1,x'00'", "1,1,%,x'00'", "1,1,1,%"}) {
    std::string row = values;
    row.replace(row.find('%'), 1, "printf('%.20000c','t')");
    Run("DELETE FROM messages");
    Run("INSERT INTO messages VALUES(" + row + ")");
    // Damages the pages of the text, so that an attempt to read the text fails.
    std::string bytes = Content();
    std::size_t pages = 0;
    for (std::size_t at = 0; at < bytes.size(); at += 4096)
      if (bytes.substr(at + 4, 4000) == std::string(4000, 't')) {
        bytes.replace(at, 4, 4, '\xff');
        ++pages;
      }
    ASSERT_GE(pages, 4U);
    const std::string whole = std::exchange(path_, folder_ + "/changed.db3");
    Replace(bytes);
    EXPECT_NE(RefusalOf(path_).find("no cloud on /points"), std::string::npos)
        << values << RefusalOf(path_);
    path_ = whole;
  }
}

TEST_F(BagDatabaseFile, ViewsThatComputeWithoutEndAreRefused) {
  Open(path_);
  Run(kTables);
  Run(kPointsTopic);
  Run("DROP TABLE messages");
  Run("CREATE VIEW messages AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT 1 FROM n) "
      "SELECT i AS id, i AS topic_id, i AS timestamp, zeroblob(9) AS data FROM n");
  Close();
  EXPECT_NE(RefusalOf(path_).find("cannot be read"), std::string::npos) << RefusalOf(path_);
}

TEST_F(BagDatabaseFile, ColumnsThatAreComputedAreRefused) {
  for (const char* kind : {"VIRTUAL", "STORED"}) {
    Open(path_);
    Run(kTables);
    Run(kPointsTopic);
    Run("DROP TABLE messages");
    Run(std::string("CREATE TABLE messages(id,topic_id,timestamp,data AS (zeroblob(9)) ") + kind +
        ")");
    Run("INSERT INTO messages VALUES(1,1,1)");
    Close();
    EXPECT_NE(RefusalOf(path_).find("messages has the generated column data"), std::string::npos)
        << RefusalOf(path_);
    std::filesystem::remove(path_);
  }
  Open(path_);
  Run("CREATE TABLE topics(id,name,type AS ('sensor_msgs/msg/PointCloud2'),"
      "serialization_format AS ('cdr'));"
      "CREATE TABLE messages(id,topic_id,timestamp,data);"
      "INSERT INTO topics VALUES(1,'/points')");
  Add(1, milliseconds(1), CloudMessage(milliseconds(1)));
  Close();
  EXPECT_NE(RefusalOf(path_).find("topics has the generated column type"), std::string::npos)
      << RefusalOf(path_);
}

TEST_F(BagDatabaseFile, OtherColumnsBeforeThoseOfABagAreRefused) {
  for (const char* columns : {"note,id,topic_id,timestamp,data", "id,topic_id,timestamp,note,data",
                              "id,topic_id,timestamp,data,_ROWID_"}) {
    Open(path_);
    Run(kTables);
    Run(kPointsTopic);
    Run("DROP TABLE messages");
    Run(std::string("CREATE TABLE messages(") + columns + ")");
    Close();
    EXPECT_NE(RefusalOf(path_).find("it has the column"), std::string::npos) << RefusalOf(path_);
    std::filesystem::remove(path_);
  }
}

TEST_F(BagDatabaseFile, VirtualTablesAreRefused) {
  Open(path_);
  Run(kTables);
  Run(kPointsTopic);
  Run("DROP TABLE messages");
  Run("CREATE VIRTUAL TABLE messages USING fts5(topic_id,timestamp,data)");
  Close();
  EXPECT_NE(RefusalOf(path_).find("no such module"), std::string::npos) << RefusalOf(path_);
}

/// Each page points to the next one 60 times, which makes 60^16 paths. A reader without a limit
/// would visit each path.
TEST_F(BagDatabaseFile, ASchemaWithoutEndIsRefused) {
  constexpr std::size_t kPage = 512, kPaths = 60, kLevels = 16;
  Open(path_);
  Run("PRAGMA page_size=512");
  Run(kTables);
  Close();
  std::string bytes = Content();
  const auto put = [&bytes](std::size_t at, std::size_t value, int size) {
    for (int shift = 8 * size; (shift -= 8) >= 0; ++at)
      bytes[at] = static_cast<char>(value >> shift);
  };
  ASSERT_EQ(bytes[100], 5) << "the schema's root has children";
  const auto leaf = static_cast<std::size_t>(bytes[111]);
  for (std::size_t level = 0; level < kLevels; ++level) {
    const std::size_t page = bytes.size();
    const std::size_t child = level == 0 ? leaf : page / kPage;
    bytes.append(kPage, '\0');
    put(page, 5, 1);
    put(page + 3, kPaths, 2);
    put(page + 5, kPage - 5 * kPaths, 2);
    put(page + 8, child, 4);
    for (std::size_t path = 0; path < kPaths; ++path) {
      const std::size_t cell = kPage - 5 * (path + 1);
      put(page + 12 + 2 * path, cell, 2);
      put(page + cell, child, 4);
    }
  }
  put(28, bytes.size() / kPage, 4);
  put(108, bytes.size() / kPage, 4);
  Replace(bytes);
  EXPECT_NE(RefusalOf(path_).find("malformed"), std::string::npos) << RefusalOf(path_);
}

TEST_F(BagDatabaseFile, ReadingLeavesNoFilesBesideTheBag) {
  WriteBag(path_, 3);
  Open(path_);
  Run("PRAGMA journal_mode=WAL");
  Close();
  EXPECT_EQ(LoadScans(path_, {}).scans.size(), 3U);
  EXPECT_EQ(FilesBeside(), std::set<std::string>{"drive_0.db3"});
}

TEST_F(BagDatabaseFile, ABagIsReadWhateverItsFolderIsCalled) {
  const std::string folder = folder_ + "/a?mode=rw&a#b%41";
  std::filesystem::create_directory(folder);
  path_ = folder + "/drive_0.db3";
  WriteBag(path_, 3);
  EXPECT_EQ(LoadScans(path_, {}).scans.size(), 3U);
  EXPECT_EQ(FilesBeside(), std::set<std::string>{"drive_0.db3"});
}

TEST_F(BagDatabaseFile, RowsThatADeadWriterLeftInItsLogAreRead) {
  WriteBag(path_, 1);
  Open(path_);
  Run("PRAGMA journal_mode=WAL");
  for (int i = 1; i < 200; ++i)
    Add(1, milliseconds(100 * i), CloudMessage(milliseconds(100 * i + 1)));
  LeaveAsADeadWriter("-wal");
  const std::string before = Content();
  const auto log_size = std::filesystem::file_size(path_ + "-wal");
  ASSERT_GT(log_size, before.size());
  EXPECT_EQ(LoadScans(path_, {0}).scans.size(), 200U);
  EXPECT_EQ(FilesBeside(), (std::set<std::string>{"drive_0.db3", "drive_0.db3-wal"}));
  EXPECT_EQ(Content(), before);
  EXPECT_EQ(std::filesystem::file_size(path_ + "-wal"), log_size);
}

TEST_F(BagDatabaseFile, AWriteThatDidNotEndIsRefusedWithAdvice) {
  WriteBag(path_, 1);
  Open(path_);
  Run("PRAGMA synchronous=FULL;PRAGMA cache_size=1;PRAGMA cache_spill=1;BEGIN");
  for (int i = 1; i < 200; ++i)
    Add(1, milliseconds(100 * i), CloudMessage(milliseconds(100 * i + 1)));
  LeaveAsADeadWriter("-journal");
  EXPECT_NE(RefusalOf(path_).find(".tables"), std::string::npos) << RefusalOf(path_);
}

TEST_F(BagDatabaseFile, PagesThatRepeatAreAnError) {
  WriteBag(path_, 200);
  std::string bytes = Content();
  constexpr std::size_t kPage = 4096;
  constexpr std::size_t kCells = 12;  // the offset of the list of cells in an interior page
  bool changed = false;
  for (std::size_t page = kPage; page + kPage <= bytes.size(); page += kPage) {
    if (bytes[page] != 5) continue;  // The page is no interior page of a table.
    const auto cell = [&](std::size_t i) {
      const auto* at = reinterpret_cast<const std::uint8_t*>(&bytes[page + kCells + 2 * i]);
      return page + std::size_t{256} * at[0] + at[1];
    };
    std::memcpy(&bytes[cell(1)], &bytes[cell(0)], 4);  // Two cells get the same left child.
    changed = true;
  }
  ASSERT_TRUE(changed);
  Replace(bytes);
  EXPECT_NE(RefusalOf(path_).find("rows repeat"), std::string::npos) << RefusalOf(path_);
}

TEST_F(BagDatabaseFile, AFileThatIsCutOffIsAnError) {
  WriteBag(path_, 50);
  const std::string whole = Content();
  for (std::size_t size = 0; size < whole.size(); size += 512) {
    Replace(whole.substr(0, size));
    EXPECT_NE(RefusalOf(path_).find(path_), std::string::npos) << size << ": " << RefusalOf(path_);
  }
  Replace(whole.substr(0, whole.size() / 2));
  EXPECT_NE(RefusalOf(path_).find(".recover"), std::string::npos) << RefusalOf(path_);
}

TEST_F(BagDatabaseFile, ChangedBytesGiveNoMoreCloudsThanTheFileHas) {
  WriteBag(path_, 20);
  const std::string whole = Content();
  for (std::size_t at = 0; at < whole.size(); at += 97) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ (at % 2 == 0 ? 0xFF : 0x01));
    Replace(bytes);
    try {
      EXPECT_LE(LoadScans(path_, {0}).scans.size(), 20U) << at;
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find(path_), std::string::npos) << e.what();
    }
  }
}

TEST_F(BagDatabaseFile, OtherFilesAreRefusedByName) {
  const auto refusal_has = [this](const char* text) {
    const std::string refusal = RefusalOf(path_);
    EXPECT_NE(refusal.find(path_), std::string::npos) << refusal;
    EXPECT_NE(refusal.find(text), std::string::npos) << refusal;
  };
  refusal_has("is not a regular file");
  Replace("SQLite this is not, though it has a name that says so.");
  refusal_has("not a database");
  Replace("");
  refusal_has("no such table");
}

}  // namespace
}  // namespace lidar::tools
