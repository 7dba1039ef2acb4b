#include "engine/core/sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/engine/core/test_blocks.h"

namespace vs {
namespace {

using ::testing::ElementsAre;

// Two sources and a diamond; ids against the order of the data.
SequenceSpec DiamondSpec() {
  SequenceSpec spec;
  spec.id = "diamond";
  spec.blocks = {StepSpec("join"),  SourceSpec("z_source"), StepSpec("left"),
                 StepSpec("right"), SourceSpec("y_source"), StepSpec("alone")};
  spec.blocks[2].params["offset"] = int64_t{5};
  spec.connections = {Wire("left.sum", "join.a"),       Wire("right.sum", "join.b"),
                      Wire("z_source.value", "left.a"), Wire("z_source.value", "right.a"),
                      Wire("z_source.value", "left.b"), Wire("y_source.value", "alone.a")};
  return spec;
}

std::vector<std::string> Ids(const Sequence& sequence) {
  std::vector<std::string> ids;
  for (const Sequence::Node& node : sequence.nodes()) ids.push_back(node.id);
  return ids;
}

TEST(Sequence, OrdersBlocksSourcesFirstThenById) {
  SequenceSpec spec = DiamondSpec();
  const auto sequence = Sequence::Load(spec, 3).value();
  EXPECT_THAT(Ids(*sequence),
              ElementsAre("y_source", "z_source", "alone", "left", "right", "join"));
  EXPECT_EQ(sequence->revision(), 3u);
  std::reverse(spec.blocks.begin(), spec.blocks.end());
  std::reverse(spec.connections.begin(), spec.connections.end());
  EXPECT_EQ(Ids(*Sequence::Load(spec, 3).value()), Ids(*sequence));
}

TEST(Sequence, WiresPortsThroughSlots) {
  const auto sequence = Sequence::Load(DiamondSpec(), 1).value();
  const Sequence::Node& z_source = sequence->nodes()[1];
  const Sequence::Node& left = sequence->nodes()[3];
  const Sequence::Node& join = sequence->nodes()[5];
  EXPECT_EQ(sequence->slot_count(), 6);
  EXPECT_TRUE(z_source.is_source());
  EXPECT_THAT(z_source.downstream, ElementsAre(3, 4)) << "each once, though it feeds left twice";
  EXPECT_THAT(join.upstream, ElementsAre(3, 4));
  ASSERT_EQ(left.inputs.size(), 2u);
  EXPECT_EQ(left.inputs[0].slot, z_source.first_output_slot);
  EXPECT_EQ(sequence->slot_readers()[z_source.first_output_slot], 3);
  EXPECT_EQ(sequence->slot_readers()[join.first_output_slot], 0);
  EXPECT_EQ(z_source.distance_to_output, 2);
  EXPECT_EQ(join.distance_to_output, 0);
  EXPECT_EQ(join.block->FindInput("a")->source_type(), "integer");
  EXPECT_FALSE(sequence->nodes()[4].block->FindInput("b")->connected());
  EXPECT_EQ(sequence->FindNode("right"), 4);
  EXPECT_EQ(sequence->FindNode("wrong"), -1);
}

TEST(Sequence, HashesAllParameterValues) {
  SequenceSpec spec = DiamondSpec();
  const auto sequence = Sequence::Load(spec, 1).value();
  const std::vector<ParamAssignment> loaded = sequence->Parameters();
  ASSERT_EQ(loaded.size(), 14u);
  EXPECT_EQ(loaded[6], (ParamAssignment{"left", "offset", int64_t{5}}));
  const uint64_t hash = HashParameters(loaded);
  // A value that is written down although it is the initial one changes nothing.
  spec.blocks[0].params["fixed"] = int64_t{1};
  EXPECT_EQ(HashParameters(Sequence::Load(spec, 2).value()->Parameters()), hash);
  spec.blocks[0].params["fixed"] = int64_t{2};
  EXPECT_NE(HashParameters(Sequence::Load(spec, 2).value()->Parameters()), hash);
}

TEST(HashParameters, IsFnv1a) {
  EXPECT_EQ(HashParameters({}), 0xcbf29ce484222325u);
  // FNV-1a 64 of the bytes "a\0b\0\x01" "7\0".
  EXPECT_EQ(HashParameters({{"a", "b", int64_t{7}}}), 0xbc4ccf3aa059a052u);
  EXPECT_NE(HashParameters({{"a", "b", int64_t{7}}}), HashParameters({{"a", "b", 7.0}}));
}

TEST(Sequence, IsRefusedWithAllItsFaults) {
  SequenceSpec spec = DiamondSpec();
  spec.blocks[0].params["fixed"] = true;
  spec.connections.pop_back();
  const auto sequence = Sequence::Load(spec, 1);
  EXPECT_EQ(sequence.error().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(sequence.error().message(), "sequence \"diamond\" has 2 faults");
  EXPECT_EQ(sequence.error().faults().size(), 2u);
}

// Random wiring, with and without faults: what the checker accepts can be loaded in an order in
// which every value comes before it is read, and the checker is never wrong about cycles.
TEST(Sequence, LoadsWhateverTheCheckerAccepts) {
  std::mt19937 random(7);
  int accepted = 0;
  int circular = 0;
  for (int round = 0; round < 3000; ++round) {
    const int blocks = 2 + static_cast<int>(random() % 7);
    SequenceSpec spec;
    spec.id = "random";
    for (int i = 0; i < blocks; ++i) {
      const std::string id(1, static_cast<char>('a' + i));
      spec.blocks.push_back(i < 2 ? SourceSpec(id) : StepSpec(id));
    }
    for (int to = 2; to < blocks; ++to) {
      const int inputs = 1 + static_cast<int>(random() % 2);
      for (int input = 0; input < inputs; ++input) {
        const int reach = random() % 4 == 0 ? blocks : to;  // now and then backwards
        const auto from = static_cast<size_t>(random() % static_cast<unsigned>(reach));
        spec.connections.push_back({spec.blocks[from].id, from < 2 ? "value" : "sum",
                                    spec.blocks[static_cast<size_t>(to)].id,
                                    input == 0 ? "a" : "b"});
      }
    }
    std::shuffle(spec.blocks.begin(), spec.blocks.end(), random);
    const auto sequence = Sequence::Load(spec, 1);
    if (!sequence) {
      ++circular;
      for (const Fault& fault : sequence.error().faults()) {
        ASSERT_NE(fault.message.find("feeds itself"), std::string::npos) << fault.message;
      }
      continue;
    }
    ++accepted;
    for (const Connection& one : spec.connections) {
      ASSERT_LT((*sequence)->FindNode(one.from_block), (*sequence)->FindNode(one.to_block));
    }
  }
  EXPECT_GT(accepted, 500);
  EXPECT_GT(circular, 500);
}

}  // namespace
}  // namespace vs
