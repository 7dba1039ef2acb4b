#include "server/sequences/sequence_manager.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/engine/core/test_blocks.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Something for operators to turn.
class TestDial final : public Block {
 public:
  In<int64_t> in{this, "in", "A number."};
  Param<double> gain{this,
                     "gain",
                     {.initial = 1,
                      .min = 0,
                      .max = 10,
                      .unit = "dB",
                      .operator_editable = true,
                      .doc = "How much."}};
  Param<int> steps{this, "steps", {.initial = 2, .min = 1, .max = 5, .doc = "How many."}};

  Status Run() override { return Status(); }
};
VS_REGISTER_BLOCK(TestDial, {.category = "Test", .doc = "Does nothing."});

// Source "source" -> step "step"; the source also feeds the dial "dial".
SequenceSpec DialSpec() {
  SequenceSpec spec = ChainSpec("dials", {"step"});
  spec.blocks.push_back({"dial", "TestDial", {}});
  spec.connections.push_back(Wire("source.value", "dial.in"));
  return spec;
}

ParamAssignment Set(const std::string& path, ParamValue value) {
  ParamAssignment assignment = SplitPath(path).value();
  assignment.value = std::move(value);
  return assignment;
}

class SequenceManagerTest : public ::testing::Test {
 protected:
  SequenceManagerTest() { (void)store_->Create(DialSpec(), false, "anna"); }
  ~SequenceManagerTest() override {
    manager_.StopAll();
    ClearProbes();
  }

  Activity ActivityOf(const std::string& id) { return manager_.Look(id).value().activity; }
  static ParamValue ValueIn(const std::vector<BlockParameter>& parameters,
                            const std::string& param) {
    for (const BlockParameter& one : parameters) {
      if (one.info().name == param) return one.value;
    }
    return "not there";
  }
  ParamValue Stored(const std::string& param) {
    return ValueIn(ParametersOf(store_->Get("dials").value().spec), param);
  }
  Status Change(const std::vector<ParamAssignment>& values, bool operators_only = false) {
    const auto answer =
        manager_.SetParameters("dials", {.values = values, .operators_only = operators_only});
    return answer.has_value() ? Status() : answer.error();
  }

  test::TempFolder folder_;
  const SystemClock clock_;
  const std::unique_ptr<SequenceStore> store_ = SequenceStore::Open(folder_.path(), clock_).value();
  Scheduler scheduler_{2, clock_};
  SequenceManager manager_{*store_, scheduler_, Environment{&clock_}};
};

TEST_F(SequenceManagerTest, ASequenceRunsFromStartToStop) {
  EXPECT_EQ(Activity::kStopped, ActivityOf("dials"));
  ASSERT_TRUE(manager_.Start("dials").ok());
  EXPECT_EQ(Activity::kRunning, ActivityOf("dials"));
  EXPECT_EQ(1u, manager_.Look("dials").value().revision);
  EXPECT_TRUE(test::WaitUntil([&] { return manager_.Look("dials").value().stats.frames > 10; }));
  ASSERT_TRUE(manager_.Start("dials").ok());  // runs already
  EXPECT_GT(manager_.Look("dials").value().stats.frames, 10u);
  ASSERT_TRUE(manager_.Stop("dials").ok());
  EXPECT_EQ(Activity::kStopped, ActivityOf("dials"));
  EXPECT_EQ(0u, manager_.Look("dials").value().revision);
  ASSERT_TRUE(manager_.Stop("dials").ok());  // has stopped already
}

TEST_F(SequenceManagerTest, UnknownSequencesAreNamedAndNotRemembered) {
  EXPECT_EQ(StatusCode::kNotFound, manager_.Start("dails").code());
  EXPECT_EQ(StatusCode::kNotFound, manager_.Stop("dails").code());
  EXPECT_EQ(StatusCode::kNotFound, manager_.Look("dails").error().code());
  EXPECT_EQ(StatusCode::kNotFound, manager_.Parameters("dails").error().code());
  EXPECT_EQ(1u, manager_.List().size());
}

TEST_F(SequenceManagerTest, ABrokenSequenceDoesNotStartAndAllItsFaultsAreTold) {
  SequenceSpec spec = ChainSpec("broken", {"a", "b"});
  spec.blocks.push_back({"odd", "NoSuchBlock", {}});
  spec.blocks[1].params["offset"] = int64_t{2000};
  (void)store_->Create(spec, false, "anna");
  const Status started = manager_.Start("broken");
  EXPECT_EQ(StatusCode::kInvalidArgument, started.code());
  EXPECT_EQ(2u, started.faults().size()) << started.ToString();
  EXPECT_EQ(Activity::kStopped, ActivityOf("broken"));
}

