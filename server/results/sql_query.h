#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/storage/sqlite.h"

namespace vs {

struct SqlBlob {
  std::string bytes;

  bool operator==(const SqlBlob&) const = default;
};
using SqlValue = std::variant<std::monostate, int64_t, double, std::string, SqlBlob>;

struct SqlTable {
  std::vector<std::string> columns;  // unique; a second "n" becomes "n_2"
  std::vector<std::vector<SqlValue>> rows;
  bool truncated = false;  // there were more than max_rows
};

struct SqlLimits {
  size_t max_rows = 1000;
  std::chrono::milliseconds timeout{5000};
  std::optional<int64_t> since_ns;     // monotonic, when the timeout began; absent: at the call
  size_t max_answer_bytes = 3u << 20;  // below what gRPC clients accept unless told otherwise
  size_t max_work_bytes = 64u << 20;   // memory for sorting and grouping
};

// Runs SELECT statements of strangers over the tables of results (see result_schema.h) without
// letting them write, reach other files or take more than their share. As many at a time as it has
// connections: the others wait within their own time limit. Thread-safe.
class SqlQuery {
 public:
  // The store must exist. `connections`: 1 or more.
  static Result<std::unique_ptr<SqlQuery>> Open(const std::filesystem::path& file,
                                                const Clock& clock, int connections = 1);
  ~SqlQuery();

  // `arguments` are bound to ?1, ?2 ...; `cancelled` is asked now and then. INVALID_ARGUMENT for
  // what is not one SELECT or names what is not there, PERMISSION_DENIED for what a query must not
  // touch, DEADLINE_EXCEEDED, RESOURCE_EXHAUSTED, CANCELLED.
  Result<SqlTable> Run(const std::string& sql, const std::vector<SqlValue>& arguments,
                       const SqlLimits& limits, const std::function<bool()>& cancelled)
      VS_EXCLUDES(mutex_);

 private:
  struct Watch;
  class Turn;

  SqlQuery(std::vector<Database> databases, const Clock& clock);
  // Waits for one. What `watch` finds meanwhile.
  Result<Database> TakeConnection(const Watch& watch) VS_EXCLUDES(mutex_);

  const Clock& clock_;
  Mutex mutex_;
  CondVar given_back_;
  std::vector<Database> free_ VS_GUARDED_BY(mutex_);  // the connections that nobody uses
};

}  // namespace vs
