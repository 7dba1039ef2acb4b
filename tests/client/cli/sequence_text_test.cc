#include "client/cli/sequence_text.h"

#include <gtest/gtest.h>

namespace vs::cli {
namespace {

constexpr char kText[] = R"({
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
        "adaptive": true,
        "cost": "census",
        "p2": 96,
        "uniqueness": 0.5
      },
      "type": "SgmStereo",
      "x": 12.5,
      "y": -3.0
    }
  ],
  "connections": [
    {
      "from": "camera.pair",
      "to": "match.pair"
    }
  ],
  "description": "Depth.",
  "id": "stereo",
  "max_frames_in_flight": 2,
  "priority": -1
}
)";

std::string FaultOf(const std::string& text) {
  const client::Result<NamedSpec> read = SequenceFromJson(text);
  return read ? "no fault" : read.error().message;
}

TEST(SequenceText, SurvivesTheWayThereAndBack) {
  const client::Result<NamedSpec> read = SequenceFromJson(kText);
  ASSERT_TRUE(read) << read.error().ToString();
  EXPECT_EQ("stereo", read->id);
  const auto& params = read->spec.blocks(1).parameters();
  EXPECT_EQ(96, params.at("p2").int_value());
  EXPECT_EQ(0.5, params.at("uniqueness").double_value());
  EXPECT_EQ("census", params.at("cost").string_value());
  EXPECT_TRUE(params.at("adaptive").bool_value());
  EXPECT_EQ(kText, SequenceToJson("stereo", read->spec));
}

TEST(SequenceText, NeedsOnlyIdAndTypeOfABlock) {
  const auto read = SequenceFromJson(R"({"blocks": [{"id": "a", "type": "Camera"}]})");
  ASSERT_TRUE(read) << read.error().ToString();
  EXPECT_EQ("", read->id);
  EXPECT_EQ("Camera", read->spec.blocks(0).type());
}

TEST(SequenceText, NamesThePlaceOfAFault) {
  EXPECT_EQ("the sequence is no object {...}", FaultOf("[]"));
  EXPECT_EQ("the sequence has no \"block\"", FaultOf(R"({"block": []})"));
  EXPECT_EQ("the sequence.blocks is no list [...]", FaultOf(R"({"blocks": {}})"));
  EXPECT_EQ("blocks[0] lacks \"type\"", FaultOf(R"({"blocks": [{"id": "a"}]})"));
  EXPECT_EQ("blocks[0].params.p2 is no number, text, true or false",
            FaultOf(R"({"blocks": [{"id": "a", "type": "B", "params": {"p2": [1]}}]})"));
  EXPECT_EQ("connections[0].to is no text",
            FaultOf(R"({"connections": [{"from": "a.b", "to": 1}]})"));
  EXPECT_EQ("the sequence.priority is no whole number of a sensible size",
            FaultOf(R"({"priority": 99999999999})"));
  EXPECT_EQ(0U, FaultOf("{\n  \"id\": }").find("parse error at line 2, column"));
}

TEST(SequenceText, SaysThatAFileIsMissing) {
  const auto read = ReadSequenceFile("/no/such/file.json");
  ASSERT_FALSE(read);
  EXPECT_EQ(client::Code::kNotFound, read.error().code);
}

}  // namespace
}  // namespace vs::cli
