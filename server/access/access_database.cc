#include "server/access/access_database.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr std::array<std::string_view, 2> kMigrations = {R"sql(
  CREATE TABLE users(
    name TEXT PRIMARY KEY, full_name TEXT NOT NULL, role INTEGER NOT NULL,
    password_hash TEXT NOT NULL, disabled INTEGER NOT NULL, must_change_password INTEGER NOT NULL,
    one_time_used INTEGER NOT NULL, one_time_until_utc_ns INTEGER NOT NULL,
    created_utc_ns INTEGER NOT NULL, last_login_utc_ns INTEGER NOT NULL,
    revision INTEGER NOT NULL) STRICT;
  CREATE TABLE api_keys(
    id TEXT PRIMARY KEY, secret_hash TEXT NOT NULL UNIQUE, name TEXT NOT NULL UNIQUE,
    role INTEGER NOT NULL, created_utc_ns INTEGER NOT NULL, created_by TEXT NOT NULL,
    expires_utc_ns INTEGER NOT NULL) STRICT;
  CREATE TABLE sessions(
    id TEXT PRIMARY KEY, token_hash TEXT NOT NULL UNIQUE, user TEXT NOT NULL,
    address TEXT NOT NULL, client TEXT NOT NULL, created_utc_ns INTEGER NOT NULL,
    expires_utc_ns INTEGER NOT NULL) STRICT;
)sql",
                                                         R"sql(
  ALTER TABLE sessions ADD COLUMN last_used_utc_ns INTEGER NOT NULL DEFAULT 0;
  UPDATE sessions SET last_used_utc_ns = created_utc_ns;
)sql"};

// SQLite would make the file with the rights that the process's umask leaves.
Status MakePrivate(const std::filesystem::path& file) {
  const int fd = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (fd < 0) {
    return FailedPrecondition(Str("cannot write ", file.string(), ": ", std::strerror(errno)));
  }
  ::close(fd);
  std::error_code error;
  std::filesystem::permissions(
      file, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write, error);
  if (error)
    return FailedPrecondition(Str("cannot protect ", file.string(), ": ", error.message()));
  return Status();
}

template <class Record, class Read>
Result<std::vector<Record>> ReadAll(Database& database, std::string_view sql, Read read) {
  VS_ASSIGN_OR_RETURN(Statement statement, database.Prepare(sql));
  std::vector<Record> records;
  while (true) {
    VS_ASSIGN_OR_RETURN(const bool row, statement.Step());
    if (!row) return records;
    records.push_back(read(statement));
  }
}

}  // namespace

Result<std::unique_ptr<AccessDatabase>> AccessDatabase::Open(const std::filesystem::path& file) {
  VS_RETURN_IF_ERROR(MakePrivate(file));
  VS_ASSIGN_OR_RETURN(Database database, OpenStore(file, kMigrations));
  return std::unique_ptr<AccessDatabase>(new AccessDatabase(std::move(database)));
}

Result<std::vector<UserRecord>> AccessDatabase::Users() {
  MutexLock lock(mutex_);
  return ReadAll<UserRecord>(
      database_,
      "SELECT name, full_name, role, password_hash, disabled, must_change_password, one_time_used,"
      " one_time_until_utc_ns, created_utc_ns, last_login_utc_ns, revision FROM users",
      [](const Statement& row) {
        return UserRecord{.name = row.Text(0),
                          .full_name = row.Text(1),
                          .role = static_cast<Role>(row.Integer(2)),
                          .password_hash = row.Text(3),
                          .disabled = row.Integer(4) != 0,
                          .must_change_password = row.Integer(5) != 0,
                          .one_time_used = row.Integer(6) != 0,
                          .one_time_until_utc_ns = row.Integer(7),
                          .created_utc_ns = row.Integer(8),
                          .last_login_utc_ns = row.Integer(9),
                          .revision = row.Integer(10)};
      });
}

Result<std::vector<ApiKeyRecord>> AccessDatabase::ApiKeys() {
  MutexLock lock(mutex_);
  return ReadAll<ApiKeyRecord>(
      database_,
      "SELECT id, secret_hash, name, role, created_utc_ns, created_by, expires_utc_ns"
      " FROM api_keys",
      [](const Statement& row) {
        return ApiKeyRecord{.id = row.Text(0),
                            .secret_hash = TokenHashFromHex(row.Text(1)),
                            .name = row.Text(2),
                            .role = static_cast<Role>(row.Integer(3)),
                            .created_utc_ns = row.Integer(4),
                            .created_by = row.Text(5),
                            .expires_utc_ns = row.Integer(6)};
      });
}

