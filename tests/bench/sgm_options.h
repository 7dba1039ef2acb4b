#pragma once

#include <string_view>

#include "engine/base/status.h"
#include "engine/stereo/sgm_settings.h"

namespace vs::test {

// Sets one field of SgmSettings by "name=value" as written on a command line: a number, true or
// false, or for cost, census and sub_pixel the name of a choice. INVALID_ARGUMENT says what is
// wrong.
Status SetSgmField(std::string_view assignment, SgmSettings* settings);

}  // namespace vs::test
