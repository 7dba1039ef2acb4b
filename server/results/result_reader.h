#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/results/stored_result.h"
#include "server/storage/sqlite.h"

namespace vs {

// Some of the results that were asked for, in order: as many as were wanted, or fewer when they are
// large.
struct ResultPage {
  std::vector<StoredResult> results;
  bool more = false;  // there are others behind them
};

// Reads the results of a ResultStore, through a connection of its own. Thread-safe; calls wait for
// each other and for the disk, so make them on a thread that may wait. Each call costs a look-up
// by key, however many results lie before it, and gives at most about kMaxPageBytes at once.
class ResultReader {
 public:
  // Half of what gRPC's clients take in one message.
  static constexpr size_t kMaxPageBytes = 2u << 20;

  // The store must exist.
  static Result<std::unique_ptr<ResultReader>> Open(const std::filesystem::path& file);

  // NOT_FOUND.
  Result<StoredResult> Get(const std::string& result_id) VS_EXCLUDES(mutex_);
  // Newest first, those with a number below `before` (absent: from the newest on).
  Result<ResultPage> Before(const ResultFilter& filter, std::optional<uint64_t> before,
                            size_t limit) VS_EXCLUDES(mutex_);
  // Oldest first, those with a number above `after` and up to `last`.
  Result<ResultPage> After(const ResultFilter& filter, uint64_t after, uint64_t last, size_t limit)
      VS_EXCLUDES(mutex_);

 private:
  explicit ResultReader(Database database) : database_(std::move(database)) {}

  Mutex mutex_;
  Database database_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
