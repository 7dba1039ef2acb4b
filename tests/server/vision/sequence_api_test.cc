// Sequences, parameters and results over the real API: what works, and what a wrong request is
// told.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "server/convert/sequence.h"
#include "server/rpc/error_details.h"
#include "tests/engine/core/test_blocks.h"
#include "tests/server/vision/vision_fixture.h"
#include "tests/support/raw_call.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

namespace pb = visionserver::v1;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

// Counts about 500 frames a second, adds an offset and publishes the sum.
SequenceSpec CountSpec() {
  SequenceSpec spec = ChainSpec("count", {"step"});
  spec.blocks.push_back({"publish", "Publish", {{"stream", std::string("sum")}}});
  spec.blocks.push_back({"check", "RangeCheck", {{"max", 1e9}}});
  spec.blocks.push_back({"log", "LogResult", {{"name_a", std::string("sum")}}});
  spec.connections.push_back(Wire("step.sum", "publish.value"));
  spec.connections.push_back(Wire("step.sum", "check.value"));
  spec.connections.push_back(Wire("step.sum", "log.a"));
  spec.connections.push_back(Wire("check.pass", "log.pass"));
  return spec;
}

pb::Value Integer(int64_t value) {
  pb::Value result;
  result.set_int_value(value);
  return result;
}

// The subjects of all faults that the error carries.
std::vector<std::string> SubjectsOf(const grpc::Status& status) {
  std::vector<std::string> subjects;
  pb::ErrorStatus whole;
  pb::ErrorDetail detail;
  if (whole.ParseFromString(status.error_details()) && whole.details_size() == 1 &&
      whole.details(0).UnpackTo(&detail)) {
    for (const pb::Fault& fault : detail.faults()) subjects.push_back(fault.subject());
  }
  return subjects;
}

class SequenceApi : public VisionTest {
 protected:
  SequenceApi() {
    ProbeOf("source").run = [](const StepRun&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));  // the pace of a camera
      return Status();
    };
  }
  ~SequenceApi() override {
    server_->vision().StopSequences();
    ClearProbes();
  }

  grpc::Status TryCreate(const SequenceSpec& spec) {
    pb::CreateSequenceRequest request;
    request.set_id(spec.id);
    *request.mutable_spec() = ToProto(spec);
    pb::Sequence created;
    return sequences_->CreateSequence(ClientCall(engineer_).context(), request, &created);
  }
  grpc::Status Update(const SequenceSpec& spec, const std::string& etag, pb::Sequence* updated) {
    pb::UpdateSequenceRequest request;
    request.set_id(spec.id);
    *request.mutable_spec() = ToProto(spec);
    request.set_etag(etag);
    return sequences_->UpdateSequence(ClientCall(engineer_).context(), request, updated);
  }
  int Stored() {
    pb::ListSequencesResponse list;
    EXPECT_TRUE(
        sequences_
            ->ListSequences(ClientCall(operator_).context(), pb::ListSequencesRequest(), &list)
            .ok());
    return list.sequences_size();
  }
};

// What goes wrong with one sequence, told to its user and not noticed by another.
class SequenceFault : public SequenceApi {
 protected:
  void SetUp() override { bystander_ = StartBystander(); }
  void TearDown() override { EXPECT_TRUE(bystander_->GoesOn()); }

  std::unique_ptr<SteadyClient> bystander_;
};

TEST_F(SequenceApi, AStoredSequenceComesBackAsItWasSent) {
  const SequenceSpec spec = CountSpec();
  const pb::Sequence created = Create(spec);
  EXPECT_EQ(1u, created.revision());
  EXPECT_EQ("test.engineer", created.updated_by());
  pb::GetSequenceRequest request;
  request.set_id("count");
  pb::Sequence got;
  ASSERT_TRUE(sequences_->GetSequence(ClientCall(operator_).context(), request, &got).ok());
  EXPECT_EQ(spec, FromProto("count", got.spec()).value());
  EXPECT_EQ(created.etag(), got.etag());
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_STOPPED, got.run_state());
}

