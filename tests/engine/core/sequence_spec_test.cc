#include "engine/core/sequence_spec.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

namespace vs {
namespace {

SequenceSpec StereoSpec() {
  SequenceSpec spec;
  spec.id = "stereo_depth";
  spec.description = "Depth of the demo cell, \"live\" \xc3\xa4.";
  spec.priority = -2;
  spec.max_frames_in_flight = 3;
  spec.blocks = {{"match",
                  "SgmStereo",
                  {{"backend", std::string("reference")},
                   {"median", true},
                   {"p1", int64_t{10}},
                   {"uniqueness", 0.1}},
                  320,
                  80.5},
                 {"camera", "StereoCamera", {}, 0, 0}};
  spec.connections = {{"match", "disparity", "depth", "disparity"},
                      {"camera", "pair", "match", "pair"}};
  return spec;
}

// As StereoSpec() must be written, byte for byte.
constexpr char kStereoJson[] = R"({
  "blocks": [
    {
      "id": "camera",
      "params": {},
      "type": "StereoCamera",
      "x": 0.0,
      "y": 0.0
    },
    {
      "id": "match",
      "params": {
        "backend": "reference",
        "median": true,
        "p1": 10,
        "uniqueness": 0.1
      },
      "type": "SgmStereo",
      "x": 320.0,
      "y": 80.5
    }
  ],
  "connections": [
    {
      "from": "camera.pair",
      "to": "match.pair"
    },
    {
      "from": "match.disparity",
      "to": "depth.disparity"
    }
  ],
  "description": "Depth of the demo cell, \"live\" ä.",
  "id": "stereo_depth",
  "max_frames_in_flight": 3,
  "priority": -2
}
)";

std::string FaultsOf(std::string_view json) {
  const auto spec = ParseSequence(json);
  if (spec.has_value()) return "none";
  EXPECT_EQ(spec.error().code(), StatusCode::kInvalidArgument);
  std::string text;
  for (const Fault& fault : spec.error().faults()) {
    text += (text.empty() ? "" : "; ") + fault.subject + ": " + fault.message;
  }
  return text;
}

TEST(SequenceJson, IsCanonical) {
  SequenceSpec spec = StereoSpec();
  EXPECT_EQ(ToJson(spec), kStereoJson);
  std::swap(spec.blocks[0], spec.blocks[1]);
  std::swap(spec.connections[0], spec.connections[1]);
  EXPECT_EQ(ToJson(spec), kStereoJson);
  EXPECT_EQ(ParseSequence(kStereoJson).value(), spec) << "canonical order is sorted order";
}

TEST(SequenceJson, HasALatencyBudgetOnlyIfThereIsOne) {
  SequenceSpec spec = StereoSpec();
  EXPECT_EQ(ToJson(spec).find("latency_budget_ms"), std::string::npos);
  spec.latency_budget_ms = 62.5;
  EXPECT_NE(ToJson(spec).find("\"latency_budget_ms\": 62.5"), std::string::npos);
  EXPECT_EQ(ParseSequence(ToJson(spec)).value().latency_budget_ms, 62.5);
}

TEST(SequenceJson, KeepsTheOrderOfTheText) {
  const auto spec = ParseSequence(
      R"({"id": "s", "blocks": [{"id": "b", "type": "T"}, {"id": "a", "type": "T"}]})");
  EXPECT_EQ(spec.value().blocks[0].id, "b");
  EXPECT_EQ(spec.value().max_frames_in_flight, 2) << "what is left out has its usual value";
}

TEST(SequenceJson, KeepsEveryNumberExactly) {
  SequenceSpec spec;
  spec.id = "numbers";
  spec.blocks = {{"a",
                  "T",
                  {{"big", std::numeric_limits<int64_t>::max()},
                   {"small", std::numeric_limits<int64_t>::min()},
                   {"third", 1.0 / 3.0},
                   {"tiny", DBL_TRUE_MIN},
                   {"huge", DBL_MAX},
                   {"whole", 3.0},
                   {"integer", int64_t{3}}}}};
  EXPECT_EQ(ParseSequence(ToJson(spec)).value(), spec);
  EXPECT_NE(ToJson(spec).find("\"third\": 0.3333333333333333,"), std::string::npos);
}

TEST(SequenceJson, SaysWhereTheSyntaxIsWrong) {
  EXPECT_EQ(FaultsOf("{\n  \"id\": \"s\",\n  id: 3\n}"),
            "line 3, column 3: syntax error while parsing object key - invalid literal");
  EXPECT_EQ(FaultsOf(""),
            "line 1, column 1: syntax error while parsing value - unexpected end of "
            "input; expected '[', '{', or a literal");
  EXPECT_NE(FaultsOf("{\"id\": \"\xff\"}").find("line 1, column 9: "), std::string::npos);
  EXPECT_NE(FaultsOf("{\"id\": \"s\", \"x\": 1e999}").find("line 1, column "), std::string::npos);
  EXPECT_NE(FaultsOf("{\"id\": \"s\"} trailing").find("line 1, column 1"), std::string::npos);
}

