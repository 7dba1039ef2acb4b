#include "server/results/result_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <string>

#include "server/results/result_reader.h"
#include "server/results/result_schema.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

using ::testing::HasSubstr;

class FixedClock final : public Clock {
 public:
  int64_t MonotonicNs() const override { return 5'000'000'000; }
  int64_t UtcNs() const override { return 1'700'000'000'000'000'000; }
};

ResultRecord Record(const std::string& part) {
  ResultRecord record;
  record.job_id = "inspect";
  record.part_id = part;
  return record;
}

class ResultStoreTest : public ::testing::Test {
 protected:
  std::unique_ptr<ResultStore> Open(ResultStoreOptions options = {}) {
    options.retry_interval = std::chrono::milliseconds(10);
    auto store = ResultStore::Open(file_, clock_, options);
    EXPECT_TRUE(store.has_value()) << store.error().ToString();
    return store.has_value() ? std::move(*store) : nullptr;
  }

  std::vector<StoredResult> ReadAll() {
    auto reader = ResultReader::Open(file_);
    EXPECT_TRUE(reader.has_value()) << reader.error().ToString();
    std::vector<StoredResult> all;
    ResultPage page{.more = true};
    while (page.more) {
      const uint64_t after = all.empty() ? 0 : all.back().number;
      page = (*reader)->After({}, after, INT64_MAX, 1000).value();
      all.insert(all.end(), page.results.begin(), page.results.end());
    }
    return all;
  }