TEST_F(SequenceFault, WrongSequencesAreRefusedWithAllFaultsAndNothingIsStored) {
  SequenceSpec spec = CountSpec();
  spec.blocks.push_back({"odd", "NoSuchBlock", {}});
  spec.blocks[1].params["offset"] = int64_t{5000};
  spec.connections.push_back(Wire("check.pass", "step.b"));  // a bool into an integer, and a cycle
  const grpc::Status refused = TryCreate(spec);
  EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT, refused.error_code());
  EXPECT_THAT(refused.error_message(), HasSubstr("4 faults"));
  const std::vector<std::string> subjects = SubjectsOf(refused);
  EXPECT_THAT(subjects, Contains("odd"));
  EXPECT_THAT(subjects, Contains("step.offset"));
  EXPECT_THAT(subjects, Contains("step.b"));

  SequenceSpec cycle = ChainSpec("cycle", {"a", "b"});
  cycle.connections.push_back(Wire("b.sum", "a.b"));
  const grpc::Status cyclic = TryCreate(cycle);
  EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT, cyclic.error_code());
  EXPECT_THAT(cyclic.error_message(), HasSubstr("the sequence has a fault"));
  EXPECT_THAT(cyclic.error_message(), HasSubstr("a -> b -> a"));
  EXPECT_EQ(1, Stored());  // the bystander's
}

TEST_F(SequenceFault, AnUnfinishedSequenceIsStoredWhenAskedForButDoesNotStart) {
  SequenceSpec spec = CountSpec();
  spec.blocks[1].type = "NoSuchBlock";
  Create(spec, true);
  const grpc::Status started = Start("count");
  EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT, started.error_code());
  EXPECT_THAT(SubjectsOf(started), Contains("step"));
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_STOPPED, State("count").state());
  pb::ValidateSequenceRequest request;
  request.set_id("count");
  pb::ValidateSequenceResponse response;
  ASSERT_TRUE(
      sequences_->ValidateSequence(ClientCall(engineer_).context(), request, &response).ok());
  EXPECT_GT(response.faults_size(), 0);
}

TEST_F(SequenceFault, AMissingCalibrationIsNamedWithItsBlock) {
  SequenceSpec spec;
  spec.id = "rectify";
  spec.blocks = {{"source", "SimulatedStereo", {}},
                 {"rectify", "RectifyPair", {{"rig", std::string("cell_9")}}}};
  spec.connections = {Wire("source.pair", "rectify.pair")};
  Create(spec);
  const grpc::Status started = Start("rectify");
  EXPECT_EQ(grpc::StatusCode::NOT_FOUND, started.error_code());
  EXPECT_THAT(started.error_message(), HasSubstr("rectify"));
  EXPECT_THAT(started.error_message(), HasSubstr("cell_9"));
  const pb::SequenceState state = State("rectify");
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_STOPPED, state.state());
  EXPECT_EQ("rectify/rectify", state.last_error().path());
}

TEST_F(SequenceFault, AFolderOfUnreadablePicturesIsTold) {
  const std::filesystem::path folder = server_.data_dir() / "pictures";
  std::filesystem::create_directory(folder);
  for (const char* name : {"a_left.png", "a_right.png"}) {
    std::ofstream(folder / name) << "this is no picture";
  }
  SequenceSpec spec;
  spec.id = "files";
  spec.blocks = {{"source", "FileSource", {{"folder", std::string("pictures")}}},
                 {"publish", "Publish", {}}};
  spec.connections = {Wire("source.pair", "publish.value")};
  Create(spec);
  const grpc::Status started = Start("files");
  EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT, started.error_code());
  EXPECT_THAT(started.error_message(), HasSubstr("source: "));
  EXPECT_THAT(started.error_message(), HasSubstr("data/pictures can be used"));
  EXPECT_THAT(started.error_message(), HasSubstr("data/pictures/a_left.png is not"));
  const pb::SequenceState state = State("files");
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_STOPPED, state.state());
  EXPECT_EQ("files/source", state.last_error().path());
}

