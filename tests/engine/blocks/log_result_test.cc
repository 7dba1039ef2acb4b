#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "engine/core/result_sink.h"
#include "tests/support/block_harness.h"

namespace vs {
namespace {

using test::BlockHarness;
using Values = std::map<std::string, ParamValue>;

class Sink final : public ResultSink {
 public:
  Result<std::string> Log(ResultRecord record) override {
    if (full) return ResourceExhausted("the store cannot keep up");
    records.push_back(std::move(record));
    return "id" + std::to_string(records.size());
  }

  bool full = false;
  std::vector<ResultRecord> records;
};

class LogResult : public ::testing::Test {
 protected:
  LogResult() { block_.environment.results = &sink_; }

  Sink sink_;
  BlockHarness block_{"LogResult"};
};

TEST_F(LogResult, StoresValuesUnderTheirNamesWithTheFrame) {
  block_.Input("a", 0.25);
  block_.Input("b", int64_t{3});
  block_.Input("h", std::string("blue"));
  block_.Input("pass", true);
  block_.Input("part_id", std::string("P-17"));
  ASSERT_TRUE(block_.Set("name_a", std::string("plane_rms_mm")).ok());
  ASSERT_TRUE(block_.Start().ok());
  block_.frame.capture_ns = 5000;
  block_.frame.popped_ns = 1;
  block_.frame.parameter_hash = 99;
  ASSERT_TRUE(block_.Run().ok());
  ASSERT_EQ(sink_.records.size(), 1u);
  const ResultRecord& record = sink_.records[0];
  EXPECT_EQ(record.job_id, "test_sequence");
  EXPECT_EQ(record.sequence_revision, 1u);
  EXPECT_EQ(record.frame_number, 1u);
  EXPECT_EQ(record.capture_ns, 5000);
  EXPECT_GT(record.processing_ns, 0);
  EXPECT_EQ(record.parameter_hash, 99u);
  EXPECT_EQ(record.part_id, "P-17");
  EXPECT_EQ(record.values,
            (Values{{"plane_rms_mm", 0.25}, {"b", int64_t{3}}, {"h", std::string("blue")}}));
  EXPECT_EQ(record.result_class, ResultRecord::Class::kPass);
  EXPECT_EQ(record.state, ResultRecord::State::kCompleted);
  EXPECT_EQ(*block_.Output<std::string>("result_id"), "id1");
}

TEST_F(LogResult, AlsoStoresThatAMeasurementFailed) {
  block_.Input("a", 0.25);
  block_.block().FindInput("b")->Connect("number");
  block_.block().FindInput("pass")->Connect("bool");
  ASSERT_TRUE(block_.Set("name_b", std::string("gap_mm")).ok());
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(sink_.records[0].state, ResultRecord::State::kFailed);
  EXPECT_EQ(sink_.records[0].reason, "no value of gap_mm, pass");
  EXPECT_EQ(sink_.records[0].result_class, ResultRecord::Class::kUndefined);
  EXPECT_EQ(sink_.records[0].values, (Values{{"a", 0.25}}));
}

TEST_F(LogResult, NamesThePictureOfAFrameThatHasOne) {
  block_.Input("a", 0.25);
  block_.block().FindInput("picture")->Connect("string");
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(sink_.records[0].values, (Values{{"a", 0.25}}));
  EXPECT_EQ(sink_.records[0].state, ResultRecord::State::kCompleted);
  block_.Input("picture", std::string("images/1.png"));
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(sink_.records[1].values,
            (Values{{"a", 0.25}, {"picture", std::string("images/1.png")}}));
  ASSERT_TRUE(block_.Set("name_a", std::string("picture")).ok());
  EXPECT_EQ(block_.Start(), InvalidArgument("two values are called picture: rename one"));
}

TEST_F(LogResult, TakesTheVerdictInWordsBeforeYesAndNo) {
  block_.Input("pass", true);
  block_.Input("result_class", std::string("warn"));
  ASSERT_TRUE(block_.Start().ok());
  ASSERT_TRUE(block_.Run().ok());
  EXPECT_EQ(sink_.records[0].result_class, ResultRecord::Class::kWarn);
  block_.Input("result_class", std::string("perhaps"));
  EXPECT_EQ(block_.Run().code(), StatusCode::kInvalidArgument);
}

TEST_F(LogResult, SaysWhenNothingWasStored) {
  block_.Input("pass", false);
  ASSERT_TRUE(block_.Start().ok());
  sink_.full = true;
  EXPECT_EQ(block_.Run(), ResourceExhausted("the store cannot keep up"));
  EXPECT_TRUE(block_.Output("result_id").empty());
}

TEST_F(LogResult, RefusesNamesThatCannotBeColumns) {
  block_.Input("a", 1.0);
  block_.Input("b", 2.0);
  ASSERT_TRUE(block_.Set("name_b", std::string("a")).ok());
  EXPECT_EQ(block_.Start(), InvalidArgument("two values are called a: rename one"));
  EXPECT_EQ(block_.Set("name_b", std::string("drop table")).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(block_.Set("name_b", std::string()).code(), StatusCode::kInvalidArgument);
}

TEST_F(LogResult, RefusesValuesThatAreNoMeasurement) {
  block_.Input("a", std::make_shared<const GreyImage>());
  EXPECT_EQ(block_.Start(),
            InvalidArgument("a must be a bool, integer, number or string, not grey_image"));
  block_.block().FindInput("a")->Connect("any");
  ASSERT_TRUE(block_.Start().ok());
  EXPECT_EQ(block_.Run().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace vs
