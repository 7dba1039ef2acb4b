#include "server/storage/sqlite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kFirst = "CREATE TABLE part (id INTEGER PRIMARY KEY, name TEXT UNIQUE)";
constexpr std::string_view kSecond = "ALTER TABLE part ADD COLUMN mass_kg REAL";
constexpr std::string_view kBroken = "CREATE TABLE half (id INTEGER); SELECT nonsense";

class SqliteTest : public ::testing::Test {
 protected:
  static std::string Bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }

  test::TempFolder folder_;
  const std::filesystem::path file_ = folder_ / "store.db";
};

TEST_F(SqliteTest, BoundValuesComeBackUnchanged) {
  const std::string_view migrations[] = {kFirst};
  auto store = OpenStore(file_, migrations);
  ASSERT_TRUE(store.has_value()) << store.error().ToString();
  auto insert = store->Prepare("INSERT INTO part VALUES (?, ?)");
  ASSERT_TRUE(insert.has_value());
  const std::string awkward("Robert'); DROP TABLE part;--\0x", 30);
  insert->Bind(1, int64_t{1});
  insert->Bind(2, awkward);
  ASSERT_TRUE(insert->Run().ok());
  insert->Reset();
  insert->Bind(1, int64_t{2});
  insert->BindNull(2);
  ASSERT_TRUE(insert->Run().ok());

  auto query = store->Prepare("SELECT id, name, id + 0.5 FROM part ORDER BY id");
  ASSERT_TRUE(query.has_value());
  ASSERT_TRUE(query->Step().value());
  EXPECT_EQ(1, query->Integer(0));
  EXPECT_EQ(awkward, query->Text(1));
  EXPECT_DOUBLE_EQ(1.5, query->Number(2));
  ASSERT_TRUE(query->Step().value());
  EXPECT_TRUE(query->IsNull(1));
  EXPECT_FALSE(query->Step().value());
}

TEST_F(SqliteTest, AStoreIsSafeAgainstPowerCuts) {
  auto store = OpenStore(file_, {});
  ASSERT_TRUE(store.has_value());
  auto journal = store->Prepare("PRAGMA journal_mode");
  ASSERT_TRUE(journal->Step().value());
  EXPECT_EQ("wal", journal->Text(0));
  auto synchronous = store->Prepare("PRAGMA synchronous");
  ASSERT_TRUE(synchronous->Step().value());
  EXPECT_EQ(2, synchronous->Integer(0));
}

TEST_F(SqliteTest, AnOlderStoreIsBroughtToTheNewestSchemaAndKeepsItsRows) {
  const std::string_view old_program[] = {kFirst};
  {
    auto store = OpenStore(file_, old_program);
    ASSERT_TRUE(store->Execute("INSERT INTO part VALUES (7, 'flange')").ok());
  }
  const std::string_view new_program[] = {kFirst, kSecond};
  auto store = OpenStore(file_, new_program);
  ASSERT_TRUE(store.has_value()) << store.error().ToString();
  auto query = store->Prepare("SELECT name, mass_kg FROM part WHERE id = 7");
  ASSERT_TRUE(query.has_value()) << query.error().ToString();
  ASSERT_TRUE(query->Step().value());
  EXPECT_EQ("flange", query->Text(0));
  EXPECT_TRUE(query->IsNull(1));
}

TEST_F(SqliteTest, AFailedMigrationLeavesTheStoreAsItWas) {
  const std::string_view good[] = {kFirst};
  ASSERT_TRUE(OpenStore(file_, good).has_value());
  const std::string_view bad[] = {kFirst, kBroken};
  auto store = OpenStore(file_, bad);
  ASSERT_FALSE(store.has_value());
  EXPECT_THAT(store.error().message(), HasSubstr("schema migration to version 2"));
  auto again = OpenStore(file_, good);
  ASSERT_TRUE(again.has_value()) << again.error().ToString();
  EXPECT_FALSE(again->Prepare("SELECT * FROM half").has_value());
}

TEST_F(SqliteTest, AStoreOfANewerProgramIsRefusedAndNotTouched) {
  const std::string_view newer[] = {kFirst, kSecond};
  ASSERT_TRUE(OpenStore(file_, newer).has_value());
  const std::string before = Bytes(file_);
  const std::string_view older[] = {kFirst};
  auto store = OpenStore(file_, older);
  ASSERT_FALSE(store.has_value());
  EXPECT_EQ(StatusCode::kFailedPrecondition, store.error().code());
  EXPECT_THAT(store.error().message(), HasSubstr("schema version 2, this program knows up to 1"));
  EXPECT_EQ(before, Bytes(file_));
}

TEST_F(SqliteTest, AFileThatIsNoDatabaseIsDataLoss) {
  std::ofstream(file_) << std::string(4096, 'x');
  auto store = OpenStore(file_, {});
  ASSERT_FALSE(store.has_value());
  EXPECT_EQ(StatusCode::kDataLoss, store.error().code());
  EXPECT_THAT(store.error().message(), HasSubstr(file_.string()));
}

TEST_F(SqliteTest, ErrorsSayWhatHappened) {
  const std::string_view migrations[] = {kFirst};
  auto store = OpenStore(file_, migrations);
  ASSERT_TRUE(store->Execute("INSERT INTO part VALUES (1, 'a')").ok());
  EXPECT_EQ(StatusCode::kAlreadyExists, store->Execute("INSERT INTO part VALUES (2, 'a')").code());
  EXPECT_EQ(StatusCode::kInvalidArgument, store->Execute("SELEC 1").code());

  store->SetBusyTimeout(std::chrono::milliseconds(0));
  auto other = Database::Open(file_, Database::Access::kReadWrite);
  ASSERT_TRUE(other->Execute("BEGIN EXCLUSIVE").ok());
  EXPECT_EQ(StatusCode::kUnavailable, Transaction::Begin(*store).error().code());
  EXPECT_EQ(StatusCode::kFailedPrecondition,
            Database::Open(folder_ / "none.db", Database::Access::kReadOnly).error().code());
}

TEST_F(SqliteTest, WhatWasNotCommittedIsUndone) {
  const std::string_view migrations[] = {kFirst};
  auto store = OpenStore(file_, migrations);
  {
    auto transaction = Transaction::Begin(*store);
    ASSERT_TRUE(transaction.has_value());
    ASSERT_TRUE(store->Execute("INSERT INTO part VALUES (1, 'a')").ok());
  }
  auto count = store->Prepare("SELECT count(*) FROM part");
  ASSERT_TRUE(count->Step().value());
  EXPECT_EQ(0, count->Integer(0));
}

}  // namespace
}  // namespace vs