TEST_F(SequenceApi, OfTwoEditorsTheLaterOneIsTurnedAway) {
  SequenceSpec spec = CountSpec();
  const std::string etag = Create(spec).etag();
  pb::Sequence updated;
  spec.description = "the first editor's";
  ASSERT_TRUE(Update(spec, etag, &updated).ok());
  EXPECT_EQ(2u, updated.revision());
  spec.description = "the second editor's";
  const grpc::Status late = Update(spec, etag, &updated);
  EXPECT_EQ(grpc::StatusCode::ABORTED, late.error_code());
  EXPECT_THAT(late.error_message(), HasSubstr("test.engineer"));
  EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT, Update(spec, "", &updated).error_code());
  pb::GetSequenceRequest request;
  request.set_id("count");
  ASSERT_TRUE(sequences_->GetSequence(ClientCall(operator_).context(), request, &updated).ok());
  EXPECT_EQ("the first editor's", updated.spec().description());
}

TEST_F(SequenceApi, AMaskedUpdateChangesOnlyWhatItNames) {
  const pb::Sequence created = Create(CountSpec());
  pb::UpdateSequenceRequest request;
  request.set_id("count");
  request.set_etag(created.etag());
  request.set_autostart(true);
  request.mutable_spec()->set_description("new");
  request.mutable_update_mask()->add_paths("spec.description");
  pb::Sequence updated;
  const grpc::Status status =
      sequences_->UpdateSequence(ClientCall(engineer_).context(), request, &updated);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ("new", updated.spec().description());
  EXPECT_EQ(5, updated.spec().blocks_size());
  EXPECT_FALSE(updated.autostart());
  request.set_etag(updated.etag());
  request.mutable_update_mask()->add_paths("spec.colour");
  EXPECT_EQ(
      grpc::StatusCode::INVALID_ARGUMENT,
      sequences_->UpdateSequence(ClientCall(engineer_).context(), request, &updated).error_code());
}

TEST_F(SequenceApi, AParameterChangeHoldsFromTheFrameThatTheAnswerNames) {
  Create(CountSpec());
  ASSERT_TRUE(Start("count").ok());
  StreamClient client(server_.Connect(), operator_, {Wish(1, "count/sum", 16)});
  pb::StreamItem item;
  ASSERT_TRUE(client.Take(&item));
  pb::SetParametersResponse answer;
  const grpc::Status set = Set(engineer_, "count", "step.offset", Integer(100), &answer);
  ASSERT_TRUE(set.ok()) << set.error_message();
  ASSERT_GT(answer.applied_at_frame(), 0u);
  EXPECT_EQ(2u, answer.revision());
  int after = 0;
  while (after < 5) {
    ASSERT_TRUE(client.Take(&item));
    const uint64_t frame = item.header().frame_number();
    const bool changed = frame >= answer.applied_at_frame();
    // The source counts from 1, as frames do.
    EXPECT_EQ(static_cast<int64_t>(frame) + (changed ? 100 : 0), item.value().int_value());
    if (changed) ++after;
  }
}

TEST_F(SequenceApi, ParametersAreGuardedByRangeAndRole) {
  Create(CountSpec());
  pb::SetParametersResponse answer;
  const grpc::Status range = Set(engineer_, "count", "step.offset", Integer(1001), &answer);
  EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT, range.error_code());
  EXPECT_THAT(SubjectsOf(range), UnorderedElementsAre("step.offset"));
  const grpc::Status role = Set(operator_, "count", "step.offset", Integer(1), &answer);
  EXPECT_EQ(grpc::StatusCode::PERMISSION_DENIED, role.error_code());
  pb::Value limit;
  limit.set_double_value(7);
  EXPECT_TRUE(Set(operator_, "count", "check.max", limit, &answer).ok());
}

