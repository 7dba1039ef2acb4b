#include "engine/core/check_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/engine/core/test_blocks.h"

namespace vs {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> FaultsOf(const SequenceSpec& spec) {
  std::vector<std::string> texts;
  for (const Fault& fault : CheckSequence(spec))
    texts.push_back(fault.subject + ": " + fault.message);
  return texts;
}

TEST(CheckSequence, AcceptsASoundSequence) {
  SequenceSpec spec = ChainSpec("line", {"one", "two"});
  spec.connections.push_back(Wire("source.value", "two.b"));
  EXPECT_THAT(FaultsOf(spec), IsEmpty());
}

TEST(CheckSequence, ReportsEveryFaultAtOnce) {
  SequenceSpec spec;
  spec.id = "Line 1";
  spec.priority = 11;
  spec.max_frames_in_flight = 0;
  spec.latency_budget_ms = -1;
  spec.blocks = {
      SourceSpec("source"),
      {"step", "TestStep", {{"offset", int64_t{1001}}, {"gain", 1.5}, {"probe", true}}},
      {"step", "TestStep", {}},
      {"Bad id", "TestStep", {}},
      {"ghost", "NoSuchBlock", {}},
      {"number", "TestNumber", {}},
      {"some", "TestSome", {}, std::numeric_limits<double>::infinity()},
  };
  spec.connections = {
      Wire("source.value", "step.a"),   Wire("source.value", "step.a"),
      Wire("source.image", "step.b"),   Wire("number.out", "step.c"),
      Wire("nobody.out", "number.in"),  Wire("ghost.out", "nowhere.in"),
      Wire("ghost.anything", "step.b"),
  };
  EXPECT_THAT(
      FaultsOf(spec),
      ElementsAre(
          "sequence: the id must be a-z, 0-9 and _, begin with a letter and have at most 63 "
          "characters, not \"Line 1\"",
          "sequence: priority must be -10 to 10, not 11",
          "sequence: max_frames_in_flight must be 1 to 16, not 0",
          "sequence: latency_budget_ms must be 0 to 60000, not -1",
          "step.gain: there is no such parameter; TestStep has: probe, offset, fixed",
          "step.offset: offset must be -1000 to 1000, not 1001",
          "step.probe: probe must be a text, not true or false (true)",
          "step: there are several blocks of this id: rename one",
          "blocks[3]: a block's id must be a-z, 0-9 and _, begin with a letter and have at most 63 "
          "characters, not \"Bad id\"",
          "ghost: there is no block type \"NoSuchBlock\"",
          "some: its place in the editor must be finite numbers",
          "step.a: is connected several times: an input has one source",
          "source.image: there is no such output; source has: value",
          "step.c: there is no such input; step has: a, b",
          "number: a connection goes from \"nobody.out\" to \"number.in\", but there is no block "
          "\"nobody\"",
          "ghost: a connection goes from \"ghost.out\" to \"nowhere.in\", but there is no block "
          "\"nowhere\"",
          "step.b: is connected several times: an input has one source",
          "some: connect at least one of its inputs: a, b"));
}

TEST(CheckSequence, ChecksParametersThatEachFitAlsoTogether) {
  SequenceSpec spec = ChainSpec("line", {"one"});
  spec.blocks.push_back({"swapped", "TestLimits", {{"low", int64_t{7}}, {"high", 5.0}}});
  spec.blocks.push_back({"above", "TestLimits", {{"low", int64_t{11}}}});
  spec.blocks.push_back({"wrong", "TestLimits", {{"low", 11.0}, {"high", 101.0}}});
  spec.blocks.push_back({"good", "TestLimits", {{"low", 11.0}, {"high", 11.0}}});
  for (const char* to : {"swapped.a", "above.a", "wrong.a", "good.a"}) {
    spec.connections.push_back(Wire("source.value", to));
  }
  EXPECT_THAT(FaultsOf(spec), ElementsAre("swapped.low: is 7; it must be at most high, which is 5",
                                          "above.low: is 11; it must be at most high, which is 10",
                                          "wrong.high: high must be -100 to 100, not 101"));
}

TEST(CheckSequence, NamesInputsThatNeedAConnection) {
  SequenceSpec spec = ChainSpec("line", {"one"});
  spec.connections.clear();
  EXPECT_THAT(FaultsOf(spec), ElementsAre("one.a: is not connected: it needs integer"));
}

TEST(CheckSequence, ConnectsOnlyTypesThatFit) {
  SequenceSpec spec = ChainSpec("line", {"one"});
  spec.blocks.push_back({"half", "TestNumber", {}});
  spec.blocks.push_back({"some", "TestSome", {}});
  spec.connections.push_back(Wire("one.sum", "half.in"));
  spec.connections.push_back(Wire("half.out", "some.a"));
  EXPECT_THAT(FaultsOf(spec), IsEmpty()) << "integer -> number -> any";
  spec.connections.push_back(Wire("half.out", "one.b"));
  EXPECT_THAT(FaultsOf(spec), ElementsAre("one.b: takes integer, but half.out gives number",
                                          "one: feeds itself: one -> half -> one. Remove one "
                                          "connection"));
}

TEST(CheckSequence, NamesTheBlocksOfEachCycle) {
  SequenceSpec spec = ChainSpec("line", {"a", "b", "c", "d"});
  spec.connections.push_back(Wire("c.sum", "b.b"));
  EXPECT_THAT(FaultsOf(spec), ElementsAre("b: feeds itself: b -> c -> b. Remove one connection"));
}

TEST(CheckSequence, WantsASource) {
  SequenceSpec spec;
  spec.id = "empty";
  EXPECT_THAT(FaultsOf(spec),
              ElementsAre("sequence: has no source: add a camera or a file source"));
}

TEST(CheckSequence, RefusesHugeSequencesWithoutLookingCloser) {
  SequenceSpec spec = ChainSpec("line", {});
  spec.blocks.resize(100'000);
  spec.connections.resize(100'000);
  EXPECT_THAT(FaultsOf(spec),
              ElementsAre("sequence: may have at most 1000 blocks, not 100000",
                          "sequence: may have at most 10000 connections, not 100000"));
}

TEST(CheckSequence, TakesTheLargestSequence) {
  SequenceSpec spec = ChainSpec("line", {});
  for (int i = 1; i < 1000; ++i) {
    const std::string id = "step" + std::to_string(i);
    spec.blocks.push_back(StepSpec(id));
    spec.connections.push_back(
        Wire(i == 1 ? "source.value" : "step" + std::to_string(i - 1) + ".sum", id + ".a"));
  }
  EXPECT_THAT(FaultsOf(spec), IsEmpty());
}

TEST(CheckSequence, NeverRepeatsHostileTextAsItIs) {
  SequenceSpec spec = ChainSpec("line", {"one"});
  spec.blocks[1].params["\n\xff"] = std::string(5000, 'x');
  spec.blocks[1].params["probe"] = std::string("a\0b", 3);
  spec.connections.push_back(Wire("source.value", "one.\x1b[31m"));
  EXPECT_THAT(
      FaultsOf(spec),
      ElementsAre("one.\"\\x0a\\xff\": there is no such parameter; TestStep has: probe, offset, "
                  "fixed",
                  "one.probe: probe must not contain control characters, as \"a\\x00b\" does",
                  "one.\"\\x1b[31m\": there is no such input; one has: a, b"));
}

}  // namespace
}  // namespace vs
