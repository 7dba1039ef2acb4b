#include "engine/core/recent_times.h"

#include <algorithm>

namespace vs {

int64_t Percentile(std::vector<int64_t> values, int percent) {
  if (values.empty()) return 0;
  const size_t rank = (values.size() * percent + 99) / 100;
  const auto place = values.begin() + (rank == 0 ? 0 : rank - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double RatePerSecond(const std::vector<int64_t>& times_ns, int64_t now_ns) {
  constexpr int64_t kWindowNs = 2'000'000'000;
  const auto first = std::lower_bound(times_ns.begin(), times_ns.end(), now_ns - kWindowNs);
  const auto count = times_ns.end() - first;
  if (count < 2) return static_cast<double>(count) * 1e9 / kWindowNs;
  const double intervals = static_cast<double>(count - 1);
  const auto span_ns = static_cast<double>(times_ns.back() - *first);
  const auto since_ns = static_cast<double>(now_ns - times_ns.back());
  if (since_ns > 2 * span_ns / intervals) return (intervals + 1) * 1e9 / (span_ns + since_ns);
  return span_ns == 0 ? 0 : intervals * 1e9 / span_ns;
}

}  // namespace vs
