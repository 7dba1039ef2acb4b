// What goes wrong with one sequence: its user is told, others do not notice.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/server/vision/sequence_fixture.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// What goes wrong with one sequence, told to its user and not noticed by another.
class SequenceFault : public SequenceApi {
 protected:
  void SetUp() override { bystander_ = StartBystander(); }
  void TearDown() override { EXPECT_TRUE(bystander_->GoesOn()); }

  std::unique_ptr<SteadyClient> bystander_;
};

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

TEST_F(SequenceFault, AFailureIsToldAlsoAfterGoodRuns) {
  ProbeOf("step").run = [](const StepRun& run) {
    return run.frame.number == 2 ? Unavailable("the lamp is dark") : Status();
  };
  Create(CountSpec());
  ASSERT_TRUE(Start("count").ok());
  ASSERT_TRUE(WaitUntil([&] { return State("count").frames() >= 4; }));
  const pb::SequenceState state = State("count");
  for (const pb::BlockState& block : state.blocks()) {
    const bool failed = block.block() == "step";
    EXPECT_EQ(failed ? 1u : 0u, block.failures()) << block.block();
    EXPECT_EQ(failed ? "the lamp is dark" : "", block.last_failure()) << block.block();
    EXPECT_EQ("", block.last_error()) << block.block();
  }
}

TEST_F(SequenceFault, AnExceptionEndsItsOwnSequenceOnly) {
  ProbeOf("step").run = [](const StepRun&) -> Status { throw std::runtime_error("bad luck"); };
  Create(CountSpec());
  ASSERT_TRUE(Start("count").ok());
  ASSERT_TRUE(WaitUntil([&] { return State("count").state() == pb::SEQUENCE_RUN_STATE_FAULT; }));
  EXPECT_EQ("count/step", State("count").last_error().path());
  EXPECT_THAT(State("count").last_error().message(), HasSubstr("bad luck"));
}

}  // namespace
}  // namespace vs::test