TEST(SequenceJson, NamesEveryPlaceThatIsWrong) {
  EXPECT_EQ(FaultsOf(R"({"id": 7, "priority": 1.5, "colour": "red",
                         "blocks": [{"id": "a", "type": "T", "params": {"p": [1], "q": null}},
                                    {"type": true, "x": "left"}, 3],
                         "connections": [{"from": "a", "to": "b.c"}, {"from": "a.b.c"}]})"),
            "blocks[0].params.p: must be true, false, a number or a text, not an array; "
            "blocks[0].params.q: must be true, false, a number or a text, not null; "
            "blocks[1].type: must be a text, not true; "
            "blocks[1].x: must be a number, not \"left\"; "
            "blocks[1]: needs \"id\"; "
            "blocks[2]: must be an object, not 3; "
            "sequence: has no \"colour\": remove it; "
            "connections[0].from: must be \"block.port\", not \"a\"; "
            "connections[1].from: must be \"block.port\", not \"a.b.c\"; "
            "connections[1]: needs \"to\"; "
            "id: must be a text, not 7; "
            "priority: must be an integer, not 1.5");
  EXPECT_EQ(FaultsOf("[]"), "sequence: must be an object, not an array");
  EXPECT_EQ(FaultsOf(R"({"id": "s", "priority": 4294967296})"),
            "priority: must be a 32-bit integer, not 4294967296");
}

TEST(SequenceJson, RefusesKeysThatAreThereTwice) {
  EXPECT_EQ(FaultsOf(R"({"id": "a", "id": "b"})"), "id: is there twice");
  EXPECT_EQ(FaultsOf(R"({"id": "a", "blocks": [{}, {"params": {"p1": 1, "p2": 2, "p1": 3}}]})"),
            "blocks[1].params.p1: is there twice");
  EXPECT_EQ(FaultsOf(R"({"": 1, "": 2})"), ": is there twice");
}

TEST(SequenceJson, BoundsDepthAndSize) {
  EXPECT_EQ(FaultsOf(std::string(100'000, '[')), "[0][0][0][0][0][0][0][0]: is nested too deeply");
  EXPECT_EQ(ParseSequence(std::string(kMaxSequenceBytes + 1, ' ')).error().message(),
            "a sequence may have at most 1048576 bytes, not 1048577");
  std::string many = R"({"id": "s", "blocks": [)";
  while (many.size() < kMaxSequenceBytes - 10) many += "{},";
  const auto refused = ParseSequence(many + "{}]}");
  EXPECT_EQ(refused.error().faults().size(), 100u) << "enough to show";
}

TEST(SequenceJson, NeverWritesWhatIsNotUtf8) {
  SequenceSpec spec;
  spec.id = "s";
  spec.description = "\xff\xc3";
  EXPECT_EQ(ParseSequence(ToJson(spec)).value().description, "\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(SequenceJson, SurvivesDamagedText) {
  std::mt19937 random(1);
  const std::string alphabet = "{}[]\",:.-0123456789etrufalsnid_\\ \n\x01\x7f\xc3\xff";
  int accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::string text = kStereoJson;
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < changes; ++i) {
      const size_t at = random() % text.size();
      const char c = alphabet[random() % alphabet.size()];
      switch (random() % 4) {
        case 0:
          text[at] = c;
          break;
        case 1:
          text.insert(at, 1, c);
          break;
        case 2:
          text.erase(at, 1 + random() % 40);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 60));
      }
      if (text.empty()) text = "{";
    }
    const auto spec = ParseSequence(text);
    if (!spec.has_value()) {
      ASSERT_FALSE(spec.error().faults().empty());
      continue;
    }
    ++accepted;
    const std::string canonical = ToJson(*spec);
    ASSERT_EQ(ToJson(ParseSequence(canonical).value()), canonical);
  }
  EXPECT_GT(accepted, 100) << "some damage leaves a valid sequence, or nothing is tested";
}

TEST(SequenceId, IsASmallWord) {
  EXPECT_TRUE(IsSequenceId("a"));
  EXPECT_TRUE(IsSequenceId("stereo_depth2"));
  EXPECT_TRUE(IsSequenceId(std::string(63, 'a')));
  for (const char* bad : {"", "2d", "_a", "A", "a-b", "a.b", "a b", "\xc3\xa4"}) {
    EXPECT_FALSE(IsSequenceId(bad)) << bad;
  }
  EXPECT_FALSE(IsSequenceId(std::string(64, 'a')));
}

}  // namespace
}  // namespace vs