TEST_F(SequenceApi, ValuesThatDoNotGoTogetherAreRefusedAtTheDoor) {
  const auto limit = [](double value) {
    pb::Value result;
    result.set_double_value(value);
    return result;
  };
  SequenceSpec swapped = CountSpec();
  swapped.blocks[3].params = {{"min", 3.0}, {"max", 2.0}};
  const grpc::Status refused = TryCreate(swapped);
  EXPECT_THAT(refused.error_message(), HasSubstr("check: min (3) must not be above max (2)"));
  EXPECT_THAT(SubjectsOf(refused), UnorderedElementsAre("check"));
  EXPECT_EQ(0, Stored());

  Create(CountSpec());
  pb::SetParametersResponse answer;
  for (const bool running : {false, true}) {
    if (running) {
      ASSERT_TRUE(Start("count").ok());
    }
    const grpc::Status set = Set(operator_, "count", "check.max", limit(-1), &answer);
    EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT, set.error_code());
    EXPECT_THAT(set.error_message(), HasSubstr("min (0) must not be above max (-1)"));
    EXPECT_THAT(SubjectsOf(set), UnorderedElementsAre("check"));
  }
  ASSERT_TRUE(Set(operator_, "count", "check.min", limit(2), &answer).ok());
  EXPECT_EQ(2u, answer.revision()) << "the refused ones left none";
  pb::ResetParametersRequest reset;
  reset.set_sequence("count");
  reset.add_paths("check.max");  // to 1, below min
  pb::SetParametersResponse unused;
  EXPECT_EQ(
      grpc::StatusCode::INVALID_ARGUMENT,
      parameters_->ResetParameters(ClientCall(operator_).context(), reset, &unused).error_code());
}

TEST_F(SequenceApi, AChoiceThatNeedsAnOpenInputIsRefusedAtTheDoor) {
  SequenceSpec spec;
  spec.id = "saving";
  spec.blocks = {{"source", "SimulatedStereo", {{"rate_hz", 10.0}}},
                 {"small", "Resize", {{"scale", 0.2}}},
                 {"save", "SaveImages", {{"policy", std::string("fail")}}}};
  spec.connections = {{"source", "pair", "small", "pair"}, {"small", "resized", "save", "picture"}};
  const grpc::Status refused = TryCreate(spec);
  EXPECT_THAT(refused.error_message(), HasSubstr("fail needs the input pass: connect it"));
  EXPECT_THAT(SubjectsOf(refused), UnorderedElementsAre("save.policy"));
  EXPECT_EQ(0, Stored());
  pb::ValidateSequenceRequest validate;
  *validate.mutable_spec() = ToProto(spec);
  pb::ValidateSequenceResponse validated;
  ASSERT_TRUE(
      sequences_->ValidateSequence(ClientCall(engineer_).context(), validate, &validated).ok());
  ASSERT_EQ(1, validated.faults_size());
  EXPECT_EQ("save.policy", validated.faults(0).subject());

  spec.blocks[2].params = {{"policy", std::string("every_nth")}, {"every_nth", int64_t{1'000'000}}};
  Create(spec);
  pb::Value fail;
  fail.set_string_value("fail");
  pb::SetParametersResponse answer;
  for (const bool running : {false, true}) {
    if (running) {
      ASSERT_TRUE(Start("saving").ok());
    }
    const grpc::Status set = Set(operator_, "saving", "save.policy", fail, &answer);
    EXPECT_EQ(grpc::StatusCode::INVALID_ARGUMENT, set.error_code());
    EXPECT_THAT(SubjectsOf(set), UnorderedElementsAre("save.policy"));
    pb::GetParametersRequest get;
    get.set_sequence("saving");
    get.add_paths("save.policy");
    pb::GetParametersResponse got;
    ASSERT_TRUE(parameters_->GetParameters(ClientCall(operator_).context(), get, &got).ok());
    EXPECT_EQ("every_nth", got.values(0).value().string_value());
  }
  EXPECT_EQ(1u, State("saving").revision());
  ASSERT_TRUE(Stop("saving").ok());
  EXPECT_TRUE(Start("saving").ok());
}