TEST_F(SequenceManagerTest, ABlockThatCannotStartIsToBlame) {
  ProbeOf("step").start = [] { return FailedPrecondition("there is no rig \"cell\""); };
  const Status started = manager_.Start("dials");
  EXPECT_EQ(StatusCode::kFailedPrecondition, started.code());
  const SequenceStatus status = manager_.Look("dials").value();
  EXPECT_EQ(Activity::kStopped, status.activity);
  EXPECT_EQ("step", status.error_block);
  EXPECT_THAT(status.error, HasSubstr("there is no rig"));
  EXPECT_GT(status.error_ns, 0);
  ProbeOf("step").start = nullptr;
  EXPECT_TRUE(manager_.Start("dials").ok());
  EXPECT_EQ("", manager_.Look("dials").value().error);
}

TEST_F(SequenceManagerTest, AFailingBlockDegradesAndAnExceptionIsAFault) {
  std::atomic<int> mood = 0;
  ProbeOf("step").run = [&](const StepRun&) {
    if (mood == 2) throw std::runtime_error("divided by cucumber");
    return mood == 1 ? Unavailable("camera is gone") : Status();
  };
  ASSERT_TRUE(manager_.Start("dials").ok());
  mood = 1;
  EXPECT_TRUE(test::WaitUntil([&] { return ActivityOf("dials") == Activity::kDegraded; }));
  EXPECT_EQ("step", manager_.Look("dials").value().error_block);
  EXPECT_EQ("camera is gone", manager_.Look("dials").value().error);
  mood = 0;
  EXPECT_TRUE(test::WaitUntil([&] { return ActivityOf("dials") == Activity::kRunning; }));
  mood = 2;
  EXPECT_TRUE(test::WaitUntil([&] { return ActivityOf("dials") == Activity::kFault; }));
  EXPECT_THAT(manager_.Look("dials").value().error, HasSubstr("divided by cucumber"));
  mood = 0;
  EXPECT_TRUE(manager_.Start("dials").ok());
  EXPECT_EQ(Activity::kRunning, ActivityOf("dials"));
}

TEST_F(SequenceManagerTest, OthersSeeASlowStartAndAreNotHeldUp) {
  (void)store_->Create(ChainSpec("quick", {}), false, "anna");
  std::atomic<bool> go_on = false;
  ProbeOf("step").start = [&] {
    EXPECT_TRUE(test::WaitUntil([&] { return go_on.load(); }));
    return Status();
  };
  std::thread starting([&] { EXPECT_TRUE(manager_.Start("dials").ok()); });
  EXPECT_TRUE(test::WaitUntil([&] { return ActivityOf("dials") == Activity::kStarting; }));
  EXPECT_TRUE(manager_.Start("quick").ok());
  EXPECT_EQ(StatusCode::kUnavailable, Change({Set("dial.gain", 2.0)}).code());
  go_on = true;
  starting.join();
  EXPECT_EQ(Activity::kRunning, ActivityOf("dials"));
}

TEST_F(SequenceManagerTest, OnlyMarkedSequencesStartByThemselvesAndOneThatFailsStopsNoOther) {
  (void)store_->Create(ChainSpec("marked", {}), true, "anna");
  SequenceSpec broken = ChainSpec("broken", {});
  broken.blocks[0].type = "NoSuchBlock";
  (void)store_->Create(broken, true, "anna");
  manager_.StartMarked();
  EXPECT_EQ(Activity::kRunning, ActivityOf("marked"));
  EXPECT_EQ(Activity::kStopped, ActivityOf("broken"));
  EXPECT_EQ(Activity::kStopped, ActivityOf("dials"));
}

TEST_F(SequenceManagerTest, ARunningSequenceIsNotDeleted) {
  ASSERT_TRUE(manager_.Start("dials").ok());
  const Status refused = manager_.Delete("dials", "");
  EXPECT_EQ(StatusCode::kFailedPrecondition, refused.code());
  EXPECT_THAT(refused.message(), HasSubstr("stop it first"));
  EXPECT_EQ(Activity::kRunning, ActivityOf("dials"));
  ASSERT_TRUE(manager_.Stop("dials").ok());
  ASSERT_TRUE(manager_.Delete("dials", "").ok());
  EXPECT_EQ(StatusCode::kNotFound, manager_.Start("dials").code());
}

