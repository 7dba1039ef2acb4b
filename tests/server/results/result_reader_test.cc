#include "server/results/result_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "server/results/result_csv.h"
#include "server/results/result_store.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using ::testing::ElementsAre;
using Class = ResultRecord::Class;
using State = ResultRecord::State;

// One second more at each look.
class SteppingClock final : public Clock {
 public:
  int64_t MonotonicNs() const override { return 1; }
  int64_t UtcNs() const override { return 1'000'000'000'000 + 1'000'000'000 * step_++; }

 private:
  mutable int64_t step_ = 0;
};

class ResultReaderTest : public ::testing::Test {
 protected:
  // Numbers 1 to 6.
  ResultReaderTest() {
    auto store = ResultStore::Open(file_, clock_).value();
    const struct {
      const char* job;
      const char* part;
      Class result_class;
      State state = State::kCompleted;
    } rows[] = {{"weld", "a", Class::kPass},
                {"weld", "b", Class::kFail, State::kAborted},
                {"glue", "a", Class::kPass},
                {"weld", "a", Class::kFail},
                {"glue", "", Class::kUndefined, State::kFailed},
                {"weld", "c", Class::kPass}};
    for (const auto& row : rows) {
      ResultRecord record;
      record.job_id = row.job;
      record.part_id = row.part;
      record.result_class = row.result_class;
      record.state = row.state;
      ids_.push_back(store->Log(record).value());
    }
    store.reset();
    reader_ = ResultReader::Open(file_).value();
  }

  static std::vector<uint64_t> Numbers(const Result<ResultPage>& page) {
    std::vector<uint64_t> numbers;
    for (const StoredResult& result : page.value().results) numbers.push_back(result.number);
    return numbers;
  }

  test::TempFolder folder_;
  const std::filesystem::path file_ = folder_ / "results.db";
  SteppingClock clock_;
  std::vector<std::string> ids_;
  std::unique_ptr<ResultReader> reader_;
};

TEST_F(ResultReaderTest, PagesFollowEachOtherNewestFirst) {
  EXPECT_THAT(Numbers(reader_->Before({}, std::nullopt, 4)), ElementsAre(6, 5, 4, 3));
  EXPECT_THAT(Numbers(reader_->Before({}, 3, 4)), ElementsAre(2, 1));
  EXPECT_THAT(Numbers(reader_->Before({}, 1, 4)), ElementsAre());
}

TEST_F(ResultReaderTest, OldestFirstStopsAtTheLastNumber) {
  EXPECT_THAT(Numbers(reader_->After({}, 2, 5, 100)), ElementsAre(3, 4, 5));
  EXPECT_THAT(Numbers(reader_->After({}, 2, 5, 2)), ElementsAre(3, 4));
}

TEST_F(ResultReaderTest, AllConditionsOfAFilterHoldAtOnce) {
  EXPECT_THAT(Numbers(reader_->After({.job_id = "weld"}, 0, 9, 9)), ElementsAre(1, 2, 4, 6));
  EXPECT_THAT(Numbers(reader_->After({.part_id = "a"}, 0, 9, 9)), ElementsAre(1, 3, 4));
  EXPECT_THAT(Numbers(reader_->After({.result_class = Class::kFail}, 0, 9, 9)), ElementsAre(2, 4));
  EXPECT_THAT(Numbers(reader_->After({.result_class = Class::kUndefined}, 0, 9, 9)),
              ElementsAre(5));
  EXPECT_THAT(Numbers(reader_->After(
                  {.job_id = "weld", .part_id = "a", .result_class = Class::kFail}, 0, 9, 9)),
              ElementsAre(4));
  EXPECT_THAT(Numbers(reader_->After({.result_state = State::kFailed}, 0, 9, 9)), ElementsAre(5));
  EXPECT_THAT(Numbers(reader_->After(
                  {.result_class = Class::kFail, .result_state = State::kCompleted}, 0, 9, 9)),
              ElementsAre(4));
  // Number 2 was created at 1001 s, number 4 at 1003 s.
  EXPECT_THAT(Numbers(reader_->After({.from_ns = 1'001'000'000'000, .until_ns = 1'003'000'000'000},
                                     0, 9, 9)),
              ElementsAre(2, 3));
  EXPECT_THAT(Numbers(reader_->After({.job_id = "' OR 1 = 1 --"}, 0, 9, 9)), ElementsAre());
}

TEST_F(ResultReaderTest, APageTellsWhetherThereAreMore) {
  EXPECT_TRUE(reader_->Before({}, std::nullopt, 5)->more);
  EXPECT_FALSE(reader_->Before({}, std::nullopt, 6)->more);
  EXPECT_FALSE(reader_->After({}, 3, 5, 2)->more);
}

TEST_F(ResultReaderTest, APageEndsEarlyWhenResultsAreLarge) {
  {
    auto store = ResultStore::Open(file_, clock_).value();
    for (int i = 0; i < 50; ++i) {
      ResultRecord record;
      record.job_id = "large";
      record.values = {{"text", std::string(60'000, 'x')}};
      ASSERT_TRUE(store->Log(record).has_value());
    }
  }
  uint64_t after = 0;
  size_t results = 0;
  int pages = 0;
  for (bool more = true; more; ++pages) {
    const ResultPage page = reader_->After({.job_id = "large"}, after, 1000, 1000).value();
    EXPECT_LE(page.results.size(), 35u);  // 35 x 60,000 bytes are 2.1 MB
    results += page.results.size();
    after = page.results.back().number;
    more = page.more;
  }
  EXPECT_EQ(50u, results);
  EXPECT_EQ(2, pages);
}

TEST_F(ResultReaderTest, OneResultIsFoundByItsId) {
  EXPECT_EQ(4u, reader_->Get(ids_[3]).value().number);
  EXPECT_EQ(StatusCode::kNotFound, reader_->Get("nobody").error().code());
}

TEST(ResultCsv, QuotesWhatNeedsQuotes) {
  EXPECT_EQ("plain text", CsvField("plain text"));
  EXPECT_EQ("\"a,b\"", CsvField("a,b"));
  EXPECT_EQ("\"say \"\"no\"\"\"", CsvField("say \"no\""));
  EXPECT_EQ("\"two\r\nlines\"", CsvField("two\r\nlines"));
}

TEST(ResultCsv, ARowHasTheColumnsOfTheHeader) {
  StoredResult result;
  result.number = 7;
  result.result_id = "017f22e2-79b0-7000-8000-000000000000";
  result.creation_time_ns = 1'645'557'742'123'456'789;
  result.record.job_id = "weld, left";
  result.record.sequence_revision = 3;
  result.record.parameter_hash = 0xab;
  result.record.frame_number = 12;
  result.record.processing_ns = 45'500'000;
  result.record.result_class = Class::kPass;
  result.record.values = {{"gap_mm", 0.1}, {"ok", true}};
  const ResultCsv csv({"gap_mm", "holes", "ok"});
  EXPECT_EQ(
      "number,result_id,job_id,part_id,meas_id,sequence_revision,parameter_hash,frame_number,"
      "creation_time,acquisition_time,processing_ms,result_state,result_class,reason,gap_mm,holes,"
      "ok\r\n",
      csv.Header());
  EXPECT_EQ(
      "7,017f22e2-79b0-7000-8000-000000000000,\"weld, left\",,,3,00000000000000ab,12,"
      "2022-02-22T19:22:22.123456Z,,45.500,completed,pass,,0.1,,true\r\n",
      csv.Row(result));
}

}  // namespace
}  // namespace vs
