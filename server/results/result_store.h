#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/listeners.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "engine/core/result_sink.h"
#include "server/results/stored_result.h"
#include "server/results/uuid.h"
#include "server/storage/sqlite.h"

namespace vs {

struct ResultStoreOptions {
  // How long the first result of a group waits for others to share its commit.
  std::chrono::milliseconds commit_interval{10};
  size_t rows_per_commit = 1000;
  // Results that wait in memory, at most; about 1 kB each.
  size_t queue_rows = 10000;
  // Nothing is written when the disk has less free space than this.
  uint64_t min_free_bytes = 64u << 20;
  // Pause before a failed commit is tried again.
  std::chrono::milliseconds retry_interval{250};
  // How long the last results may take to reach the disk when the store goes.
  std::chrono::milliseconds close_timeout{5000};
};

struct ResultStoreState {
  size_t queued = 0;         // logged, not yet on the disk
  uint64_t committed = 0;    // since start
  uint64_t refused = 0;      // by Log, because the queue was full
  uint64_t last_number = 0;  // of the newest committed result; 0 = none ever
  Status fault;              // why nothing can be written at this moment; ok otherwise
};

// Keeps results in an SQLite file (WAL, synchronous FULL), written by one thread in groups.
//
// Log() only queues, so vision never waits for a disk. A result counts as kept from the moment
// OnCommitted() reports its number: from then on it survives a crash and a power cut. While the
// disk is full or the file locked, results queue and the write is tried again; when the queue is
// full, Log() refuses. Thread-safe.
class ResultStore final : public ResultSink {
 public:
  using Options = ResultStoreOptions;
  // Called on the writing thread after each commit, with the newest number. Must return at once
  // and must not drop its own handle.
  using Listener = Listeners<uint64_t>::Function;

  static Result<std::unique_ptr<ResultStore>> Open(const std::filesystem::path& file,
                                                   const Clock& clock, Options options = {});
  // Closes within close_timeout.
  ~ResultStore() override;

  Result<std::string> Log(ResultRecord record) override VS_EXCLUDES(mutex_);

  // Takes no more results and writes what is queued; what is not written within `patience` is lost,
  // with an ERROR in the log.
  void Close(std::chrono::milliseconds patience) VS_EXCLUDES(mutex_);

  ResultStoreState State() const VS_EXCLUDES(mutex_);
  // Ends when the returned handle goes.
  [[nodiscard]] std::shared_ptr<void> OnCommitted(Listener listener) {
    return committed_.Add(std::move(listener));
  }
  // Names this file among others of the same history.
  const std::string& epoch() const { return epoch_; }
  const std::filesystem::path& file() const { return database_.file(); }

 private:
  ResultStore(Database database, Statement insert, std::string epoch, uint64_t last_number,
              const Clock& clock, Options options);

  void WriteLoop();
  // Empty when the store closes and everything is written.
  std::vector<StoredResult> NextGroup() VS_EXCLUDES(mutex_);
  // False when the store closed before the group could be written.
  bool WriteUntilDone(std::vector<StoredResult>& group) VS_EXCLUDES(mutex_);
  Status WriteGroup(std::vector<StoredResult>& group);
  Status CheckFreeSpace() const;

  const Clock& clock_;
  const Options options_;
  const std::string epoch_;
  Database database_;  // of the writing thread
  Statement insert_;
  Listeners<uint64_t> committed_;

  mutable Mutex mutex_;
  CondVar changed_;
  UuidV7Generator ids_ VS_GUARDED_BY(mutex_);
  std::deque<StoredResult> queue_ VS_GUARDED_BY(mutex_);
  size_t writing_ VS_GUARDED_BY(mutex_) = 0;  // rows of the group that is being written
  ResultStoreState state_ VS_GUARDED_BY(mutex_);
  bool closing_ VS_GUARDED_BY(mutex_) = false;
  int64_t give_up_ns_ VS_GUARDED_BY(mutex_) = 0;  // while closing, by the machine's clock

  std::jthread writer_;  // last: everything it uses exists before it starts
};

}  // namespace vs
