#pragma once

#include <filesystem>

#include "engine/base/status.h"
#include "server/storage/sqlite.h"

namespace vs {

// Opens the file of results and brings it to the newest schema. A file that SQLite cannot read is
// put aside as FILE.damaged-N, with an ERROR in the log, and a new one begun: a server that
// inspects parts must start.
//
// Table `result`, one row for each result: number, result_id, job_id, part_id, meas_id,
// sequence_revision, parameter_hash, frame_number, creation_time_ns, acquisition_time_ns,
// processing_ns, result_state, result_class, reason, fields (JSON object), and for people
// creation_time and acquisition_time (UTC, text).
// View `result_field`, one row for each measured value: number, result_id, job_id, name, value.
Result<Database> OpenResultStore(const std::filesystem::path& file);

// Tells apart two files that number their results alike, for example after a restored backup.
Result<std::string> ReadEpoch(Database& database);

}  // namespace vs
