#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/status.h"

struct sqlite3;
struct sqlite3_stmt;

namespace vs {

// A prepared SQL statement. Values always come in by Bind, never as part of the text.
// Not thread-safe; must not outlive its Database.
class Statement {
 public:
  // Parameters count from 1. The text is copied.
  void Bind(int parameter, int64_t value);
  void Bind(int parameter, double value);
  void Bind(int parameter, std::string_view text);
  void BindNull(int parameter);

  // True: a row is ready to be read. False: done.
  Result<bool> Step();
  // Steps to the end; for statements without rows.
  Status Run();
  // Ready to be bound and run again.
  void Reset();

  // Of the current row; columns count from 0.
  int64_t Integer(int column) const;
  double Number(int column) const;
  std::string Text(int column) const;
  bool IsNull(int column) const;

  sqlite3_stmt* handle() const { return statement_.get(); }

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };

  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

// One connection to an SQLite file. Not thread-safe; any number of connections may be open.
// Errors name the file and carry SQLite's own message:
//   UNAVAILABLE locked or disk error, RESOURCE_EXHAUSTED disk full or out of memory,
//   DATA_LOSS damaged file, ALREADY_EXISTS unique value taken, FAILED_PRECONDITION not writable.
class Database {
 public:
  enum class Access { kReadOnly, kReadWrite, kCreate };

  static Result<Database> Open(const std::filesystem::path& file, Access access);

  // One or several statements whose rows nobody wants.
  Status Execute(const std::string& sql);
  Result<Statement> Prepare(std::string_view sql);
  // How long a statement waits for another connection's lock. 0 at first.
  void SetBusyTimeout(std::chrono::milliseconds timeout);
  int64_t LastInsertRowId() const;

  // `result_code` of a call on handle(), as a Status.
  Status Error(int result_code) const;
  sqlite3* handle() const { return connection_.get(); }
  const std::filesystem::path& file() const { return file_; }

 private:
  struct Close {
    void operator()(sqlite3* connection) const;
  };

  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> connection_;
};

// Undoes what was not committed when it leaves its scope.
class Transaction {
 public:
  // Takes the write lock at once, so that it cannot fail for lack of it later.
  static Result<Transaction> Begin(Database& database);
  Transaction(Transaction&& other) noexcept : database_(std::exchange(other.database_, nullptr)) {}
  Transaction& operator=(Transaction&&) = delete;
  ~Transaction();

  Status Commit();

 private:
  explicit Transaction(Database& database) : database_(&database) {}

  Database* database_;
};

// Opens or creates a store that survives power cuts (WAL, synchronous FULL) and brings it to the
// newest schema: migrations[k] leads from version k to k + 1, each in one transaction. A file of a
// newer program is refused with FAILED_PRECONDITION and left as it is.
Result<Database> OpenStore(const std::filesystem::path& file,
                           std::span<const std::string_view> migrations);

}  // namespace vs