TEST_F(SequenceManagerTest, EditingDoesNotTouchWhatRuns) {
  ASSERT_TRUE(manager_.Start("dials").ok());
  ASSERT_TRUE(store_
                  ->Update("dials", "", "ben",
                           [](StoredSequence* stored) {
                             stored->spec.blocks[2].params["gain"] = 9.0;
                             return Status();
                           })
                  .has_value());
  EXPECT_EQ(1u, manager_.Look("dials").value().revision);
  EXPECT_EQ(ParamValue(1.0), ValueIn(manager_.Parameters("dials").value().parameters, "gain"));
  ASSERT_TRUE(manager_.Stop("dials").ok());
  ASSERT_TRUE(manager_.Start("dials").ok());
  EXPECT_EQ(2u, manager_.Look("dials").value().revision);
}

TEST_F(SequenceManagerTest, ListsParametersWithTheirDescriptionAndValue) {
  const ParameterSet set = manager_.Parameters("dials").value();
  ASSERT_EQ(6u, set.parameters.size());  // probe, probe offset fixed, gain steps
  const BlockParameter& gain = set.parameters[4];
  EXPECT_EQ("dial", gain.block);
  EXPECT_EQ("gain", gain.info().name);
  EXPECT_EQ("dB", gain.info().unit);
  EXPECT_EQ(ParamValue(1.0), gain.value);
  EXPECT_EQ(store_->Get("dials").value().etag, set.etag);
}

TEST_F(SequenceManagerTest, AChangeIsStoredInTheParametersOwnTypeAndOnlyWhileItDiffers) {
  const auto answer =
      manager_.SetParameters("dials", {.values = {Set("dial.gain", int64_t{3})}, .user = "otto"});
  ASSERT_TRUE(answer.has_value()) << answer.error().ToString();
  EXPECT_EQ(0u, answer->applied_at_frame);
  EXPECT_EQ(2u, answer->revision);
  EXPECT_THAT(answer->values, ElementsAre(Set("dial.gain", 3.0)));
  EXPECT_EQ(ParamValue(3.0), Stored("gain"));
  EXPECT_EQ("otto", store_->Get("dials").value().updated_by);
  ASSERT_TRUE(Change({Set("dial.gain", 1.0)}).ok());
  EXPECT_TRUE(store_->Get("dials").value().spec.blocks.at(2).params.empty());
}

TEST_F(SequenceManagerTest, AChangeOfARunningSequenceHoldsFromTheFrameThatIsTold) {
  std::atomic<uint64_t> first_changed = 0;
  ProbeOf("step").run = [&](const StepRun& run) {
    if (run.offset == 5 && first_changed == 0) first_changed = run.frame.number;
    return Status();
  };
  ASSERT_TRUE(manager_.Start("dials").ok());
  const auto answer = manager_.SetParameters("dials", {.values = {Set("step.offset", int64_t{5})}});
  ASSERT_TRUE(answer.has_value()) << answer.error().ToString();
  EXPECT_GT(answer->applied_at_frame, 0u);
  EXPECT_TRUE(test::WaitUntil([&] { return first_changed > 0; }));
  EXPECT_EQ(answer->applied_at_frame, first_changed);
  EXPECT_EQ(ParamValue(int64_t{5}), Stored("offset"));
}

TEST_F(SequenceManagerTest, ABatchWithFaultsChangesNothingAndNamesThemAll) {
  const Status refused =
      Change({Set("dial.gain", 3.0), Set("dial.steps", int64_t{9}), Set("dial.steps", 2.5),
              Set("nobody.gain", 1.0), Set("dial.volume", 1.0)});
  EXPECT_EQ(StatusCode::kInvalidArgument, refused.code());
  ASSERT_EQ(4u, refused.faults().size()) << refused.ToString();
  EXPECT_EQ("dial.steps", refused.faults()[0].subject);
  EXPECT_THAT(refused.faults()[0].message, HasSubstr("1 to 5"));
  EXPECT_THAT(refused.faults()[1].message, HasSubstr("twice"));
  EXPECT_EQ("nobody.gain", refused.faults()[2].subject);
  EXPECT_EQ("dial.volume", refused.faults()[3].subject);
  EXPECT_EQ(ParamValue(1.0), Stored("gain"));
  EXPECT_EQ(1u, store_->Get("dials").value().revision);
}

