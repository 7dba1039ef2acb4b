#include "server/storage/sqlite.h"

#include <sqlite3.h>

#include <utility>

#include "engine/base/check.h"
#include "engine/base/str.h"
#include "server/storage/sqlite_memory.h"

namespace vs {
namespace {

StatusCode CodeOf(int result_code) {
  if (result_code == SQLITE_CONSTRAINT_UNIQUE || result_code == SQLITE_CONSTRAINT_PRIMARYKEY) {
    return StatusCode::kAlreadyExists;
  }
  switch (result_code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_IOERR:
      return StatusCode::kUnavailable;
    case SQLITE_FULL:
    case SQLITE_NOMEM:
    case SQLITE_TOOBIG:
      return StatusCode::kResourceExhausted;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return StatusCode::kDataLoss;
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_READONLY:
    case SQLITE_CONSTRAINT:
      return StatusCode::kFailedPrecondition;
    case SQLITE_AUTH:
      return StatusCode::kPermissionDenied;
    case SQLITE_INTERRUPT:
      return StatusCode::kCancelled;
    case SQLITE_ERROR:
      return StatusCode::kInvalidArgument;
    default:
      return StatusCode::kInternal;
  }
}

Status ErrorOf(sqlite3* connection, int result_code, const std::filesystem::path& file) {
  const char* text =
      connection == nullptr ? sqlite3_errstr(result_code) : sqlite3_errmsg(connection);
  return Status(CodeOf(result_code), Str(file.string(), ": ", text));
}

Result<int64_t> ReadVersion(Database& database) {
  VS_ASSIGN_OR_RETURN(Statement query, database.Prepare("PRAGMA user_version"));
  VS_ASSIGN_OR_RETURN([[maybe_unused]] const bool row, query.Step());
  return query.Integer(0);
}

// Read-only, so that even a log left behind by a crash stays for the program it belongs to.
Status RefuseNewer(const std::filesystem::path& file, size_t newest_known) {
  VS_ASSIGN_OR_RETURN(Database database, Database::Open(file, Database::Access::kReadOnly));
  VS_ASSIGN_OR_RETURN(const int64_t version, ReadVersion(database));
  if (version <= static_cast<int64_t>(newest_known)) return Status();
  return FailedPrecondition(Str(file.string(), ": written by a newer program (schema version ",
                                version, ", this program knows up to ", newest_known,
                                "): install that program again, or restore an older backup"));
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

void Statement::Bind(int parameter, int64_t value) {
  VS_CHECK(sqlite3_bind_int64(handle(), parameter, value) == SQLITE_OK);
}

void Statement::Bind(int parameter, double value) {
  VS_CHECK(sqlite3_bind_double(handle(), parameter, value) == SQLITE_OK);
}

void Statement::Bind(int parameter, std::string_view text) {
  // A null pointer would bind NULL instead of an empty text.
  const char* data = text.data() == nullptr ? "" : text.data();
  VS_CHECK(sqlite3_bind_text64(handle(), parameter, data, text.size(), SQLITE_TRANSIENT,
                               SQLITE_UTF8) == SQLITE_OK);
}

void Statement::BindNull(int parameter) {
  VS_CHECK(sqlite3_bind_null(handle(), parameter) == SQLITE_OK);
}

Result<bool> Statement::Step() {
  const int code = sqlite3_step(handle());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  sqlite3* connection = sqlite3_db_handle(handle());
  const char* file = sqlite3_db_filename(connection, "main");
  return ErrorOf(connection, sqlite3_extended_errcode(connection), file == nullptr ? "" : file);
}

Status Statement::Run() {
  while (true) {
    VS_ASSIGN_OR_RETURN(const bool row, Step());
    if (!row) return Status();
  }
}

void Statement::Reset() {
  // Repeats the error of the last step, which was reported then.
  sqlite3_reset(handle());
  sqlite3_clear_bindings(handle());
}

int64_t Statement::Integer(int column) const { return sqlite3_column_int64(handle(), column); }

double Statement::Number(int column) const { return sqlite3_column_double(handle(), column); }

std::string Statement::Text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle(), column));
  if (text == nullptr) return "";
  return std::string(text, static_cast<size_t>(sqlite3_column_bytes(handle(), column)));
}

bool Statement::IsNull(int column) const {
  return sqlite3_column_type(handle(), column) == SQLITE_NULL;
}

void Database::Close::operator()(sqlite3* connection) const { sqlite3_close_v2(connection); }

Result<Database> Database::Open(const std::filesystem::path& file, Access access) {
  CountSqliteMemory();
  const int flags = access == Access::kReadOnly    ? SQLITE_OPEN_READONLY
                    : access == Access::kReadWrite ? SQLITE_OPEN_READWRITE
                                                   : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &connection,
                                   flags | SQLITE_OPEN_FULLMUTEX | SQLITE_OPEN_EXRESCODE, nullptr);
  Database database;
  database.file_ = file;
  database.connection_.reset(connection);
  if (code != SQLITE_OK) return database.Error(code);
  return database;
}

Status Database::Execute(const std::string& sql) {
  const int code = sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr);
  return code == SQLITE_OK ? Status() : Error(code);
}

Result<Statement> Database::Prepare(std::string_view sql) {
  sqlite3_stmt* prepared = nullptr;
  const int code =
      sqlite3_prepare_v3(handle(), sql.data(), static_cast<int>(sql.size()), 0, &prepared, nullptr);
  if (code != SQLITE_OK) return Error(code);
  Statement statement;
  statement.statement_.reset(prepared);
  return statement;
}

void Database::SetBusyTimeout(std::chrono::milliseconds timeout) {
  sqlite3_busy_timeout(handle(), static_cast<int>(timeout.count()));
}

int64_t Database::LastInsertRowId() const { return sqlite3_last_insert_rowid(handle()); }

Status Database::Error(int result_code) const { return ErrorOf(handle(), result_code, file_); }

Result<Transaction> Transaction::Begin(Database& database) {
  VS_RETURN_IF_ERROR(database.Execute("BEGIN IMMEDIATE"));
  return Transaction(database);
}

Transaction::~Transaction() {
  // Some errors (a full disk) have rolled back already.
  if (database_ == nullptr || sqlite3_get_autocommit(database_->handle()) != 0) return;
  (void)database_->Execute("ROLLBACK");
}

Status Transaction::Commit() { return database_->Execute("COMMIT"); }

Result<Database> OpenStore(const std::filesystem::path& file,
                           std::span<const std::string_view> migrations) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    VS_RETURN_IF_ERROR(RefuseNewer(file, migrations.size()));
  }
  VS_ASSIGN_OR_RETURN(Database database, Database::Open(file, Database::Access::kCreate));
  database.SetBusyTimeout(std::chrono::seconds(5));
  VS_RETURN_IF_ERROR(database.Execute(
      "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON;"
      "PRAGMA journal_size_limit = 67108864"));
  VS_ASSIGN_OR_RETURN(const int64_t version, ReadVersion(database));
  for (size_t next = static_cast<size_t>(version); next < migrations.size(); ++next) {
    VS_ASSIGN_OR_RETURN(Transaction transaction, Transaction::Begin(database));
    Status step = database.Execute(std::string(migrations[next]));
    if (step.ok()) step = database.Execute(Str("PRAGMA user_version = ", next + 1));
    if (step.ok()) step = transaction.Commit();
    if (!step.ok()) return step.Annotated(Str("schema migration to version ", next + 1));
  }
  return database;
}

}  // namespace vs
