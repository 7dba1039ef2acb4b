#include "server/results/sql_query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <string>
#include <thread>

#include "server/results/result_store.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace {

// A larger allocation of this thread fails.
thread_local size_t largest_allocation_bytes = SIZE_MAX;

}  // namespace

[[gnu::noinline]] void* operator new(size_t size_bytes) {
  void* memory = size_bytes > largest_allocation_bytes ? nullptr : std::malloc(size_bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace vs {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kEndless[] =
    "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT count(*) FROM n";

class SqlQueryTest : public ::testing::Test {
 protected:
  SqlQueryTest() {
    auto store = ResultStore::Open(file_, clock_).value();
    for (int i = 1; i <= 20; ++i) {
      ResultRecord record;
      record.job_id = i % 2 == 0 ? "even" : "odd";
      record.result_class = i == 7 ? ResultRecord::Class::kFail : ResultRecord::Class::kPass;
      record.values = {{"gap_mm", i / 10.0}};
      EXPECT_TRUE(store->Log(record).has_value());
    }
    store.reset();
    query_ = SqlQuery::Open(file_, clock_).value();
  }

  Result<SqlTable> Run(const std::string& sql, const std::vector<SqlValue>& arguments = {},
                       const SqlLimits& limits = {}) {
    return query_->Run(sql, arguments, limits, [] { return false; });
  }

  test::TempFolder folder_;
  const std::filesystem::path file_ = folder_ / "results.db";
  SystemClock clock_;
  std::unique_ptr<SqlQuery> query_;
};

TEST_F(SqlQueryTest, AnswersASelect) {
  const SqlTable table =
      Run("SELECT job_id, count(*) AS n, max(json_extract(fields, '$.gap_mm')) AS worst"
          " FROM result WHERE number <= ?1 GROUP BY job_id ORDER BY job_id",
          {int64_t{11}})
          .value();
  EXPECT_THAT(table.columns, ElementsAre("job_id", "n", "worst"));
  ASSERT_EQ(2u, table.rows.size());
  EXPECT_THAT(table.rows[0], ElementsAre(SqlValue("even"), SqlValue(int64_t{5}), SqlValue(1.0)));
  EXPECT_THAT(table.rows[1], ElementsAre(SqlValue("odd"), SqlValue(int64_t{6}), SqlValue(1.1)));
  EXPECT_FALSE(table.truncated);
}

TEST_F(SqlQueryTest, MeasuredValuesAreRowsOfAView) {
  const SqlTable table = Run("SELECT name, value FROM result_field WHERE number = 3").value();
  ASSERT_EQ(1u, table.rows.size());
  EXPECT_THAT(table.rows[0], ElementsAre(SqlValue("gap_mm"), SqlValue(0.3)));
}

TEST_F(SqlQueryTest, MeasuredValuesAreReachedWithoutTheViewToo) {
  const SqlTable table = Run("SELECT (SELECT value FROM json_each(fields) WHERE key = 'gap_mm')"
                             " FROM result WHERE number = 3")
                             .value();
  EXPECT_THAT(table.rows[0], ElementsAre(SqlValue(0.3)));
}

TEST_F(SqlQueryTest, CarriesEveryTypeOfValue) {
  const SqlTable table = Run("SELECT ?1 AS v, ?2 AS v, ?3, NULL, x'00ff' AS v",
                             {int64_t{-1}, 0.5, std::string("text")})
                             .value();
  EXPECT_THAT(table.columns, ElementsAre("v", "v_2", "?3", "NULL", "v_3"));
  EXPECT_THAT(table.rows.at(0),
              ElementsAre(SqlValue(int64_t{-1}), SqlValue(0.5), SqlValue("text"), SqlValue(),
                          SqlValue(SqlBlob{std::string("\0\xff", 2)})));
}

TEST_F(SqlQueryTest, CommonTableExpressionsWindowsAndAFinalSemicolonAreFine) {
  EXPECT_TRUE(Run("WITH bad AS (SELECT * FROM result WHERE result_class = 'fail')"
                  " SELECT count(*) FROM bad; -- the end ")
                  .has_value());
  EXPECT_TRUE(
      Run("SELECT number, row_number() OVER (ORDER BY number DESC) FROM result").has_value());
  EXPECT_TRUE(Run("SELECT creation_time FROM result").has_value());
}

TEST_F(SqlQueryTest, RowsBeyondTheLimitAreCutOffAndToldSo) {
  const SqlTable cut =
      Run("SELECT number FROM result ORDER BY number", {}, {.max_rows = 5}).value();
  EXPECT_EQ(5u, cut.rows.size());
  EXPECT_TRUE(cut.truncated);
  const SqlTable whole =
      Run("SELECT number FROM result ORDER BY number", {}, {.max_rows = 20}).value();
  EXPECT_EQ(20u, whole.rows.size());
  EXPECT_FALSE(whole.truncated);
}

TEST_F(SqlQueryTest, NothingButASelectIsAccepted) {
  const char* const statements[] = {
      "DELETE FROM result",
      "UPDATE result SET job_id = 'x'",
      "INSERT INTO result (result_id) VALUES ('x')",
      "DROP TABLE result",
      "CREATE TABLE t (a)",
      "CREATE TEMP TABLE t AS SELECT * FROM result",
      "PRAGMA user_version",
      "PRAGMA query_only = OFF",
      "ATTACH '/etc/passwd' AS other",
      "ATTACH ':memory:' AS other",
      "VACUUM INTO '/tmp/stolen.db'",
      "VACUUM",
      "REINDEX",
      "ANALYZE",
      "BEGIN IMMEDIATE",
      "SAVEPOINT s",
      "EXPLAIN DELETE FROM result",
      "SELECT load_extension('libevil.so')",
      "SELECT fts3_tokenizer('simple')",
      "SELECT sqlite_log(1, 'forged')",
      "SELECT * FROM pragma_database_list",
      "SELECT * FROM store",
      "SELECT * FROM dbstat",
      "SELECT * FROM sqlite_stmt",
      "SELECT * FROM json_tree('{}')",
      "SELECT count(*) FROM pragma_database_list",
      "WITH n(i) AS (SELECT epoch FROM store) SELECT i FROM n",
      "SELECT (SELECT max(epoch) FROM store)",
  };
  for (const char* statement : statements) {
    const auto answer = Run(statement);
    ASSERT_FALSE(answer.has_value()) << statement;
    EXPECT_THAT(answer.error().code(), StatusCode::kInvalidArgument)
        << statement << ": " << answer.error().ToString();
    EXPECT_THAT(answer.error().message(), Not(HasSubstr(folder_.path().string())));
  }
  EXPECT_EQ(SqlValue(int64_t{20}), Run("SELECT count(*) FROM result").value().rows[0][0]);
}

TEST_F(SqlQueryTest, TextThatIsNotOneStatementIsRefused) {
  EXPECT_THAT(Run("").error().message(), HasSubstr("empty"));
  EXPECT_THAT(Run(" -- nothing ").error().message(), HasSubstr("empty"));
  EXPECT_THAT(Run("SELECT 1; SELECT 2").error().message(), HasSubstr("one statement"));
  EXPECT_THAT(Run("SELECT 1; DROP TABLE result").error().message(), HasSubstr("one statement"));
  EXPECT_THAT(Run("SELECT nonsense FROM result").error().message(),
              HasSubstr("no such column: nonsense"));
  EXPECT_EQ(StatusCode::kInvalidArgument, Run("SELEC").error().code());
  EXPECT_EQ(StatusCode::kInvalidArgument, Run(std::string("SELECT 1\0", 9)).error().code());
  EXPECT_EQ(StatusCode::kInvalidArgument, Run(std::string(20'000, ' ')).error().code());
  EXPECT_THAT(Run("SELECT ?1").error().message(), HasSubstr("takes 1 arguments, 0 were given"));
}

TEST_F(SqlQueryTest, AnEndlessQueryEndsAtItsTimeout) {
  const auto answer = Run(kEndless, {}, {.timeout = std::chrono::milliseconds(50)});
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(StatusCode::kDeadlineExceeded, answer.error().code());
  EXPECT_TRUE(Run("SELECT 1").has_value());
}

TEST_F(SqlQueryTest, TheTimeoutCountsFromWhenTheQueryArrived) {
  const SqlLimits limits{.timeout = std::chrono::seconds(5),
                         .since_ns = clock_.MonotonicNs() - 5'000'000'000};
  EXPECT_EQ(StatusCode::kDeadlineExceeded, Run("SELECT 1", {}, limits).error().code());
}

TEST_F(SqlQueryTest, AQueryThatRunsOutOfMemoryLeavesTheTurnToTheNext) {
  largest_allocation_bytes = 500'000;
  EXPECT_THROW((void)Run("SELECT hex(zeroblob(400000))"), std::bad_alloc);
  largest_allocation_bytes = SIZE_MAX;
  EXPECT_TRUE(Run("SELECT 1").has_value());
}

TEST_F(SqlQueryTest, AGreedyQueryEndsAtItsMemoryLimit) {
  const auto answer =
      Run("WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT 100000000)"
          " SELECT i, randomblob(1000) AS r FROM n ORDER BY r",
          {}, {.timeout = std::chrono::minutes(5)});
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(StatusCode::kResourceExhausted, answer.error().code()) << answer.error().ToString();
  EXPECT_EQ(StatusCode::kResourceExhausted, Run("SELECT zeroblob(2000000)").error().code());
  EXPECT_EQ(StatusCode::kResourceExhausted,
            Run("SELECT zeroblob(1000000) FROM result").error().code());
}

// Connections go from thread to thread, and with them memory that another one has taken.
TEST_F(SqlQueryTest, AThreadThatGaveBackMoreThanItTookStillAnswers) {
  void* memory = sqlite3_malloc(1'000'000);
  Status answered;
  std::thread([&] {
    sqlite3_free(memory);
    const auto answer = Run("SELECT 1");
    if (!answer.has_value()) answered = answer.error();
  }).join();
  EXPECT_TRUE(answered.ok()) << answered.ToString();
}

TEST_F(SqlQueryTest, ACancelledQueryEndsAndTheOneBehindItGetsItsTurn) {
  std::atomic<bool> running = false;
  std::atomic<bool> cancelled = false;
  Status first;
  std::thread slow([&] {
    const auto answer = query_->Run(kEndless, {}, {.timeout = std::chrono::minutes(5)}, [&] {
      running = true;
      return cancelled.load();
    });
    first = answer.has_value() ? Status() : answer.error();
  });
  EXPECT_TRUE(test::WaitUntil([&] { return running.load(); }));
  // Waits for its turn, in vain.
  const auto waiting = Run("SELECT 1", {}, {.timeout = std::chrono::milliseconds(1)});
  EXPECT_EQ(StatusCode::kDeadlineExceeded, waiting.error().code());
  cancelled = true;
  EXPECT_TRUE(Run("SELECT 1", {}, {.timeout = std::chrono::minutes(5)}).has_value());
  slow.join();
  EXPECT_EQ(StatusCode::kCancelled, first.code());
}

TEST_F(SqlQueryTest, AGreedyQueryIsNotChargedToTheOneBesideIt) {
  const auto both = SqlQuery::Open(file_, clock_, 2).value();
  const SqlLimits limits{.timeout = std::chrono::minutes(5), .max_work_bytes = 8 << 20};
  std::atomic<bool> modest_runs = false;
  std::atomic<bool> greedy_ended = false;
  Status greedy;
  std::thread thread([&] {
    EXPECT_TRUE(test::WaitUntil([&] { return modest_runs.load(); }));
    const auto answer = both->Run(
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT 100000000)"
        " SELECT i, randomblob(1000) AS r FROM n ORDER BY r",
        {}, limits, [] { return false; });
    greedy = answer.has_value() ? Status() : answer.error();
    greedy_ended = true;
  });
  // Looks at its memory as often as the other does, and outlives it.
  const auto modest = both->Run(kEndless, {}, limits, [&] {
    modest_runs = true;
    return greedy_ended.load();
  });
  thread.join();
  EXPECT_EQ(StatusCode::kResourceExhausted, greedy.code()) << greedy.ToString();
  EXPECT_EQ(StatusCode::kCancelled, modest.error().code()) << modest.error().ToString();
}

}  // namespace
}  // namespace vs
