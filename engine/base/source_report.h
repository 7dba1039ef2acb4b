#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace vs {

// A figure that a source keeps about its own work, since its start unless the name says otherwise.
struct Reading {
  std::string name;  // with its unit: "pairs", "skew_p99_ms"
  std::variant<bool, int64_t, double, std::string> value;

  bool operator==(const Reading&) const = default;
};

// What a source of pictures says of itself to whoever looks for a fault.
struct SourceReport {
  // Why nothing comes, or not all of it: in words that stay the same while the reason does, with
  // the remedy. Empty when all is well.
  std::string problem;
  std::vector<Reading> readings;
};

}  // namespace vs