Result<std::vector<SessionRecord>> AccessDatabase::Sessions() {
  MutexLock lock(mutex_);
  return ReadAll<SessionRecord>(
      database_,
      "SELECT id, token_hash, user, address, client, created_utc_ns, expires_utc_ns,"
      " last_used_utc_ns FROM sessions",
      [](const Statement& row) {
        return SessionRecord{.id = row.Text(0),
                             .token_hash = TokenHashFromHex(row.Text(1)),
                             .user = row.Text(2),
                             .address = row.Text(3),
                             .client = row.Text(4),
                             .created_utc_ns = row.Integer(5),
                             .expires_utc_ns = row.Integer(6),
                             .last_used_utc_ns = row.Integer(7)};
      });
}

Status AccessDatabase::Save(const UserRecord& user) {
  MutexLock lock(mutex_);
  VS_ASSIGN_OR_RETURN(Statement statement,
                      database_.Prepare("INSERT OR REPLACE INTO users(name, full_name, role,"
                                        " password_hash, disabled, must_change_password,"
                                        " one_time_used, one_time_until_utc_ns, created_utc_ns,"
                                        " last_login_utc_ns, revision)"
                                        " VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"));
  statement.Bind(1, user.name);
  statement.Bind(2, user.full_name);
  statement.Bind(3, static_cast<int64_t>(user.role));
  statement.Bind(4, user.password_hash);
  statement.Bind(5, int64_t{user.disabled});
  statement.Bind(6, int64_t{user.must_change_password});
  statement.Bind(7, int64_t{user.one_time_used});
  statement.Bind(8, user.one_time_until_utc_ns);
  statement.Bind(9, user.created_utc_ns);
  statement.Bind(10, user.last_login_utc_ns);
  statement.Bind(11, user.revision);
  return statement.Run();
}

Status AccessDatabase::Save(const ApiKeyRecord& key) {
  MutexLock lock(mutex_);
  VS_ASSIGN_OR_RETURN(Statement statement,
                      database_.Prepare("INSERT OR REPLACE INTO api_keys(id, secret_hash, name,"
                                        " role, created_utc_ns, created_by, expires_utc_ns)"
                                        " VALUES(?, ?, ?, ?, ?, ?, ?)"));
  statement.Bind(1, key.id);
  statement.Bind(2, ToHex(key.secret_hash));
  statement.Bind(3, key.name);
  statement.Bind(4, static_cast<int64_t>(key.role));
  statement.Bind(5, key.created_utc_ns);
  statement.Bind(6, key.created_by);
  statement.Bind(7, key.expires_utc_ns);
  return statement.Run();
}

Status AccessDatabase::Save(const SessionRecord& session) {
  MutexLock lock(mutex_);
  VS_ASSIGN_OR_RETURN(Statement statement,
                      database_.Prepare("INSERT OR REPLACE INTO sessions(id, token_hash, user,"
                                        " address, client, created_utc_ns, expires_utc_ns,"
                                        " last_used_utc_ns) VALUES(?, ?, ?, ?, ?, ?, ?, ?)"));
  statement.Bind(1, session.id);
  statement.Bind(2, ToHex(session.token_hash));
  statement.Bind(3, session.user);
  statement.Bind(4, session.address);
  statement.Bind(5, session.client);
  statement.Bind(6, session.created_utc_ns);
  statement.Bind(7, session.expires_utc_ns);
  statement.Bind(8, session.last_used_utc_ns);
  return statement.Run();
}

Status AccessDatabase::SaveLastUse(const std::vector<SessionRecord>& sessions) {
  MutexLock lock(mutex_);
  VS_ASSIGN_OR_RETURN(Transaction transaction, Transaction::Begin(database_));
  VS_ASSIGN_OR_RETURN(Statement statement,
                      database_.Prepare("UPDATE sessions SET last_used_utc_ns = ? WHERE id = ?"));
  for (const SessionRecord& session : sessions) {
    statement.Bind(1, session.last_used_utc_ns);
    statement.Bind(2, session.id);
    VS_RETURN_IF_ERROR(statement.Run());
    statement.Reset();
  }
  return transaction.Commit();
}

Status AccessDatabase::DeleteUser(const std::string& name) {
  MutexLock lock(mutex_);
  VS_ASSIGN_OR_RETURN(Transaction transaction, Transaction::Begin(database_));
  VS_RETURN_IF_ERROR(Delete("DELETE FROM sessions WHERE user = ?", name));
  VS_RETURN_IF_ERROR(Delete("DELETE FROM users WHERE name = ?", name));
  return transaction.Commit();
}

Status AccessDatabase::DeleteApiKey(const std::string& id) {
  MutexLock lock(mutex_);
  return Delete("DELETE FROM api_keys WHERE id = ?", id);
}

Status AccessDatabase::DeleteSession(const std::string& id) {
  MutexLock lock(mutex_);
  return Delete("DELETE FROM sessions WHERE id = ?", id);
}

Status AccessDatabase::Delete(std::string_view sql, const std::string& key) {
  VS_ASSIGN_OR_RETURN(Statement statement, database_.Prepare(sql));
  statement.Bind(1, key);
  return statement.Run();
}

}  // namespace vs
