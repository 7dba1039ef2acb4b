#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/status.h"

namespace vs {

// A page token is the number of the last item of the page before; nothing for the first page.
// INVALID_ARGUMENT for any other text.
Result<std::optional<uint64_t>> ParsePageToken(const std::string& token);

}  // namespace vs
