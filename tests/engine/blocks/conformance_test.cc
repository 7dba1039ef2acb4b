// What every block owes its users, checked for each type in the registry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/block.h"
#include "engine/core/result_sink.h"
#include "engine/core/sequence_spec.h"
#include "engine/core/topic.h"
#include "tests/support/block_harness.h"
#include "tests/support/synthetic_values.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using test::BlockHarness;

class ForgetfulSink final : public ResultSink {
 public:
  Result<std::string> Log(ResultRecord) override { return std::string("id"); }
};

class OneRig final : public RigStore {
 public:
  Result<std::shared_ptr<const StereoRig>> Find(const std::string&) const override {
    return std::get<std::shared_ptr<const StereoRig>>(
        test::SyntheticValues("stereo_rig").at(0).variant());
  }
};

// What some blocks must be told before they can run here.
const std::map<std::string, std::map<std::string, ParamValue>> kSettings = {
    {"RectifyPair", {{"rig", "synthetic"}}},
    {"SaveImages", {{"min_free_mb", int64_t{0}}}},
    {"StereoDepth", {{"rig", "synthetic"}}}};

// Parameters in the unit of whatever the user connects: no limit could be right for all of them.
const std::set<std::string> kUnlimited = {"RangeCheck.min", "RangeCheck.max",
                                          "RangeCheck.warn_margin"};

std::vector<std::string> AllTypes() {
  std::vector<std::string> types;
  for (const BlockRegistry::Entry* entry : BlockRegistry::Get().All()) types.push_back(entry->type);
  return types;
}

void ExpectSentence(const std::string& text, const std::string& of) {
  ASSERT_GE(text.size(), 10u) << of;
  EXPECT_TRUE(text[0] >= 'A' && text[0] <= 'Z') << of << ": " << text;
  EXPECT_EQ(text.back(), '.') << of << ": " << text;
  EXPECT_EQ(text.find("  "), std::string::npos) << of << ": " << text;
}