TEST_F(SequenceManagerTest, OperatorsSetOnlyWhatIsMeantForThem) {
  EXPECT_TRUE(Change({Set("dial.gain", 3.0)}, true).ok());
  const Status refused = Change({Set("dial.gain", 4.0), Set("dial.steps", int64_t{3})}, true);
  EXPECT_EQ(StatusCode::kPermissionDenied, refused.code());
  ASSERT_EQ(1u, refused.faults().size());
  EXPECT_EQ("dial.steps", refused.faults()[0].subject);
  EXPECT_EQ(ParamValue(3.0), Stored("gain"));
  EXPECT_TRUE(Change({Set("dial.steps", int64_t{3})}, false).ok());
}

TEST_F(SequenceManagerTest, AFixedParameterNeedsTheSequenceToBeStopped) {
  ASSERT_TRUE(manager_.Start("dials").ok());
  EXPECT_EQ(StatusCode::kFailedPrecondition, Change({Set("step.fixed", int64_t{2})}).code());
  ASSERT_TRUE(manager_.Stop("dials").ok());
  EXPECT_TRUE(Change({Set("step.fixed", int64_t{2})}).ok());
}

TEST_F(SequenceManagerTest, OfTwoWhoTuneTheSameRevisionOneIsTurnedAway) {
  const std::string etag = manager_.Parameters("dials").value().etag;
  ASSERT_TRUE(manager_.SetParameters("dials", {.values = {Set("dial.gain", 2.0)}, .etag = etag}));
  const auto late =
      manager_.SetParameters("dials", {.values = {Set("dial.gain", 3.0)}, .etag = etag});
  EXPECT_EQ(StatusCode::kAborted, late.error().code());
  EXPECT_EQ(ParamValue(2.0), Stored("gain"));
}

TEST_F(SequenceManagerTest, ATrialChecksEverythingAndChangesNothing) {
  const auto trial =
      manager_.SetParameters("dials", {.values = {Set("dial.gain", 2.0)}, .validate_only = true});
  ASSERT_TRUE(trial.has_value());
  EXPECT_EQ(1u, trial->revision);
  EXPECT_EQ(ParamValue(1.0), Stored("gain"));
  EXPECT_FALSE(
      manager_.SetParameters("dials", {.values = {Set("dial.gain", 11.0)}, .validate_only = true}));
}

TEST_F(SequenceManagerTest, ResettingGivesTheInitialValuesBack) {
  ASSERT_TRUE(Change({Set("dial.gain", 2.0), Set("dial.steps", int64_t{4})}).ok());
  ASSERT_TRUE(manager_.ResetParameters("dials", {"dial.steps"}, {}).has_value());
  EXPECT_EQ(ParamValue(int64_t{2}), Stored("steps"));
  EXPECT_EQ(ParamValue(2.0), Stored("gain"));
  // An operator's "all" is all that operators may set.
  ASSERT_TRUE(Change({Set("dial.steps", int64_t{4})}).ok());
  ASSERT_TRUE(manager_.ResetParameters("dials", {}, {.operators_only = true}).has_value());
  EXPECT_EQ(ParamValue(1.0), Stored("gain"));
  EXPECT_EQ(ParamValue(int64_t{4}), Stored("steps"));
  EXPECT_EQ(StatusCode::kInvalidArgument,
            manager_.ResetParameters("dials", {"dial.volume"}, {}).error().code());
}

TEST_F(SequenceManagerTest, WatchersHearOfEachChange) {
  std::vector<ParameterEvent> events;
  std::vector<std::string> changed;
  const auto parameters =
      manager_.parameters_changed().Add([&](const ParameterEvent& e) { events.push_back(e); });
  const auto states = manager_.changed().Add([&](const std::string& id) { changed.push_back(id); });
  (void)manager_.SetParameters("dials", {.values = {Set("dial.gain", 2.0)}, .user = "otto"});
  (void)Change({Set("dial.gain", 99.0)});
  manager_.NoteEdited(store_->Get("dials").value());
  (void)manager_.Start("dials");
  (void)manager_.Stop("dials");
  ASSERT_EQ(2u, events.size());
  EXPECT_EQ("otto", events[0].user);
  EXPECT_THAT(events[0].values, ElementsAre(Set("dial.gain", 2.0)));
  EXPECT_EQ(store_->Get("dials").value().etag, events[0].etag);
  EXPECT_TRUE(events[1].values.empty());
  EXPECT_THAT(changed, ElementsAre("dials", "dials"));
}

TEST_F(SequenceManagerTest, AfterTheLastStopNothingStartsAnyMore) {
  ASSERT_TRUE(manager_.Start("dials").ok());
  manager_.StopAll();
  EXPECT_EQ(StatusCode::kUnavailable, manager_.Start("dials").code());
}

}  // namespace
}  // namespace vs
