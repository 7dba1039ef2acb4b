#include "server/results/result_schema.h"

#include <array>
#include <string_view>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"
#include "server/results/uuid.h"
#include "server/storage/atomic_file.h"

namespace vs {
namespace {

// Released steps never change: a new version is one more step at the end.
constexpr std::array<std::string_view, 1> kMigrations = {R"sql(
  CREATE TABLE store (epoch TEXT NOT NULL);
  CREATE TABLE result (
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    result_id TEXT NOT NULL UNIQUE,
    job_id TEXT NOT NULL,
    part_id TEXT NOT NULL,
    meas_id TEXT NOT NULL,
    sequence_revision INTEGER NOT NULL,
    parameter_hash TEXT NOT NULL,
    frame_number INTEGER NOT NULL,
    creation_time_ns INTEGER NOT NULL,
    acquisition_time_ns INTEGER,
    processing_ns INTEGER NOT NULL,
    result_state TEXT NOT NULL CHECK (result_state IN ('completed', 'aborted', 'failed')),
    result_class TEXT NOT NULL CHECK (result_class IN ('undefined', 'pass', 'warn', 'fail')),
    reason TEXT NOT NULL,
    fields TEXT NOT NULL,
    creation_time TEXT GENERATED ALWAYS AS
      (strftime('%Y-%m-%dT%H:%M:%fZ', creation_time_ns / 1e9, 'unixepoch')) VIRTUAL,
    acquisition_time TEXT GENERATED ALWAYS AS
      (strftime('%Y-%m-%dT%H:%M:%fZ', acquisition_time_ns / 1e9, 'unixepoch')) VIRTUAL
  );
  CREATE INDEX result_job ON result (job_id, number);
  CREATE INDEX result_creation_time ON result (creation_time_ns);
  CREATE INDEX result_part ON result (part_id, number) WHERE part_id <> '';
  CREATE INDEX result_failed ON result (number) WHERE result_class = 'fail';
  CREATE VIEW result_field AS
    SELECT result.number, result.result_id, result.job_id, field.key AS name, field.value
    FROM result, json_each(result.fields) AS field;
)sql"};

Result<Database> OpenWithEpoch(const std::filesystem::path& file) {
  VS_ASSIGN_OR_RETURN(Database database, OpenStore(file, kMigrations));
  VS_ASSIGN_OR_RETURN(const std::string epoch, ReadEpoch(database));
  if (epoch.empty()) {
    VS_ASSIGN_OR_RETURN(Statement insert, database.Prepare("INSERT INTO store VALUES (?)"));
    insert.Bind(1, RandomUuid());
    VS_RETURN_IF_ERROR(insert.Run());
  }
  return database;
}

// The log files beside it belong to the damaged database and must not meet the new one.
Result<std::filesystem::path> PutDatabaseAside(const std::filesystem::path& file) {
  VS_ASSIGN_OR_RETURN(std::filesystem::path aside, PutAside(file));
  for (const char* suffix : {"-wal", "-shm"}) {
    std::error_code there_is_none;
    std::filesystem::rename(file.string() + suffix, aside.string() + suffix, there_is_none);
  }
  return aside;
}

}  // namespace

Result<Database> OpenResultStore(const std::filesystem::path& file) {
  Result<Database> database = OpenWithEpoch(file);
  if (database.has_value() || database.error().code() != StatusCode::kDataLoss) return database;
  VS_ASSIGN_OR_RETURN(const std::filesystem::path aside, PutDatabaseAside(file));
  LogError("results", Str("the stored results cannot be read (", database.error().message(),
                          "); they were put aside as ", aside.string(),
                          " and an empty store was begun: recover them with "
                          "\"sqlite3 FILE .recover\" or restore a backup"));
  return OpenWithEpoch(file);
}

Result<std::string> ReadEpoch(Database& database) {
  VS_ASSIGN_OR_RETURN(Statement query, database.Prepare("SELECT epoch FROM store"));
  VS_ASSIGN_OR_RETURN(const bool row, query.Step());
  return row ? query.Text(0) : std::string();
}

}  // namespace vs