TEST_F(SequenceApi, WatchersSeeParametersAndStatesChange) {
  Create(CountSpec());
  ClientCall parameters_call(operator_);
  pb::WatchParametersRequest parameters;
  parameters.set_sequence("count");
  const auto changes = parameters_->WatchParameters(parameters_call.context(), parameters);
  pb::ParameterChange change;
  ASSERT_TRUE(changes->Read(&change));
  EXPECT_GT(change.values_size(), 5);
  pb::SetParametersResponse answer;
  ASSERT_TRUE(Set(engineer_, "count", "step.offset", Integer(3), &answer).ok());
  ASSERT_TRUE(changes->Read(&change));
  ASSERT_EQ(1, change.values_size());
  EXPECT_EQ("step.offset", change.values(0).path());
  EXPECT_EQ("test.engineer", change.user());
  EXPECT_EQ(answer.etag(), change.etag());

  ClientCall state_call(operator_);
  pb::WatchSequenceRequest states;
  states.set_interval_ms(60'000);
  const auto watch = sequences_->WatchSequence(state_call.context(), states);
  pb::SequenceState state;
  ASSERT_TRUE(watch->Read(&state));
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_STOPPED, state.state());
  ASSERT_TRUE(Start("count").ok());
  do {
    ASSERT_TRUE(watch->Read(&state));
  } while (state.state() != pb::SEQUENCE_RUN_STATE_RUNNING);
  EXPECT_EQ(2u, state.revision());
  state_call.context()->TryCancel();
  parameters_call.context()->TryCancel();
}

TEST_F(SequenceApi, ARunningSequenceIsNotDeleted) {
  Create(CountSpec());
  ASSERT_TRUE(Start("count").ok());
  pb::DeleteSequenceRequest request;
  request.set_id("count");
  pb::DeleteSequenceResponse response;
  EXPECT_EQ(
      grpc::StatusCode::FAILED_PRECONDITION,
      sequences_->DeleteSequence(ClientCall(engineer_).context(), request, &response).error_code());
  ASSERT_TRUE(Stop("count").ok());
  EXPECT_TRUE(sequences_->DeleteSequence(ClientCall(engineer_).context(), request, &response).ok());
  EXPECT_EQ(0, Stored());
}

