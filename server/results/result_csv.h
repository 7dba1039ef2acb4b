#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/results/stored_result.h"

namespace vs {

// `text` as one field of a CSV line (RFC 4180): in quotes where it needs them.
std::string CsvField(std::string_view text);

// Results as CSV (RFC 4180: lines end with CR LF), one column for each measured value behind the
// fixed ones. Times are UTC in ISO 8601, durations milliseconds.
class ResultCsv {
 public:
  // `field_names`: of all results that will be written; others are left out.
  explicit ResultCsv(const std::set<std::string>& field_names);

  std::string Header() const;
  std::string Row(const StoredResult& result) const;

 private:
  std::vector<std::string> field_names_;
};

}  // namespace vs
