#include "client/result_stream.h"

#include <gtest/gtest.h>

#include "client/client.h"
#include "tests/client/fake_server.h"
#include "tests/support/child_process.h"

namespace vs::client {
namespace {

using ::vs::test::FakeResults;
using ::vs::test::FakeServer;
using ::vs::test::kPatience;

class ResultStreamTest : public testing::Test {
 protected:
  ResultStreamTest() {
    auto client = Client::Connect({.address = server_.Address(), .plaintext = true});
    EXPECT_TRUE(client) << client.error().ToString();
    client_ = std::move(*client);
  }

  FakeResults& results() { return server_.results(); }
  void ExpectNumbers(ResultStream& stream, uint64_t first, uint64_t last) {
    for (uint64_t number = first; number <= last; ++number) {
      const auto result = stream.Next(kPatience);
      ASSERT_TRUE(result) << result.error().ToString();
      ASSERT_EQ(number, result->number());
    }
  }

  FakeServer server_;
  std::unique_ptr<Client> client_;
};

TEST_F(ResultStreamTest, GivesEveryResultInOrderHoweverSlowTheCaller) {
  results().Store(2000);
  ResultStream stream = client_->WatchResults({}, 5);
  ExpectNumbers(stream, 6, 2000);
}

TEST_F(ResultStreamTest, BeginsWithTheNextResultUnlessToldOtherwise) {
  results().Store(7);
  ResultStream stream = client_->WatchResults();
  ASSERT_TRUE(results().WaitForStreams(1));
  results().Store(2);
  ExpectNumbers(stream, 8, 9);
}

TEST_F(ResultStreamTest, MissesNothingWhenTheConnectionBreaks) {
  ResultStream stream = client_->WatchResults();
  ASSERT_TRUE(results().WaitForStreams(1));
  results().Cut();
  results().Store(3);
  ExpectNumbers(stream, 1, 3);
  results().Cut();
  results().Store(300);
  ExpectNumbers(stream, 4, 303);
}

TEST_F(ResultStreamTest, GoesOnWithTheFirstResultOfAServerThatBeganAnew) {
  results().Store(50);
  ResultStream stream = client_->WatchResults({}, 48);
  ExpectNumbers(stream, 49, 50);
  results().BeginAnew();
  results().Store(3);
  ExpectNumbers(stream, 1, 3);
}

TEST_F(ResultStreamTest, EndsWhileItAsksWhereToBegin) {
  results().StopListing();
  // The call's own time limit is no help.
  auto client = Client::Connect(
      {.address = server_.Address(), .plaintext = true, .call_timeout = std::chrono::hours(1)});
  ASSERT_TRUE(client);
  const ResultStream stream = (*client)->WatchResults();
  ASSERT_TRUE(results().WaitForLists(1));
}

TEST_F(ResultStreamTest, EndsWithAFullQueue) {
  results().Store(1000);
  ResultStream stream = client_->WatchResults({}, 0);
  ExpectNumbers(stream, 1, 1);
}

}  // namespace
}  // namespace vs::client
