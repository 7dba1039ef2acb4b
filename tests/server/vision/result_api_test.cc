// Results over the real API, from the block that logs them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/server/vision/sequence_fixture.h"
#include "tests/support/raw_call.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using ::testing::HasSubstr;

using ResultApi = SequenceApi;

TEST_F(ResultApi, WhatASequenceLogsIsWatchedListedQueriedAndExported) {
  Create(CountSpec());
  ClientCall watch_call(operator_);
  pb::WatchResultsRequest watch;
  watch.mutable_filter()->set_job_id("count");
  watch.set_after_number(0);
  const auto results = results_->WatchResults(watch_call.context(), watch);
  ASSERT_TRUE(Start("count").ok());
  pb::Result result;
  for (uint64_t number = 1; number <= 30; ++number) {
    ASSERT_TRUE(results->Read(&result));
    EXPECT_EQ(number, result.number());
    EXPECT_EQ("count", result.job_id());
    EXPECT_EQ(number, result.frame_number());
    EXPECT_EQ(pb::RESULT_CLASS_PASS, result.result_class());
    ASSERT_EQ(1, result.fields_size());
    EXPECT_EQ("sum", result.fields(0).name());
  }
  watch_call.context()->TryCancel();
  ASSERT_TRUE(Stop("count").ok());

  pb::GetResultRequest get;
  get.set_result_id(result.result_id());
  pb::Result same;
  ASSERT_TRUE(results_->GetResult(ClientCall(operator_).context(), get, &same).ok());
  EXPECT_EQ(result.SerializeAsString(), same.SerializeAsString());

  pb::ListResultsRequest list;
  list.set_page_size(20);
  pb::ListResultsResponse page;
  ASSERT_TRUE(results_->ListResults(ClientCall(operator_).context(), list, &page).ok());
  ASSERT_EQ(20, page.results_size());
  const uint64_t oldest = page.results(19).number();
  list.set_page_token(page.next_page_token());
  ASSERT_TRUE(results_->ListResults(ClientCall(operator_).context(), list, &page).ok());
  EXPECT_EQ(oldest - 1, page.results(0).number());
  list.clear_page_token();
  list.mutable_filter()->set_result_state(pb::RESULT_STATE_COMPLETED);
  ASSERT_TRUE(results_->ListResults(ClientCall(operator_).context(), list, &page).ok());
  EXPECT_EQ(20, page.results_size());
  list.mutable_filter()->set_result_state(pb::RESULT_STATE_FAILED);
  ASSERT_TRUE(results_->ListResults(ClientCall(operator_).context(), list, &page).ok());
  EXPECT_EQ(0, page.results_size());

  pb::QueryResultsRequest query;
  query.set_sql("SELECT count(*) AS n, max(frame_number) FROM result WHERE number <= ?1");
  *query.add_arguments() = Integer(30);
  pb::QueryResultsResponse answer;
  ASSERT_TRUE(results_->QueryResults(ClientCall(operator_).context(), query, &answer).ok());
  EXPECT_EQ("n", answer.table().columns(0));
  EXPECT_EQ(30, answer.table().rows(0).cells(0).int_value());
  query.set_sql("DROP TABLE result");
  query.clear_arguments();
  EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT,
            results_->QueryResults(ClientCall(operator_).context(), query, &answer).error_code());

  ClientCall export_call(operator_);
  const auto pieces = results_->ExportResults(export_call.context(), pb::ExportResultsRequest());
  std::string csv;
  pb::ExportResultsResponse piece;
  while (pieces->Read(&piece)) csv += piece.data();
  EXPECT_TRUE(pieces->Finish().ok());
  EXPECT_THAT(csv, HasSubstr(",reason,sum\r\n1,"));
  EXPECT_THAT(csv, HasSubstr(result.result_id()));
}

TEST_F(ResultApi, ThePictureThatAResultNamesIsFetched) {
  SequenceSpec spec;
  spec.id = "pictures";
  spec.blocks = {SourceSpec("source"),
                 {"cameras", "SimulatedStereo", {{"rate_hz", 20.0}}},
                 {"save",
                  "SaveImages",
                  {{"policy", std::string("every_nth")},
                   {"every_nth", int64_t{1000}},
                   {"min_free_mb", int64_t{0}}}},
                 {"log", "LogResult", {{"name_a", std::string("count")}}}};
  spec.connections = {{"cameras", "pair", "save", "picture"},
                      {"save", "path", "log", "picture"},
                      {"source", "value", "log", "a"}};
  Create(spec);
  ClientCall watch_call(operator_);
  pb::WatchResultsRequest watch;
  watch.set_after_number(0);
  const auto results = results_->WatchResults(watch_call.context(), watch);
  ASSERT_TRUE(Start("pictures").ok());
  pb::Result result;
  ASSERT_TRUE(results->Read(&result));
  ASSERT_EQ(2, result.fields_size());
  EXPECT_EQ("picture", result.fields(1).name());

  pb::GetResultFileRequest request;
  request.set_result_id(result.result_id());
  request.set_field("picture");
  pb::GetResultFileResponse file;
  const auto fetch = [&] {
    return results_->GetResultFile(ClientCall(operator_).context(), request, &file).error_code();
  };
  ASSERT_EQ(grpc::StatusCode::OK, fetch());
  EXPECT_EQ("images/" + file.file_name(), result.fields(1).value().string_value());
  EXPECT_EQ("image/png", file.media_type());
  EXPECT_EQ("\x89PNG", file.data().substr(0, 4));

  std::filesystem::remove(server_.data_dir() / "images" / file.file_name());
  EXPECT_EQ(grpc::StatusCode::NOT_FOUND, fetch());
  request.set_field("count");
  EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT, fetch());
  request.set_field("other");
  EXPECT_EQ(grpc::StatusCode::NOT_FOUND, fetch());
  request.set_result_id("019b2a6c-0f3e-7c1a-8f57-1d2a3b4c5d6e");
  EXPECT_EQ(grpc::StatusCode::NOT_FOUND, fetch());
  // A frame without a picture is no failure.
  ASSERT_TRUE(results->Read(&result));
  EXPECT_EQ(pb::RESULT_STATE_COMPLETED, result.result_state());
  EXPECT_EQ(1, result.fields_size());
}