  test::TempFolder folder_;
  const std::filesystem::path file_ = folder_ / "results.db";
  FixedClock clock_;
};

TEST_F(ResultStoreTest, EveryPartOfAResultIsKept) {
  ResultRecord record;
  record.job_id = "inspect";
  record.part_id = "P-0042";
  record.meas_id = "left hand";
  record.sequence_revision = 17;
  record.parameter_hash = 0xfedcba9876543210;
  record.frame_number = 1234567;
  record.capture_ns = 4'900'000'000;  // 0.1 s before now
  record.processing_ns = 45'500'000;
  record.state = ResultRecord::State::kFailed;
  record.result_class = ResultRecord::Class::kFail;
  record.reason = "gap is 2.5 mm, 2.0 mm are allowed";
  record.values = {{"gap_mm", 2.5},
                   {"holes", int64_t{3}},
                   {"code", std::string("\"Ä\",7")},
                   {"sealed", false},
                   {"tenth", 0.1}};
  auto store = Open();
  const std::string id = store->Log(record).value();
  store.reset();

  const std::vector<StoredResult> kept = ReadAll();
  ASSERT_EQ(1u, kept.size());
  EXPECT_EQ(1u, kept[0].number);
  EXPECT_EQ(id, kept[0].result_id);
  EXPECT_EQ(1'700'000'000'000'000'000, kept[0].creation_time_ns);
  EXPECT_EQ(1'699'999'999'900'000'000, kept[0].acquisition_time_ns);
  const ResultRecord& back = kept[0].record;
  EXPECT_EQ("inspect", back.job_id);
  EXPECT_EQ("P-0042", back.part_id);
  EXPECT_EQ("left hand", back.meas_id);
  EXPECT_EQ(17u, back.sequence_revision);
  EXPECT_EQ(0xfedcba9876543210, back.parameter_hash);
  EXPECT_EQ(1234567u, back.frame_number);
  EXPECT_EQ(45'500'000, back.processing_ns);
  EXPECT_EQ(ResultRecord::State::kFailed, back.state);
  EXPECT_EQ(ResultRecord::Class::kFail, back.result_class);
  EXPECT_EQ("gap is 2.5 mm, 2.0 mm are allowed", back.reason);
  EXPECT_EQ(record.values, back.values);
}

TEST_F(ResultStoreTest, AResultIsOnTheDiskWhenItIsAnnounced) {
  auto store = Open();
  auto reader = ResultReader::Open(file_).value();
  std::atomic<uint64_t> announced = 0;
  std::atomic<bool> readable = true;
  auto handle = store->OnCommitted([&](uint64_t last) {
    const auto newest = reader->Before({}, std::nullopt, 1).value().results;
    if (newest.empty() || newest[0].number != last) readable = false;
    announced = last;
  });
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(store->Log(Record("p")).has_value());
  ASSERT_TRUE(test::WaitUntil([&] { return announced == 500; }));
  EXPECT_TRUE(readable);
  EXPECT_EQ(500u, store->State().committed);
  EXPECT_EQ(0u, store->State().queued);
}

TEST_F(ResultStoreTest, ADroppedHandleHearsNothingMore) {
  auto store = Open();
  std::atomic<int> calls = 0;
  auto handle = store->OnCommitted([&](uint64_t) { ++calls; });
  handle.reset();
  ASSERT_TRUE(store->Log(Record("p")).has_value());
  ASSERT_TRUE(test::WaitUntil([&] { return store->State().committed == 1; }));
  store.reset();
  EXPECT_EQ(0, calls);
}

TEST_F(ResultStoreTest, NumbersGoOnAndTheEpochStaysWhenTheStoreIsOpenedAgain) {
  auto store = Open();
  const std::string epoch = store->epoch();
  EXPECT_EQ(36u, epoch.size());
  ASSERT_TRUE(store->Log(Record("a")).has_value());
  store = nullptr;
  store = Open();
  EXPECT_EQ(epoch, store->epoch());
  EXPECT_EQ(1u, store->State().last_number);
  ASSERT_TRUE(store->Log(Record("b")).has_value());
  store = nullptr;
  const auto kept = ReadAll();
  ASSERT_EQ(2u, kept.size());
  EXPECT_EQ(2u, kept[1].number);
}

TEST_F(ResultStoreTest, ALockedFileQueuesAndNothingIsLost) {
  auto store = Open({.queue_rows = 50});
  auto other = Database::Open(file_, Database::Access::kReadWrite);
  ASSERT_TRUE(other->Execute("BEGIN EXCLUSIVE").ok());
  std::set<std::string> accepted;
  for (int i = 0; i < 50; ++i) accepted.insert(store->Log(Record("p")).value());
  ASSERT_TRUE(test::WaitUntil([&] { return !store->State().fault.ok(); }));
  EXPECT_EQ(StatusCode::kUnavailable, store->State().fault.code());

  const auto refused = store->Log(Record("one too many"));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(StatusCode::kResourceExhausted, refused.error().code());
  EXPECT_THAT(refused.error().message(), HasSubstr("50 results wait for the disk"));
  EXPECT_THAT(refused.error().message(), HasSubstr("locked"));
  EXPECT_EQ(1u, store->State().refused);

  ASSERT_TRUE(other->Execute("ROLLBACK").ok());
  ASSERT_TRUE(test::WaitUntil([&] { return store->State().committed == 50; }));
  EXPECT_TRUE(store->State().fault.ok());
  std::set<std::string> kept;
  for (const StoredResult& result : ReadAll()) kept.insert(result.result_id);
  EXPECT_EQ(accepted, kept);
}

TEST_F(ResultStoreTest, WithTooLittleFreeSpaceItSaysSo) {
  auto store = Open({.min_free_bytes = uint64_t{1} << 60, .close_timeout = {}});
  ASSERT_TRUE(store->Log(Record("p")).has_value());
  ASSERT_TRUE(test::WaitUntil([&] { return !store->State().fault.ok(); }));
  EXPECT_EQ(StatusCode::kResourceExhausted, store->State().fault.code());
  EXPECT_THAT(store->State().fault.message(), HasSubstr("make room"));
  EXPECT_EQ(1u, store->State().queued);
}

TEST_F(ResultStoreTest, AFullDiskQueuesAndWritingGoesOnWhenThereIsRoom) {
  // A file system of 2 MB that only this test sees.
  if (unshare(CLONE_NEWNS) != 0 ||
      mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, "size=2m") != 0) {
    GTEST_SKIP() << "cannot mount a small file system of its own (" << std::strerror(errno)
                 << "); run this test as root";
  }
  {
    auto store = Open({.min_free_bytes = 0});
    ASSERT_TRUE(store->Log(Record("first")).has_value());
    ASSERT_TRUE(test::WaitUntil([&] { return store->State().committed == 1; }));
    const auto ballast = folder_ / "ballast";
    {
      std::ofstream fill(ballast, std::ios::binary);
      const std::string block(4096, 'x');
      while (fill.write(block.data(), static_cast<std::streamsize>(block.size())).flush()) {
      }
    }
    ResultRecord large = Record("second");
    large.values["text"] = std::string(60'000, 't');
    ASSERT_TRUE(store->Log(large).has_value());
    ASSERT_TRUE(test::WaitUntil([&] { return !store->State().fault.ok(); }));
    EXPECT_EQ(StatusCode::kResourceExhausted, store->State().fault.code())
        << store->State().fault.ToString();
    EXPECT_EQ(1u, store->State().queued);
    std::filesystem::remove(ballast);
    ASSERT_TRUE(test::WaitUntil([&] { return store->State().committed == 2; }));
    EXPECT_TRUE(store->State().fault.ok());
    EXPECT_EQ(2u, ReadAll().size());
  }
  umount2(folder_.path().c_str(), MNT_DETACH);
}

TEST_F(ResultStoreTest, ClosingWritesWhatIsQueued) {
  auto store = Open({.commit_interval = std::chrono::seconds(60)});
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(store->Log(Record("p")).has_value());
  store = nullptr;
  EXPECT_EQ(100u, ReadAll().size());
}

TEST_F(ResultStoreTest, ClosingGivesUpWhenItsTimeHasPassed) {
  // Patience for hours when it goes: only Close can end this test.
  auto store = Open({.min_free_bytes = uint64_t{1} << 60, .close_timeout = std::chrono::hours(9)});
  ASSERT_TRUE(store->Log(Record("lost")).has_value());
  store->Close(std::chrono::milliseconds(1));
  EXPECT_EQ(1u, store->State().queued);
  EXPECT_EQ(StatusCode::kResourceExhausted, store->Log(Record("late")).error().code());
  store.reset();
  EXPECT_TRUE(ReadAll().empty());
}

TEST_F(ResultStoreTest, AResultThatCannotBeKeptIsRefusedWithTheReason) {
  auto store = Open();
  EXPECT_EQ(StatusCode::kInvalidArgument, store->Log(ResultRecord()).error().code());
  EXPECT_THAT(store->Log(Record(std::string(257, 'x'))).error().message(), HasSubstr("part id"));
  ResultRecord large = Record("p");
  large.values["text"] = std::string(65'537, 'x');
  EXPECT_THAT(store->Log(large).error().message(), HasSubstr("at most 65536 are kept"));
}

TEST_F(ResultStoreTest, WhatJsonCannotSayIsLeftOut) {
  auto store = Open();
  ResultRecord record = Record("p");
  record.values = {{"nan", std::nan("")}, {"text", std::string("\xff\xfe")}, {"one", 1.0}};
  ASSERT_TRUE(store->Log(record).has_value());
  store = nullptr;
  const auto kept = ReadAll();
  ASSERT_EQ(1u, kept.size());
  EXPECT_FALSE(kept[0].record.values.contains("nan"));
  EXPECT_EQ(ParamValue(1.0), kept[0].record.values.at("one"));
  EXPECT_EQ(ParamValue("\ufffd\ufffd"), kept[0].record.values.at("text"));
}

TEST_F(ResultStoreTest, AFileOfANewerProgramIsRefused) {
  Open();
  {
    auto database = Database::Open(file_, Database::Access::kReadWrite);
    ASSERT_TRUE(database->Execute("PRAGMA user_version = 99").ok());
  }
  const auto store = ResultStore::Open(file_, clock_);
  ASSERT_FALSE(store.has_value());
  EXPECT_EQ(StatusCode::kFailedPrecondition, store.error().code());
  EXPECT_THAT(store.error().message(), HasSubstr("schema version 99"));
}

TEST_F(ResultStoreTest, ADamagedFileIsPutAsideAndLoggingGoesOn) {
  std::ofstream(file_) << std::string(8192, 'x');
  auto store = Open();
  ASSERT_TRUE(store->Log(Record("p")).has_value());
  store = nullptr;
  EXPECT_EQ(1u, ReadAll().size());
  EXPECT_EQ(8192u, std::filesystem::file_size(file_.string() + ".damaged-1"));
}

}  // namespace
}  // namespace vs
