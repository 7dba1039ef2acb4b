// Sequences and parameters over the real API: what works, and what a wrong request is told.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/vision/sequence_fixture.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

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

TEST_F(SequenceApi, FramesBeyondTheLatencyBudgetAreCountedAndRaiseAnAlarm) {
  SequenceSpec spec = CountSpec();
  spec.latency_budget_ms = 1;  // the source alone takes 2 ms
  EXPECT_EQ(1, Create(spec).spec().latency_budget_ms());
  ASSERT_TRUE(Start("count").ok());
  const auto alarm = [&] {
    for (const AlarmBoard::Alarm& one : server_->alarms().List()) {
      if (one.id == "latency/count") return one.message;
    }
    return std::string();
  };
  EXPECT_TRUE(WaitUntil([&] { return !alarm().empty(); }));
  EXPECT_THAT(alarm(), HasSubstr("longer than its budget of 1 ms"));
  const pb::SequenceState state = State("count");
  EXPECT_EQ(1, state.latency_budget_ms());
  EXPECT_EQ(state.frames(), state.over_budget());
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_RUNNING, state.state());
  ASSERT_TRUE(Stop("count").ok());

  pb::GetSequenceRequest get;
  get.set_id("count");
  pb::Sequence stored;
  ASSERT_TRUE(sequences_->GetSequence(ClientCall(operator_).context(), get, &stored).ok());
  pb::UpdateSequenceRequest update;
  update.set_id("count");
  update.set_etag(stored.etag());
  update.mutable_spec()->set_latency_budget_ms(60'000);
  update.mutable_update_mask()->add_paths("spec.latency_budget_ms");
  ASSERT_TRUE(sequences_->UpdateSequence(ClientCall(engineer_).context(), update, &stored).ok());
  ASSERT_TRUE(Start("count").ok());
  EXPECT_TRUE(WaitUntil([&] { return State("count").frames() >= 20; }));
  EXPECT_EQ(0u, State("count").over_budget());
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
