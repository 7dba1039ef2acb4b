#pragma once

#include <string>
#include <vector>

#include "visionserver/v1/camera.pb.h"
#include "visionserver/v1/sequence.pb.h"
#include "visionserver/v1/value.pb.h"

#include "client/error.h"

namespace vs::cli {

struct NameAndText {
  std::string name;
  std::string text;
};

// "a", "1", "b", "2" as (a, 1), (b, 2). INVALID_ARGUMENT for an odd number; `form` says how it
// goes.
client::Result<std::vector<NameAndText>> InPairs(const std::vector<std::string>& words,
                                                 const std::string& form);

// The text as a value of the parameter's or feature's type: true, on, yes, 1 and their opposites;
// 12; 0.5; any text. INVALID_ARGUMENT says what was expected.
client::Result<visionserver::v1::Value> ParseParameter(const NameAndText& setting,
                                                       const visionserver::v1::ParameterInfo& info);
client::Result<visionserver::v1::Value> ParseFeature(const NameAndText& setting,
                                                     visionserver::v1::FeatureType type);

}  // namespace vs::cli
