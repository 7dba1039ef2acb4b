#include "engine/calibration/rig_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/engine/calibration/sample_rig.h"

namespace vs {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

// `text` with its first `from` replaced.
std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

Status ErrorOf(const std::string& text) {
  const auto rig = ParseRig(text);
  EXPECT_FALSE(rig.has_value()) << text;
  return rig.has_value() ? Status() : rig.error();
}

std::vector<std::string> SubjectsOf(const std::string& text) {
  std::vector<std::string> subjects;
  const Status error = ErrorOf(text);
  for (const Fault& fault : error.faults()) subjects.push_back(fault.subject);
  return subjects;
}

TEST(RigJson, IsCanonicalAndReadable) {
  StereoRig rig = SampleRig();
  rig.right_from_left_rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_EQ(FormatRig(rig), R"({
  "format": "visionserver.stereo_rig",
  "left": {
    "cx_px": 655.5,
    "cy_px": 478.25,
    "fx_px": 1066.5,
    "fy_px": 1067.25,
    "height": 966,
    "k1": -0.12,
    "k2": 0.08,
    "k3": -0.01,
    "p1": 0.0004,
    "p2": -0.0003,
    "width": 1296
  },
  "name": "sample",
  "right": {
    "cx_px": 641.0,
    "cy_px": 478.25,
    "fx_px": 1064.0,
    "fy_px": 1067.25,
    "height": 966,
    "k1": -0.125,
    "k2": 0.08,
    "k3": -0.01,
    "p1": 0.0004,
    "p2": -0.0003,
    "width": 1296
  },
  "right_from_left": {
    "rotation": [
      1.0,
      0.0,
      0.0,
      0.0,
      1.0,
      0.0,
      0.0,
      0.0,
      1.0
    ],
    "translation_m": [
      -0.12,
      0.001,
      0.002
    ]
  },
  "version": 1
}
)");
}

TEST(RigJson, ReadsBackExactly) {
  StereoRig rig = SampleRig();
  rig.name = "Zelle \"3\" \xc3\xa4\n";
  rig.left.k1 = 1.0 / 3;
  rig.left.p1 = -5e-324;
  const auto read = ParseRig(FormatRig(rig));
  ASSERT_TRUE(read.has_value()) << read.error().ToString();
  EXPECT_EQ(*read, rig);
  EXPECT_EQ(FormatRig(*read), FormatRig(rig));
}

TEST(RigJson, NamesAllFaultsAtOnce) {
  std::string text = FormatRig(SampleRig());
  text = Replaced(text, "\"cx_px\": 655.5", "\"cx\": 655.5");
  text = Replaced(text, "\"fx_px\": 1066.5", "\"fx_px\": \"1066.5\"");
  text = Replaced(text, "\"height\": 966", "\"height\": 966.5");
  text = Replaced(text, "\"fx_px\": 1064.0", "\"fx_px\": -1064.0");
  text = Replaced(text, "\"version\": 1", "\"version\": 2");
  const Status error = ErrorOf(text);
  EXPECT_EQ(error.message(), "stereo rig file: 6 fields are wrong");
  EXPECT_THAT(error.faults(), Contains(Fault{"version", "is 2; this program reads version 1"}));
  EXPECT_THAT(error.faults(), Contains(Fault{"left.cx_px", "is missing"}));
  EXPECT_THAT(error.faults(), Contains(Fault{"left.cx", "is unknown; remove or correct it"}));
  EXPECT_THAT(error.faults(), Contains(Fault{"left.fx_px", "must be a number, is \"1066.5\""}));
  EXPECT_THAT(error.faults(), Contains(Fault{"left.height", "must be a whole number, is 966.5"}));
  EXPECT_THAT(error.faults(), Contains(Field(&Fault::subject, "right.fx_px")));
}

TEST(RigJson, FindsDoubledKeys) {
  EXPECT_THAT(SubjectsOf(Replaced(FormatRig(SampleRig()), "\"k1\": -0.12,",
                                  "\"k1\": -0.12, \"k1\": -0.13,")),
              ElementsAre("k1"));
}

TEST(RigJson, WantsListsOfTheRightLengthAndType) {
  const std::string text = FormatRig(SampleRig());
  EXPECT_THAT(SubjectsOf(Replaced(text, "0.001,\n", "")),
              ElementsAre("right_from_left.translation_m"));
  EXPECT_THAT(SubjectsOf(Replaced(text, "0.001,\n", "null,\n")),
              ElementsAre("right_from_left.translation_m[1]"));
}

TEST(RigJson, SaysWhereTextIsNoJson) {
  const Status error = ErrorOf("{\n  \"format\": ,\n}");
  EXPECT_THAT(error.message(), HasSubstr("line 2, column 13"));
}

// Whatever the text, there is an error and no crash.
TEST(RigJson, SurvivesMalformedTexts) {
  const std::string good = FormatRig(SampleRig());
  for (const std::string& text :
       {std::string(),
        std::string("null"),
        std::string("[]"),
        std::string("7"),
        std::string("\"rig\""),
        std::string("{}"),
        std::string("{\"left\": []}"),
        std::string("{\"left\": {}, \"right\": 1, \"right_from_left\": null}"),
        std::string("\xff\xfe\x00x", 4),
        good + "x",
        "\xef\xbb\xbf" + good.substr(0, 100),
        Replaced(good, "655.5", "1e999"),
        Replaced(good, "655.5", "NaN"),
        Replaced(good, "\"width\": 1296", "\"width\": 99999999999"),
        Replaced(good, "\"width\": 1296", "\"width\": -99999999999"),
        Replaced(good, "\"sample\"", "\"\xff\""),
        Replaced(good, "\"sample\"", "{}"),
        std::string(100000, '['),
        std::string(60000, '['),
        std::string(60000, '{')}) {
    const auto rig = ParseRig(text);
    ASSERT_FALSE(rig.has_value()) << text.substr(0, 200);
    EXPECT_EQ(rig.error().code(), StatusCode::kInvalidArgument);
  }
  for (size_t length = 0; length + 2 < good.size(); length += 7) {
    EXPECT_FALSE(ParseRig(good.substr(0, length)).has_value()) << length;
  }
}

}  // namespace
}  // namespace vs
