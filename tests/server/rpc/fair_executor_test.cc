#include "server/rpc/fair_executor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/wait_until.h"

namespace vs {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A task that has begun when the constructor returns and ends when the test says so.
class SlowTask {
 public:
  SlowTask(FairExecutor& executor, const std::string& who) {
    EXPECT_TRUE(executor
                    .Post(who,
                          [state = state_] {
                            state->begun.count_down();
                            state->go_on.wait();
                          })
                    .ok());
    state_->begun.wait();
  }
  void End() { state_->go_on.count_down(); }

 private:
  struct State {
    std::latch begun{1};
    std::latch go_on{1};
  };
  const std::shared_ptr<State> state_ = std::make_shared<State>();
};

TEST(FairExecutor, SlowTaskHoldsUpOnlyThoseOfTheSame) {
  std::atomic<bool> annas_ran{false};
  std::atomic<bool> bens_ran{false};
  FairExecutor executor({.threads = 2});
  SlowTask slow(executor, "anna");
  ASSERT_TRUE(executor.Post("anna", [&] { annas_ran = true; }).ok());
  ASSERT_TRUE(executor.Post("ben", [&] { bens_ran = true; }).ok());
  EXPECT_TRUE(test::WaitUntil([&] { return bens_ran.load(); }));
  EXPECT_FALSE(annas_ran);
  slow.End();
  EXPECT_TRUE(test::WaitUntil([&] { return annas_ran.load(); }));
}

TEST(FairExecutor, ThoseWhoWaitTakeTurnsAndEachKeepsHisOrder) {
  std::vector<std::string> order;  // of the only thread
  std::atomic<int> runs{0};
  FairExecutor executor({.threads = 1});
  SlowTask slow(executor, "anna");
  for (const char* task : {"anna 1", "anna 2", "anna 3", "ben 1", "ben 2", "cleo 1"}) {
    const std::string name(task);
    const auto run = [&, name] {
      order.push_back(name);
      ++runs;
    };
    ASSERT_TRUE(executor.Post(name.substr(0, name.find(' ')), run).ok());
  }
  slow.End();
  ASSERT_TRUE(test::WaitUntil([&] { return runs == 6; }));
  // Anna's turn was the slow task.
  EXPECT_THAT(order, ElementsAre("ben 1", "cleo 1", "anna 1", "ben 2", "anna 2", "anna 3"));
}

TEST(FairExecutor, RefusesWhatDoesNotFitInItsQueues) {
  std::atomic<int> runs{0};
  const auto count = [&runs] { ++runs; };
  FairExecutor executor({.threads = 1, .max_waiting = 3, .max_waiting_each = 2});
  SlowTask slow(executor, "anna");
  EXPECT_TRUE(executor.Post("anna", count).ok());
  EXPECT_TRUE(executor.Post("anna", count).ok());
  const Status own = executor.Post("anna", count);
  EXPECT_EQ(own.code(), StatusCode::kResourceExhausted);
  EXPECT_EQ(own.reason(), "OVERLOADED");
  EXPECT_THAT(own.message(), HasSubstr("this login has 2 calls"));
  EXPECT_TRUE(executor.Post("ben", count).ok());
  const Status all = executor.Post("ben", count);
  EXPECT_EQ(all.code(), StatusCode::kResourceExhausted);
  EXPECT_EQ(all.reason(), "OVERLOADED");
  EXPECT_THAT(all.message(), HasSubstr("the server has 3 calls"));
  slow.End();
  executor.Stop();
  EXPECT_EQ(runs, 3);
}

TEST(FairExecutor, LosesNothingWhenItStops) {
  std::atomic<int> runs{0};
  FairExecutor executor({.threads = 2, .max_waiting = 100, .max_waiting_each = 50});
  SlowTask annas(executor, "anna");
  SlowTask bens(executor, "ben");
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(executor.Post(i % 3 == 0   ? "anna"
                              : i % 3 == 1 ? "ben"
                                           : "cleo",
                              [&] { ++runs; })
                    .ok());
  }
  std::jthread stopping([&] { executor.Stop(); });
  EXPECT_TRUE(test::WaitUntil(
      [&] { return executor.Post("dora", [] {}).code() == StatusCode::kUnavailable; }));
  annas.End();
  bens.End();
  stopping.join();
  EXPECT_EQ(runs, 30);
}

TEST(FairExecutor, NeverRunsTwoOfTheSameAtOnce) {
  constexpr int kUsers = 3;
  constexpr int kTasks = 300;
  std::vector<std::atomic<int>> running(kUsers);
  std::vector<int> runs(kUsers, 0);  // guarded by what is being tested
  std::atomic<bool> two_at_once{false};
  {
    FairExecutor executor({.threads = 4, .max_waiting = 10'000, .max_waiting_each = 10'000});
    for (int i = 0; i < kTasks; ++i) {
      const int user = i % kUsers;
      ASSERT_TRUE(executor
                      .Post(std::to_string(user),
                            [&, user] {
                              if (++running[user] > 1) two_at_once = true;
                              ++runs[user];
                              --running[user];
                            })
                      .ok());
    }
  }
  EXPECT_FALSE(two_at_once);
  EXPECT_THAT(runs, ElementsAre(100, 100, 100));
}

}  // namespace
}  // namespace vs
