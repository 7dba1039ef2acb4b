#pragma once

#include <string_view>

#include "engine/base/status.h"
#include "engine/stereo/sgm_settings.h"

namespace vs::test {

// Sets one field of SgmSettings by "name=value" as written on a command line: a number, true or
// false, or for cost, census and sub_pixel the name of a choice. INVALID_ARGUMENT says what is
// wrong.
Status SetSgmField(std::string_view assignment, SgmSettings* settings);

// Census 5x5 along this many directions and the left-right check, without filters: what others
// publish figures of.
SgmSettings PlainCensus(int directions);

}  // namespace vs::test