TEST_F(ResultApi, AWatcherWhoKnowsResultsThatAreNotThereIsToldSo) {
  ClientCall call(operator_);
  pb::WatchResultsRequest request;
  request.set_after_number(1);  // of results that somebody has put away
  const auto watch = results_->WatchResults(call.context(), request);
  pb::Result result;
  EXPECT_FALSE(watch->Read(&result));
  const grpc::Status told = watch->Finish();
  EXPECT_EQ(grpc::StatusCode::OUT_OF_RANGE, told.error_code());
  EXPECT_EQ("RESULTS_BEGUN_ANEW", ReasonOf(told));
}

TEST_F(ResultApi, LargeResultsComeInPagesThatEveryClientTakes) {
  ResultRecord record;
  record.job_id = "large";
  for (int i = 0; i < 100; ++i) {
    record.values = {{"text", std::string(60'000, 'x')}};
    ASSERT_TRUE(server_->vision().results().Log(record).has_value());
  }
  ASSERT_TRUE(WaitUntil([&] { return server_->vision().results().State().last_number == 100; }));
  pb::ListResultsRequest request;
  request.set_page_size(1000);
  int results = 0;
  int pages = 0;
  do {
    pb::ListResultsResponse page;
    const grpc::Status listed =
        results_->ListResults(ClientCall(operator_).context(), request, &page);
    ASSERT_TRUE(listed.ok()) << listed.error_message();
    results += page.results_size();
    request.set_page_token(page.next_page_token());
    ++pages;
  } while (!request.page_token().empty());
  EXPECT_EQ(100, results);
  EXPECT_EQ(3, pages);  // 6 MB in pages of 2 MB

  // The same by stream and as a file.
  ClientCall watch_call(operator_);
  pb::WatchResultsRequest from_first;
  from_first.set_after_number(0);
  const auto watch = results_->WatchResults(watch_call.context(), from_first);
  pb::Result result;
  for (uint64_t number = 1; number <= 100; ++number) {
    ASSERT_TRUE(watch->Read(&result));
    ASSERT_EQ(number, result.number());
  }
  watch_call.context()->TryCancel();
  ClientCall export_call(operator_);
  const auto pieces = results_->ExportResults(export_call.context(), pb::ExportResultsRequest());
  pb::ExportResultsResponse piece;
  size_t bytes = 0;
  while (pieces->Read(&piece)) bytes += piece.data().size();
  EXPECT_TRUE(pieces->Finish().ok());
  EXPECT_GT(bytes, 6'000'000u);
}

TEST_F(ResultApi, EndlessQueriesKeepNobodyElseWaiting) {
  Create(CountSpec());
  ASSERT_TRUE(Start("count").ok());
  // More than there are threads for anything, and as many as one login may have waiting.
  const std::string viewer = server_.Token(Role::kViewer);
  pb::QueryResultsRequest endless;
  endless.set_sql(
      "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT count(*) FROM n");
  endless.mutable_timeout()->set_seconds(30);
  std::vector<std::unique_ptr<RawCall>> queries;
  for (int i = 0; i < 8; ++i) {
    queries.push_back(
        std::make_unique<RawCall>(channel_, "/visionserver.v1.ResultService/QueryResults", viewer));
    ASSERT_TRUE(queries.back()->Send(endless.SerializeAsString()));
  }
  EXPECT_TRUE(Stop("count").ok());
  pb::ListResultsResponse page;
  EXPECT_TRUE(
      results_->ListResults(ClientCall(operator_).context(), pb::ListResultsRequest(), &page).ok());
  // All of them are still under way.
  for (const MethodStats& stats : server_->dispatcher().Statistics()) {
    EXPECT_NE("/visionserver.v1.ResultService/QueryResults", stats.method);
  }
}

}  // namespace
}  // namespace vs::test
