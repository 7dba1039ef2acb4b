#include "server/audit/audit_store.h"

#include <array>
#include <limits>
#include <string_view>

namespace vs {
namespace {

constexpr std::array<std::string_view, 1> kMigrations = {R"sql(
  CREATE TABLE entry(
    number INTEGER PRIMARY KEY AUTOINCREMENT, time_utc_ns INTEGER NOT NULL, user TEXT NOT NULL,
    address TEXT NOT NULL, method TEXT NOT NULL, subject TEXT NOT NULL, ok INTEGER NOT NULL,
    message TEXT NOT NULL, by_stranger INTEGER NOT NULL) STRICT;
  CREATE INDEX entry_by_stranger ON entry(by_stranger, number);
)sql"};

// The oldest of those that are kept is found by its place.
constexpr std::string_view kTrimByCount =
    "DELETE FROM entry WHERE by_stranger = ?1 AND number < (SELECT number FROM entry WHERE "
    "by_stranger = ?1 ORDER BY number DESC LIMIT 1 OFFSET ?2)";

AuditEntry ReadRow(const Statement& row) {
  return {.number = static_cast<uint64_t>(row.Integer(0)),
          .time_utc_ns = row.Integer(1),
          .user = row.Text(2),
          .address = row.Text(3),
          .method = row.Text(4),
          .subject = row.Text(5),
          .ok = row.Integer(6) != 0,
          .message = row.Text(7),
          .by_stranger = row.Integer(8) != 0};
}

}  // namespace

Result<std::unique_ptr<AuditStore>> AuditStore::Open(const std::filesystem::path& file) {
  VS_ASSIGN_OR_RETURN(Database database, OpenStore(file, kMigrations));
  return std::unique_ptr<AuditStore>(new AuditStore(std::move(database)));
}

Status AuditStore::Append(const std::vector<AuditEntry>& entries) {
  MutexLock lock(mutex_);
  VS_ASSIGN_OR_RETURN(Transaction transaction, Transaction::Begin(database_));
  VS_ASSIGN_OR_RETURN(
      Statement insert,
      database_.Prepare(
          "INSERT INTO entry(time_utc_ns, user, address, method, subject, ok, message,"
          " by_stranger) VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)"));
  for (const AuditEntry& entry : entries) {
    insert.Reset();
    insert.Bind(1, entry.time_utc_ns);
    insert.Bind(2, entry.user);
    insert.Bind(3, entry.address);
    insert.Bind(4, entry.method);
    insert.Bind(5, entry.subject);
    insert.Bind(6, int64_t{entry.ok});
    insert.Bind(7, entry.message);
    insert.Bind(8, int64_t{entry.by_stranger});
    VS_RETURN_IF_ERROR(insert.Run());
  }
  return transaction.Commit();
}

Status AuditStore::Trim(const AuditLimits& limits, int64_t now_utc_ns) {
  MutexLock lock(mutex_);
  VS_ASSIGN_OR_RETURN(Statement old, database_.Prepare("DELETE FROM entry WHERE time_utc_ns < ?1"));
  old.Bind(1, now_utc_ns - limits.keep_ns);
  VS_RETURN_IF_ERROR(old.Run());
  for (const bool by_stranger : {false, true}) {
    VS_ASSIGN_OR_RETURN(Statement many, database_.Prepare(kTrimByCount));
    many.Bind(1, int64_t{by_stranger});
    many.Bind(2, (by_stranger ? limits.keep_entries / 10 : limits.keep_entries) - 1);
    VS_RETURN_IF_ERROR(many.Run());
  }
  return Status();
}

Result<AuditStore::Page> AuditStore::List(const AuditFilter& filter, std::optional<uint64_t> before,
                                          size_t limit) {
  constexpr int64_t kEver = std::numeric_limits<int64_t>::max();
  MutexLock lock(mutex_);
  VS_ASSIGN_OR_RETURN(
      Statement select,
      database_.Prepare("SELECT number, time_utc_ns, user, address, method, subject, ok, message,"
                        " by_stranger FROM entry WHERE number < ?1"
                        " AND (?2 = '' OR user = ?2 COLLATE NOCASE)"
                        " AND (?3 = '' OR instr(lower(method), lower(?3)) > 0)"
                        " AND time_utc_ns >= ?4 AND time_utc_ns < ?5"
                        " ORDER BY number DESC LIMIT ?6"));
  select.Bind(1, before ? static_cast<int64_t>(*before) : kEver);
  select.Bind(2, filter.user);
  select.Bind(3, filter.method);
  select.Bind(4, filter.from_ns.value_or(-kEver));
  select.Bind(5, filter.until_ns.value_or(kEver));
  select.Bind(6, static_cast<int64_t>(limit) + 1);
  Page page;
  while (true) {
    VS_ASSIGN_OR_RETURN(const bool row, select.Step());
    if (!row) return page;
    if (page.entries.size() == limit) {
      page.more = true;
      return page;
    }
    page.entries.push_back(ReadRow(select));
  }
}

}  // namespace vs