TEST_F(SequenceApi, WatchersOfADeletedSequenceAreToldSo) {
  const auto watch_states = [this](ClientCall* call, const std::string& id) {
    pb::WatchSequenceRequest request;
    request.set_id(id);
    request.set_interval_ms(60'000);
    return sequences_->WatchSequence(call->context(), request);
  };
  pb::SequenceState state;
  Create(ChainSpec("other", {}));
  ClientCall all_call(operator_);
  const auto all = watch_states(&all_call, "");
  ASSERT_TRUE(all->Read(&state));
  Create(CountSpec());  // newer than what the watcher of all was told
  ClientCall state_call(operator_);
  const auto states = watch_states(&state_call, "count");
  ASSERT_TRUE(states->Read(&state));
  EXPECT_EQ("count", state.sequence());
  ClientCall parameters_call(operator_);
  pb::WatchParametersRequest parameters;
  parameters.set_sequence("count");
  const auto changes = parameters_->WatchParameters(parameters_call.context(), parameters);
  pb::ParameterChange change;
  ASSERT_TRUE(changes->Read(&change));

  pb::DeleteSequenceRequest request;
  request.set_id("count");
  pb::DeleteSequenceResponse response;
  ASSERT_TRUE(sequences_->DeleteSequence(ClientCall(engineer_).context(), request, &response).ok());
  EXPECT_FALSE(states->Read(&state));
  const grpc::Status state_end = states->Finish();
  EXPECT_EQ(grpc::StatusCode::NOT_FOUND, state_end.error_code()) << state_end.error_message();
  EXPECT_THAT(state_end.error_message(), HasSubstr("\"count\""));
  EXPECT_FALSE(changes->Read(&change));
  EXPECT_EQ(grpc::StatusCode::NOT_FOUND, changes->Finish().error_code());

  ASSERT_TRUE(Start("other").ok());
  do {
    ASSERT_TRUE(all->Read(&state)) << "who watches all goes on";
  } while (state.state() != pb::SEQUENCE_RUN_STATE_RUNNING);
  all_call.context()->TryCancel();
}

TEST_F(SequenceApi, BlockTypesDescribeThemselves) {
  pb::ListBlockTypesResponse list;
  ASSERT_TRUE(
      sequences_
          ->ListBlockTypes(ClientCall(engineer_).context(), pb::ListBlockTypesRequest(), &list)
          .ok());
  const pb::BlockType* matcher = nullptr;
  for (const pb::BlockType& type : list.block_types()) {
    if (type.type() == "SgmStereo") matcher = &type;
  }
  ASSERT_NE(nullptr, matcher);
  EXPECT_EQ("Stereo", matcher->category());
  EXPECT_EQ("disparity_map", matcher->outputs(0).type());
  EXPECT_FALSE(matcher->parameters(0).doc().empty());
}

TEST_F(SequenceApi, WhatASequenceLogsIsWatchedListedQueriedAndExported) {
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

TEST_F(SequenceApi, AWatcherWhoKnowsResultsThatAreNotThereIsToldSo) {
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

TEST_F(SequenceApi, LargeResultsComeInPagesThatEveryClientTakes) {
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

TEST_F(SequenceApi, EndlessQueriesKeepNobodyElseWaiting) {
  Create(CountSpec());
  ASSERT_TRUE(Start("count").ok());
  // More than there are threads for anything.
  const std::string viewer = server_.Token(Role::kViewer);
  pb::QueryResultsRequest endless;
  endless.set_sql(
      "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT count(*) FROM n");
  endless.mutable_timeout()->set_seconds(30);
  std::vector<std::unique_ptr<RawCall>> queries;
  for (int i = 0; i < 12; ++i) {
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

TEST_F(SequenceFault, AFailingSequenceIsUnhealthyAndRaisesAnAlarm) {
  ProbeOf("step").run = [](const StepRun&) { return Unavailable("the lamp is dark"); };
  Create(CountSpec());
  const std::string name = "sequences/count";
  EXPECT_TRUE(WaitUntil([&] { return server_->health().Get(name) == false; }));
  ASSERT_TRUE(Start("count").ok());
  const auto alarmed = [&] {
    for (const AlarmBoard::Alarm& alarm : server_->alarms().List()) {
      if (alarm.id == name) return alarm.message == "sequence count: step: the lamp is dark";
    }
    return false;
  };
  EXPECT_TRUE(WaitUntil(alarmed));
  EXPECT_EQ(false, server_->health().Get(name));
  EXPECT_TRUE(bystander_->GoesOn());
  ASSERT_TRUE(Stop("count").ok());
  ProbeOf("step").run = nullptr;
  ASSERT_TRUE(Start("count").ok());
  EXPECT_TRUE(WaitUntil([&] { return server_->health().Get(name) == true; }));
  EXPECT_TRUE(WaitUntil([&] { return !alarmed(); }));
}

TEST_F(SequenceFault, AnExceptionEndsItsOwnSequenceOnly) {
  ProbeOf("step").run = [](const StepRun&) -> Status { throw std::runtime_error("bad luck"); };
  Create(CountSpec());
  ASSERT_TRUE(Start("count").ok());
  ASSERT_TRUE(WaitUntil([&] { return State("count").state() == pb::SEQUENCE_RUN_STATE_FAULT; }));
  EXPECT_EQ("count/step", State("count").last_error().path());
  EXPECT_THAT(State("count").last_error().message(), HasSubstr("bad luck"));
}

TEST_F(SequenceApi, AfterARestartEverythingIsThereAgain) {
  pb::Sequence created = Create(CountSpec());
  pb::UpdateSequenceRequest mark;
  mark.set_id("count");
  mark.set_etag(created.etag());
  mark.set_autostart(true);
  mark.mutable_update_mask()->add_paths("autostart");
  ASSERT_TRUE(sequences_->UpdateSequence(ClientCall(engineer_).context(), mark, &created).ok());
  server_.Restart();
  const auto sequences = pb::SequenceService::NewStub(server_.Connect());
  const std::string token = server_.Token(Role::kOperator);
  pb::GetSequenceRequest request;
  request.set_id("count");
  pb::Sequence got;
  ASSERT_TRUE(sequences->GetSequence(ClientCall(token).context(), request, &got).ok());
  EXPECT_EQ(created.etag(), got.etag());
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_RUNNING, got.run_state());
}

}  // namespace
}  // namespace vs::test
