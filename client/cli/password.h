#pragma once

#include <string>

#include "client/error.h"

namespace vs::cli {

// Asks on the terminal, without showing what is typed. FAILED_PRECONDITION when there is no
// terminal; `instead` is the option that does without one.
client::Result<std::string> AskPassword(const std::string& question, const std::string& instead);

// The next line of standard input. INVALID_ARGUMENT when there is none.
client::Result<std::string> ReadPasswordLine();

}  // namespace vs::cli
