#include "client/latest_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/client.h"
#include "tests/client/fake_server.h"
#include "tests/support/child_process.h"

namespace vs::client {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::vs::test::FakeServer;
using ::vs::test::FakeStreams;
using ::vs::test::kPatience;

class LatestStreamTest : public testing::Test {
 protected:
  LatestStreamTest() : server_(std::make_unique<FakeServer>()) {
    auto client = Client::Connect(
        {.address = server_->Address(), .plaintext = true, .credential = "key-of-a-robot"});
    EXPECT_TRUE(client) << client.error().ToString();
    client_ = std::move(*client);
  }

  FakeStreams& streams() { return server_->streams(); }
  LatestStream Open(const StreamOptions& options = {}) {
    return client_->OpenStream("sequence/depth", options);
  }

  std::unique_ptr<FakeServer> server_;
  std::unique_ptr<Client> client_;
};

TEST_F(LatestStreamTest, GivesEachItemOnce) {
  LatestStream stream = Open();
  for (uint64_t seq = 1; seq <= 10; ++seq) {
    streams().Publish();
    const auto item = stream.Next(kPatience);
    ASSERT_TRUE(item) << item.error().ToString();
    EXPECT_EQ(seq, item->seq());
    EXPECT_EQ(0U, item->dropped());
  }
  EXPECT_EQ(10U, stream.stats().items);
  EXPECT_EQ(Code::kDeadlineExceeded, stream.Next(milliseconds(1)).error().code);
}

TEST_F(LatestStreamTest, CarriesTheCredential) {
  LatestStream stream = Open();
  ASSERT_TRUE(streams().WaitForStreams(1));
  EXPECT_EQ("Bearer key-of-a-robot", streams().last_credential());
}

TEST_F(LatestStreamTest, GivesASlowCallerTheNewestItemAndCountsTheOthers) {
  LatestStream stream = Open();
  ASSERT_TRUE(streams().WaitForStreams(1));
  for (uint64_t seq = 1; seq <= 100; ++seq) {
    streams().Publish();
    ASSERT_TRUE(streams().WaitForAcknowledged(seq));
  }
  const auto item = stream.Next(kPatience);
  ASSERT_TRUE(item) << item.error().ToString();
  EXPECT_EQ(100U, item->seq());
  EXPECT_EQ(99U, item->dropped());
  EXPECT_EQ(99U, stream.stats().skipped);
}

TEST_F(LatestStreamTest, LeavesItemsAtTheServerWhileNobodyReads) {
  LatestStream stream = Open({.window = 2, .pause_while_unread = true});
  ASSERT_TRUE(streams().WaitForStreams(1));
  for (int i = 0; i < 100; ++i) streams().Publish();
  const auto first = stream.Next(kPatience);
  ASSERT_TRUE(first) << first.error().ToString();
  streams().Publish();
  uint64_t seq = first->seq();
  uint64_t seen = 1;
  uint64_t dropped = first->dropped();
  while (seq < 101) {
    const auto item = stream.Next(kPatience);
    ASSERT_TRUE(item) << item.error().ToString();
    seq = item->seq();
    dropped += item->dropped();
    ++seen;
  }
  // The first item that the server sends has dropped nothing, whichever it is.
  EXPECT_LE(streams().sent(), seen + stream.stats().skipped);
  EXPECT_LE(streams().sent(), 6U);
  EXPECT_LE(seen + dropped, 101U);
}

TEST_F(LatestStreamTest, GoesOnAfterTheStreamBroke) {
  LatestStream stream = Open();
  streams().Publish();
  ASSERT_TRUE(stream.Next(kPatience));
  streams().Cut({grpc::UNAVAILABLE, "broken"});
  ASSERT_TRUE(streams().WaitForStreams(2));
  streams().Publish();
  auto item = stream.Next(kPatience);
  ASSERT_TRUE(item) << item.error().ToString();
  while (item->seq() < 2) {
    item = stream.Next(kPatience);
    ASSERT_TRUE(item) << item.error().ToString();
  }
  EXPECT_TRUE(streams().WaitForAcknowledged(2));
  EXPECT_EQ(1U, stream.stats().reconnects);
}

TEST_F(LatestStreamTest, GoesOnAfterTheServerRestarted) {
  LatestStream stream = Open();
  streams().Publish();
  ASSERT_TRUE(stream.Next(kPatience));
  const int port = server_->port();
  server_.reset();
  const auto none = stream.Next(milliseconds(300));
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("trying again"));
  server_ = std::make_unique<FakeServer>(nullptr, port);
  streams().Publish();
  const auto item = stream.Next(kPatience);
  ASSERT_TRUE(item) << item.error().ToString();
  EXPECT_EQ(1U, item->seq());
}

TEST_F(LatestStreamTest, TellsARefusalAtOnceAndEveryTime) {
  streams().Cut({grpc::UNAUTHENTICATED, "log in first"}, /*stay=*/true);
  LatestStream stream = Open();
  for (int i = 0; i < 2; ++i) {
    const auto item = stream.Next(kPatience);
    ASSERT_FALSE(item);
    EXPECT_EQ(Code::kUnauthenticated, item.error().code);
    EXPECT_EQ("log in first", item.error().message);
  }
}

TEST_F(LatestStreamTest, SaysWhatItWaitsFor) {
  streams().SetNotice("the sequence does not run");
  LatestStream stream = Open();
  ASSERT_TRUE(streams().WaitForStreams(1));
  Result<v1::StreamItem> item = stream.Next(milliseconds(1));
  while (item || item.error().message.find("does not run") == std::string::npos) {
    item = stream.Next(milliseconds(10));
  }
  EXPECT_EQ(Code::kDeadlineExceeded, item.error().code);
  EXPECT_EQ("NO_ITEM", item.error().reason);
}

TEST_F(LatestStreamTest, EndsWhileItWaits) {
  for (int i = 0; i < 20; ++i) {
    const LatestStream stream = Open();
    if (i % 2 == 0) streams().Publish();
  }
  server_.reset();
  const LatestStream without_server = Open();
}

}  // namespace
}  // namespace vs::client
