// Logs results without end into the store given as argument, and prints each number as soon as the
// store says that it is kept. For the test that kills it.

#include <cstdio>
#include <mutex>

#include "engine/base/clock.h"
#include "server/results/result_store.h"

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  const vs::SystemClock clock;
  auto store = vs::ResultStore::Open(
      arguments[1], clock,
      {.commit_interval = std::chrono::milliseconds(1), .rows_per_commit = 50});
  if (!store.has_value()) {
    std::fprintf(stderr, "%s\n", store.error().ToString().c_str());
    return 1;
  }
  const auto handle = (*store)->OnCommitted([](uint64_t last_number) {
    std::printf("kept %llu\n", static_cast<unsigned long long>(last_number));
    std::fflush(stdout);
  });
  while (true) {
    vs::ResultRecord record;
    record.job_id = "crash";
    record.values = {{"filler", std::string(200, 'x')}};
    (void)(*store)->Log(std::move(record));  // a full queue is part of the exercise
  }
}
