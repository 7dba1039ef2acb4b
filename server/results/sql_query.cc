#include "server/results/sql_query.h"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "engine/base/str.h"
#include "server/storage/sqlite_memory.h"

namespace vs {
namespace {

constexpr int kMaxSqlBytes = 16384;
constexpr int kStepsBetweenChecks = 1000;

constexpr std::array<std::string_view, 5> kReadableTables = {"result", "result_field", "json_each",
                                                             "sqlite_master", "sqlite_schema"};
// These reach out of the database; all others only compute.
constexpr std::array<std::string_view, 4> kForbiddenFunctions = {"load_extension", "fts3_tokenizer",
                                                                 "sqlite_log", "readfile"};

template <size_t kCount>
bool Contains(const std::array<std::string_view, kCount>& names, const char* name) {
  return name != nullptr && std::find(names.begin(), names.end(), name) != names.end();
}

// Called by SQLite for everything that a statement wants to do, while it is being prepared.
int Authorize(void*, int action, const char* first, const char* second, const char* database,
              const char*) {
  switch (action) {
    case SQLITE_SELECT:
    case SQLITE_RECURSIVE:
      return SQLITE_OK;
    case SQLITE_READ:
      // No column of no database: a common table expression, or the number of rows of any table,
      // which says nothing of its content.
      if (database == nullptr && (second == nullptr || *second == '\0')) return SQLITE_OK;
      return Contains(kReadableTables, first) ? SQLITE_OK : SQLITE_DENY;
    case SQLITE_FUNCTION:
      return Contains(kForbiddenFunctions, second) ? SQLITE_DENY : SQLITE_OK;
    default:
      return SQLITE_DENY;
  }
}

void Bind(const std::vector<SqlValue>& arguments, Statement& statement) {
  for (size_t i = 0; i < arguments.size(); ++i) {
    const int parameter = static_cast<int>(i) + 1;
    if (const auto* integer = std::get_if<int64_t>(&arguments[i])) {
      statement.Bind(parameter, *integer);
    } else if (const auto* number = std::get_if<double>(&arguments[i])) {
      statement.Bind(parameter, *number);
    } else if (const auto* text = std::get_if<std::string>(&arguments[i])) {
      statement.Bind(parameter, *text);
    } else if (const auto* blob = std::get_if<SqlBlob>(&arguments[i])) {
      sqlite3_bind_blob64(statement.handle(), parameter, blob->bytes.data(), blob->bytes.size(),
                          SQLITE_TRANSIENT);
    } else {
      statement.BindNull(parameter);
    }
  }
}

SqlValue ReadCell(const Statement& row, int column) {
  switch (sqlite3_column_type(row.handle(), column)) {
    case SQLITE_INTEGER:
      return row.Integer(column);
    case SQLITE_FLOAT:
      return row.Number(column);
    case SQLITE_TEXT:
      return row.Text(column);
    case SQLITE_BLOB:
      return SqlBlob{row.Text(column)};
    default:
      return std::monostate();
  }
}

size_t BytesOf(const SqlValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return text->size() + 8;
  if (const auto* blob = std::get_if<SqlBlob>(&value)) return blob->bytes.size() + 8;
  return 16;
}

std::vector<std::string> ColumnNames(const Statement& statement) {
  std::vector<std::string> names;
  std::set<std::string> used;
  const int count = sqlite3_column_count(statement.handle());
  for (int i = 0; i < count; ++i) {
    const std::string name = sqlite3_column_name(statement.handle(), i);
    std::string unique = name;
    for (int n = 2; !used.insert(unique).second; ++n) unique = Str(name, "_", n);
    names.push_back(std::move(unique));
  }
  return names;
}

// Never names the file or the place where it lies.
Status ForClient(Database& database, const Status& error) {
  if (error.code() == StatusCode::kPermissionDenied) {
    return InvalidArgument("SQL: only a SELECT over result and result_field is allowed");
  }
  return Status(error.code(), Str("SQL: ", sqlite3_errmsg(database.handle())));
}

// SQLite prepares the first statement only; what follows it must be blank or a comment.
Result<Statement> PrepareOne(Database& database, const std::string& sql) {
  if (sql.size() > kMaxSqlBytes || sql.find('\0') != std::string::npos) {
    return InvalidArgument(Str("a query is text of at most ", kMaxSqlBytes, " bytes"));
  }
  Result<Statement> statement = database.Prepare(sql);
  if (!statement.has_value()) return ForClient(database, statement.error());
  if (statement->handle() == nullptr) return InvalidArgument("the query is empty: write a SELECT");
  const char* rest = sql.c_str() + std::string_view(sqlite3_sql(statement->handle())).size();
  const Result<Statement> second = database.Prepare(rest);
  if (!second.has_value() || second->handle() != nullptr) {
    return InvalidArgument("a query is one statement: remove what follows the first one");
  }
  return statement;
}

Result<SqlTable> Read(Database& database, const std::string& sql,
                      const std::vector<SqlValue>& arguments, const SqlLimits& limits) {
  VS_ASSIGN_OR_RETURN(Statement query, PrepareOne(database, sql));
  const int wanted = sqlite3_bind_parameter_count(query.handle());
  if (wanted != static_cast<int>(arguments.size())) {
    return InvalidArgument(
        Str("the query takes ", wanted, " arguments, ", arguments.size(), " were given"));
  }
  Bind(arguments, query);
  SqlTable table;
  table.columns = ColumnNames(query);
  size_t bytes = 0;
  while (true) {
    const Result<bool> row = query.Step();
    if (!row.has_value()) return ForClient(database, row.error());
    if (!*row) return table;
    if (table.rows.size() == limits.max_rows) {
      table.truncated = true;
      return table;
    }
    std::vector<SqlValue>& cells = table.rows.emplace_back();
    for (size_t i = 0; i < table.columns.size(); ++i) {
      cells.push_back(ReadCell(query, static_cast<int>(i)));
      bytes += BytesOf(cells.back());
    }
    if (bytes > limits.max_answer_bytes) {
      return ResourceExhausted(Str("the answer is larger than ", limits.max_answer_bytes >> 10,
                                   " kB: select fewer columns or rows, or export as CSV"));
    }
  }
}

Result<Database> OpenForStrangers(const std::filesystem::path& file) {
  VS_ASSIGN_OR_RETURN(Database database, Database::Open(file, Database::Access::kReadOnly));
  database.SetBusyTimeout(std::chrono::seconds(1));
  VS_RETURN_IF_ERROR(database.Execute(
      "PRAGMA query_only = ON; PRAGMA temp_store = MEMORY; SELECT 1 FROM result LIMIT 1;"
      // SQLite makes this table when it is first named, which the limits below would not allow.
      "SELECT 1 FROM json_each('[]')"));
  sqlite3* connection = database.handle();
  sqlite3_db_config(connection, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_limit(connection, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_limit(connection, SQLITE_LIMIT_LENGTH, 1 << 20);
  sqlite3_limit(connection, SQLITE_LIMIT_SQL_LENGTH, kMaxSqlBytes);
  sqlite3_limit(connection, SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 256);
  sqlite3_limit(connection, SQLITE_LIMIT_EXPR_DEPTH, 200);
  sqlite3_limit(connection, SQLITE_LIMIT_COLUMN, 200);
  sqlite3_limit(connection, SQLITE_LIMIT_COMPOUND_SELECT, 50);
  sqlite3_limit(connection, SQLITE_LIMIT_VDBE_OP, 100'000);
  sqlite3_set_authorizer(connection, Authorize, nullptr);
  return database;
}

}  // namespace

// What a running statement is held to.
struct SqlQuery::Watch {
  const Clock& clock;
  const SqlLimits& limits;
  const std::function<bool()>& cancelled;
  int64_t end_ns;
  int64_t most_bytes = INT64_MAX;  // of this thread; none while the statement waits for its turn
  Status stopped_because{};

  // Not zero: SQLite interrupts the statement.
  static int Look(void* self) {
    auto& watch = *static_cast<Watch*>(self);
    watch.stopped_because = watch.Judge();
    return watch.stopped_because.ok() ? 0 : 1;
  }

  Status Judge() const {
    if (clock.MonotonicNs() >= end_ns) {
      return DeadlineExceeded(Str("the query took longer than ", limits.timeout.count(),
                                  " ms: ask for less, or for a longer timeout"));
    }
    if (SqliteBytesOfThread() > most_bytes) {
      return ResourceExhausted(Str("the query needs more than ", limits.max_work_bytes >> 20,
                                   " MB of memory: sort or group less"));
    }
    if (cancelled()) return Cancelled("the query was cancelled");
    return Status();
  }
};

Result<std::unique_ptr<SqlQuery>> SqlQuery::Open(const std::filesystem::path& file,
                                                 const Clock& clock, int connections) {
  std::vector<Database> databases;
  for (int i = 0; i < connections; ++i) {
    VS_ASSIGN_OR_RETURN(databases.emplace_back(), OpenForStrangers(file));
  }
  return std::unique_ptr<SqlQuery>(new SqlQuery(std::move(databases), clock));
}

SqlQuery::SqlQuery(std::vector<Database> databases, const Clock& clock)
    : clock_(clock), free_(std::move(databases)) {}

SqlQuery::~SqlQuery() = default;

// A connection is ours until this goes, however the statement ends; an exception, too.
class SqlQuery::Turn {
 public:
  // `database` is one of `query`, to which it goes back. `watch` outlives this.
  Turn(SqlQuery& query, Database database, Watch& watch)
      : query_(query), database_(std::move(database)) {
    watch.most_bytes = SqliteBytesOfThread() + static_cast<int64_t>(watch.limits.max_work_bytes);
    sqlite3_progress_handler(database_.handle(), kStepsBetweenChecks, &Watch::Look, &watch);
  }
  ~Turn() {
    sqlite3_progress_handler(database_.handle(), 0, nullptr, nullptr);
    {
      MutexLock lock(query_.mutex_);
      query_.free_.push_back(std::move(database_));  // has room for all of them
    }
    query_.given_back_.NotifyOne();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  Database& database() { return database_; }

 private:
  SqlQuery& query_;
  Database database_;
};

Result<Database> SqlQuery::TakeConnection(const Watch& watch) {
  MutexLock lock(mutex_);
  VS_RETURN_IF_ERROR(watch.Judge());
  while (free_.empty()) {
    given_back_.WaitFor(mutex_, std::chrono::milliseconds(20));
    VS_RETURN_IF_ERROR(watch.Judge());
  }
  Database database = std::move(free_.back());
  free_.pop_back();
  return database;
}

Result<SqlTable> SqlQuery::Run(const std::string& sql, const std::vector<SqlValue>& arguments,
                               const SqlLimits& limits, const std::function<bool()>& cancelled) {
  const int64_t since_ns = limits.since_ns.value_or(clock_.MonotonicNs());
  Watch watch{clock_, limits, cancelled,
              since_ns + std::chrono::nanoseconds(limits.timeout).count()};
  VS_ASSIGN_OR_RETURN(Database database, TakeConnection(watch));
  Turn turn(*this, std::move(database), watch);
  Result<SqlTable> table = Read(turn.database(), sql, arguments, limits);
  if (!watch.stopped_because.ok()) return watch.stopped_because;
  return table;
}

}  // namespace vs
