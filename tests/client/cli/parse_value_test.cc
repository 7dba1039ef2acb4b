#include "client/cli/parse_value.h"

#include <gtest/gtest.h>

#include "client/values.h"

namespace vs::cli {
namespace {

namespace v1 = ::visionserver::v1;
using client::ToText;

std::string Parameter(v1::ParameterType type, const std::string& text) {
  v1::ParameterInfo info;
  info.set_type(type);
  const client::Result<v1::Value> value = ParseParameter({"match.p2", text}, info);
  return value ? ToText(*value) : value.error().message;
}

TEST(ParseValue, ReadsEachTypeOfParameter) {
  EXPECT_EQ("true", Parameter(v1::PARAMETER_TYPE_BOOL, "on"));
  EXPECT_EQ("false", Parameter(v1::PARAMETER_TYPE_BOOL, "0"));
  EXPECT_EQ("-7", Parameter(v1::PARAMETER_TYPE_INT, "-7"));
  EXPECT_EQ("0.25", Parameter(v1::PARAMETER_TYPE_DOUBLE, "0.25"));
  EXPECT_EQ("1e-07", Parameter(v1::PARAMETER_TYPE_DOUBLE, "1e-7"));
  EXPECT_EQ("12", Parameter(v1::PARAMETER_TYPE_STRING, "12"));
  EXPECT_EQ("census", Parameter(v1::PARAMETER_TYPE_CHOICE, "census"));
}

TEST(ParseValue, SaysWhatItExpected) {
  EXPECT_EQ("match.p2 takes a whole number, not \"1.5\"", Parameter(v1::PARAMETER_TYPE_INT, "1.5"));
  EXPECT_EQ("match.p2 takes a whole number, not \"99999999999999999999\"",
            Parameter(v1::PARAMETER_TYPE_INT, "99999999999999999999"));
  EXPECT_EQ("match.p2 takes a number, not \"12px\"", Parameter(v1::PARAMETER_TYPE_DOUBLE, "12px"));
  EXPECT_EQ("match.p2 takes a number, not \"nan\"", Parameter(v1::PARAMETER_TYPE_DOUBLE, "nan"));
  EXPECT_EQ("match.p2 takes true or false, not \"\"", Parameter(v1::PARAMETER_TYPE_BOOL, ""));
}

TEST(ParseValue, ReadsFeaturesByTheirType) {
  EXPECT_TRUE(ParseFeature({"UserSetLoad", "1"}, v1::FEATURE_TYPE_COMMAND)->bool_value());
  EXPECT_EQ(8000, ParseFeature({"Exposure", "8000"}, v1::FEATURE_TYPE_FLOAT)->double_value());
  EXPECT_EQ("Off", ParseFeature({"Mode", "Off"}, v1::FEATURE_TYPE_ENUMERATION)->string_value());
  EXPECT_FALSE(ParseFeature({"Width", "wide"}, v1::FEATURE_TYPE_INTEGER));
}

TEST(ParseValue, PairsNamesAndValues) {
  const auto pairs = InPairs({"a.b", "1", "c.d", "2"}, "BLOCK.PARAM VALUE");
  ASSERT_EQ(2U, pairs->size());
  EXPECT_EQ("c.d", (*pairs)[1].name);
  EXPECT_EQ("2", (*pairs)[1].text);
  EXPECT_EQ(client::Code::kInvalidArgument, InPairs({"a.b"}, "BLOCK.PARAM VALUE").error().code);
}

}  // namespace
}  // namespace vs::cli