// Units that are easily taken for one another, so that a name must say them. Pixels and counts are
// named as the field names them; their unit is in the descriptor.
constexpr const char* kUnitsInNames[] = {"m", "mm", "deg", "rad", "ns", "us", "ms", "s", "Hz"};

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::vector<ParamValue> ValuesThatDoNotFit(const ParamInfo& info) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<ParamValue> values;
  if (std::holds_alternative<bool>(info.initial)) {
    values = {int64_t{1}, 1.0, std::string("true")};
  } else if (std::holds_alternative<int64_t>(info.initial)) {
    values = {true, 1.5, std::string("1"), std::numeric_limits<int64_t>::max(),
              std::numeric_limits<int64_t>::min()};
    if (info.min) values.emplace_back(static_cast<int64_t>(*info.min) - 1);
    if (info.max) values.emplace_back(static_cast<int64_t>(*info.max) + 1);
  } else if (std::holds_alternative<double>(info.initial)) {
    values = {true, std::string("1"), std::nan(""), kInfinity, -kInfinity};
    if (info.min) values.emplace_back(std::nextafter(*info.min, -kInfinity));
    if (info.max) values.emplace_back(std::nextafter(*info.max, kInfinity));
  } else {
    values = {true, int64_t{1}, 1.0, std::string("\x01"), std::string(100'000, 'x')};
    if (!info.choices.empty()) values.emplace_back(std::string("no such choice"));
  }
  return values;
}

class EveryBlock : public ::testing::TestWithParam<std::string> {
 protected:
  static const BlockInfo& info() { return BlockRegistry::Get().Find(GetParam())->info; }

  // As on a server without cameras.
  void Equip(BlockHarness* harness) {
    harness->environment.topics = &topics_;
    harness->environment.results = &sink_;
    harness->environment.folders.data_dir = folder_.path();
    harness->environment.rigs = &rigs_;
    const auto settings = kSettings.find(GetParam());
    if (settings == kSettings.end()) return;
    for (const auto& [param, value] : settings->second) {
      ASSERT_TRUE(harness->Set(param, value).ok()) << param;
    }
  }

  // Connects the inputs, those that can be left out only when asked to, and runs the block, which
  // was not started, on all synthetic values. Ports of type any get values of `any_type`. Gives the
  // number of good runs.
  int RunOnSyntheticValues(BlockHarness* harness, bool with_optional, const std::string& any_type);

  test::TempFolder folder_;
  const OneRig rigs_{};
  TopicHub topics_;
  ForgetfulSink sink_;
};

TEST_P(EveryBlock, DescribesItselfToUsers) {
  EXPECT_TRUE(GetParam()[0] >= 'A' && GetParam()[0] <= 'Z') << "type names are PascalCase";
  static const std::set<std::string> categories = {
      "Acquire", "Prepare", "Stereo", "Vision",      "Space",  "Calibrate", "Robot",
      "Math",    "Logic",   "Script", "Communicate", "Record", "Display"};
  EXPECT_EQ(categories.count(info().category), 1u) << info().category;
  ExpectSentence(info().doc, GetParam());
  BlockHarness harness(GetParam());
  for (const auto* ports : {&harness.block().inputs(), &harness.block().outputs()}) {
    for (const PortBase* port : *ports) ExpectSentence(port->info().doc, port->info().name);
  }
  for (const ParamBase* param : harness.block().params()) {
    ExpectSentence(param->info().doc, param->info().name);
  }
}

TEST_P(EveryBlock, NamesItsPortsAndParametersOnceAndWithTheirUnits) {
  BlockHarness harness(GetParam());
  for (const auto* ports : {&harness.block().inputs(), &harness.block().outputs()}) {
    std::set<std::string> names;
    for (const PortBase* port : *ports) {
      EXPECT_TRUE(IsSequenceId(port->info().name)) << port->info().name;
      EXPECT_TRUE(names.insert(port->info().name).second) << port->info().name;
    }
  }
  std::set<std::string> names;
  for (const ParamBase* param : harness.block().params()) {
    const ParamInfo& one = param->info();
    EXPECT_TRUE(IsSequenceId(one.name)) << one.name;
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    for (const std::string unit : kUnitsInNames) {
      const std::string end = unit == "Hz" ? "_hz" : "_" + unit;
      EXPECT_EQ(EndsWith(one.name, end), one.unit == unit) << one.name << " in " << one.unit;
    }
  }
}

TEST_P(EveryBlock, StartsWithParametersThatFitAndRefusesOthers) {
  BlockHarness harness(GetParam());
  EXPECT_TRUE(harness.block().CheckParams().ok());
  for (ParamBase* param : harness.block().params()) {
    const ParamInfo& one = param->info();
    SCOPED_TRACE(one.name);
    EXPECT_EQ(param->Get(), one.initial);
    EXPECT_TRUE(param->Check(one.initial).ok()) << param->Check(one.initial).ToString();
    EXPECT_TRUE(!one.min || !one.max || *one.min < *one.max);
    const bool is_number =
        std::holds_alternative<int64_t>(one.initial) || std::holds_alternative<double>(one.initial);
    EXPECT_EQ(is_number && !kUnlimited.contains(GetParam() + "." + one.name),
              one.min.has_value() && one.max.has_value());
    EXPECT_EQ(std::set<std::string>(one.choices.begin(), one.choices.end()).size(),
              one.choices.size());
    for (const ParamValue& value : ValuesThatDoNotFit(one)) {
      const Status refused = param->Set(value);
      EXPECT_FALSE(refused.ok()) << ToString(value).substr(0, 40);
      EXPECT_NE(refused.message().find(one.name), std::string::npos) << refused.message();
      EXPECT_EQ(param->Get(), one.initial);
    }
  }
}

TEST_P(EveryBlock, CanBeDroppedAtAnyMoment) {
  { const auto never_attached = BlockRegistry::Get().Find(GetParam())->make(); }
  BlockHarness harness(GetParam());
  harness.block().Attach(&harness.environment, harness.frame.run, [] {});
  harness.block().Stop();
  harness.block().Stop();
  harness.block().Dropped();
  EXPECT_EQ(harness.block().Report().problem, "");
}

// What it does not miss when it starts, it must not miss when it runs.
TEST_P(EveryBlock, SaysWhatItLacksInAnEmptyHouse) {
  BlockHarness harness(GetParam());
  const Status status = harness.Start();
  if (!status.ok()) {
    const std::set<StatusCode> expected = {StatusCode::kFailedPrecondition, StatusCode::kNotFound,
                                           StatusCode::kInvalidArgument};
    EXPECT_EQ(expected.count(status.code()), 1u) << status.ToString();
    EXPECT_FALSE(status.message().empty());
  } else if (harness.block().inputs().empty()) {
    EXPECT_TRUE(harness.Run().ok());
  } else {
    int good_runs = 0;
    for (const std::string any_type : {"number", "stereo_frame"}) {
      BlockHarness empty_house(GetParam());
      good_runs += RunOnSyntheticValues(&empty_house, true, any_type);
    }
    EXPECT_GT(good_runs, 0) << "it started, but does not run";
  }
  harness.block().Stop();
}

int EveryBlock::RunOnSyntheticValues(BlockHarness* harness, bool with_optional,
                                     const std::string& any_type) {
  std::map<std::string, std::vector<Value>> values;
  size_t rounds = 0;
  for (const PortBase* input : harness->block().inputs()) {
    const PortInfo& port = input->info();
    const bool wanted = port.need == Need::kRequired || (port.need == Need::kSome && rounds == 0);
    if (!wanted && !with_optional) continue;
    const std::vector<Value> made_up =
        test::SyntheticValues(port.type == PortType<Value>::kName ? any_type : port.type);
    if (made_up.empty()) throw std::invalid_argument("no synthetic " + std::string(port.type));
    harness->Input(port.name, made_up[0]);
    rounds = std::max(rounds, made_up.size());
    values[port.name] = made_up;
  }
  if (const Status started = harness->Start(); !started.ok()) {
    EXPECT_FALSE(started.message().empty());
    return 0;
  }
  int good_runs = 0;
  for (size_t round = 0; round < rounds; ++round) {
    SCOPED_TRACE(round);
    std::map<std::string, uint64_t> before;
    for (const auto& [port, made_up] : values) {
      const Value& value = made_up[round % made_up.size()];
      before[port] = test::HashOf(value);
      harness->Input(port, value);
    }
    const Status status = harness->Run();
    for (const auto& [port, made_up] : values) {
      EXPECT_EQ(test::HashOf(made_up[round % made_up.size()]), before[port]) << port;
    }
    if (!status.ok()) {
      EXPECT_FALSE(status.message().empty());
      continue;
    }
    ++good_runs;
    for (const PortBase* output : harness->block().outputs()) {
      const Value& result = harness->Output(output->info().name);
      EXPECT_TRUE(result.empty() || PortTypesFit(TypeName(result), output->info().type))
          << output->info().name << " gave " << TypeName(result);
    }
  }
  return good_runs;
}

// Sources have no inputs that could be made up; their own tests run them.
TEST_P(EveryBlock, HandlesAllInputsAndLeavesThemUnchanged) {
  if (BlockHarness(GetParam()).block().inputs().empty()) return;
  int good_runs = 0;
  for (const bool with_optional : {true, false}) {
    for (const std::string any_type : {"number", "stereo_frame"}) {
      SCOPED_TRACE(any_type + (with_optional ? ", all inputs" : ", required inputs"));
      BlockHarness harness(GetParam());
      Equip(&harness);
      good_runs += RunOnSyntheticValues(&harness, with_optional, any_type);
    }
  }
  EXPECT_GT(good_runs, 0) << "nothing made up suits it: see kSettings and SyntheticValues";
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryBlock, ::testing::ValuesIn(AllTypes()),
                         [](const auto& type) { return type.param; });

TEST(BlockRegistry, HasTheBlocks) { EXPECT_FALSE(AllTypes().empty()); }

}  // namespace
}  // namespace vs
