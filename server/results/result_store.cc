#include "server/results/result_store.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"
#include "server/results/result_schema.h"

namespace vs {
namespace {

constexpr size_t kMaxTextBytes = 256;
constexpr size_t kMaxFieldsBytes = 64 << 10;
// A writer that waits inside SQLite cannot be stopped, so it waits shortly and often.
constexpr std::chrono::milliseconds kLockTimeout{200};

Status CheckText(std::string_view what, const std::string& text) {
  if (text.size() <= kMaxTextBytes) return Status();
  return InvalidArgument(Str("the ", what, " of a result has ", text.size(), " bytes, at most ",
                             kMaxTextBytes, " are kept"));
}

Status CheckRecord(const ResultRecord& record) {
  if (record.job_id.empty()) return InvalidArgument("a result needs the job it belongs to");
  VS_RETURN_IF_ERROR(CheckText("job id", record.job_id));
  VS_RETURN_IF_ERROR(CheckText("part id", record.part_id));
  VS_RETURN_IF_ERROR(CheckText("measurement id", record.meas_id));
  size_t bytes = record.reason.size();
  for (const auto& [name, value] : record.values) {
    const auto* text = std::get_if<std::string>(&value);
    bytes += name.size() + (text == nullptr ? 24 : text->size());
  }
  if (bytes <= kMaxFieldsBytes) return Status();
  return InvalidArgument(Str("the values of a result take ", bytes, " bytes, at most ",
                             kMaxFieldsBytes, " are kept: log fewer or shorter ones"));
}

constexpr std::string_view kInsert =
    "INSERT INTO result (result_id, job_id, part_id, meas_id, sequence_revision, parameter_hash,"
    " frame_number, creation_time_ns, acquisition_time_ns, processing_ns, result_state,"
    " result_class, reason, fields) VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?)";

void BindResult(const StoredResult& result, Statement& insert) {
  const ResultRecord& record = result.record;
  insert.Bind(1, result.result_id);
  insert.Bind(2, record.job_id);
  insert.Bind(3, record.part_id);
  insert.Bind(4, record.meas_id);
  insert.Bind(5, static_cast<int64_t>(record.sequence_revision));
  insert.Bind(6, ParameterHashText(record.parameter_hash));
  insert.Bind(7, static_cast<int64_t>(record.frame_number));
  insert.Bind(8, result.creation_time_ns);
  if (result.acquisition_time_ns == 0) {
    insert.BindNull(9);
  } else {
    insert.Bind(9, result.acquisition_time_ns);
  }
  insert.Bind(10, record.processing_ns);
  insert.Bind(11, ResultStateName(record.state));
  insert.Bind(12, ResultClassName(record.result_class));
  insert.Bind(13, record.reason);
  insert.Bind(14, FieldsToJson(record.values));
}

Result<uint64_t> ReadLastNumber(Database& database) {
  VS_ASSIGN_OR_RETURN(Statement query, database.Prepare("SELECT max(number) FROM result"));
  VS_ASSIGN_OR_RETURN([[maybe_unused]] const bool row, query.Step());
  return static_cast<uint64_t>(query.Integer(0));
}

}  // namespace

Result<std::unique_ptr<ResultStore>> ResultStore::Open(const std::filesystem::path& file,
                                                       const Clock& clock, Options options) {
  VS_ASSIGN_OR_RETURN(Database database, OpenResultStore(file));
  VS_ASSIGN_OR_RETURN(std::string epoch, ReadEpoch(database));
  VS_ASSIGN_OR_RETURN(const uint64_t last_number, ReadLastNumber(database));
  VS_ASSIGN_OR_RETURN(Statement insert, database.Prepare(kInsert));
  database.SetBusyTimeout(kLockTimeout);
  return std::unique_ptr<ResultStore>(new ResultStore(
      std::move(database), std::move(insert), std::move(epoch), last_number, clock, options));
}

ResultStore::ResultStore(Database database, Statement insert, std::string epoch,
                         uint64_t last_number, const Clock& clock, Options options)
    : clock_(clock),
      options_(options),
      epoch_(std::move(epoch)),
      database_(std::move(database)),
      insert_(std::move(insert)) {
  {
    MutexLock lock(mutex_);
    state_.last_number = last_number;
  }
  writer_ = std::jthread([this] { WriteLoop(); });
}

ResultStore::~ResultStore() { Close(options_.close_timeout); }

void ResultStore::Close(std::chrono::milliseconds patience) {
  if (!writer_.joinable()) return;
  {
    MutexLock lock(mutex_);
    closing_ = true;
    give_up_ns_ = SystemClock().MonotonicNs() + std::chrono::nanoseconds(patience).count();
  }
  changed_.NotifyAll();
  writer_.join();
}

Result<std::string> ResultStore::Log(ResultRecord record) {
  VS_RETURN_IF_ERROR(CheckRecord(record));
  StoredResult result;
  result.creation_time_ns = clock_.UtcNs();
  if (record.capture_ns != 0) {
    result.acquisition_time_ns =
        result.creation_time_ns - (clock_.MonotonicNs() - record.capture_ns);
  }
  result.record = std::move(record);

  MutexLock lock(mutex_);
  if (queue_.size() + writing_ >= options_.queue_rows || closing_) {
    ++state_.refused;
    return ResourceExhausted(
        Str("the result was not logged: ", queue_.size() + writing_, " results wait for the disk (",
            state_.fault.ok() ? "it is too slow" : state_.fault.message(), ")"));
  }
  result.result_id = ids_.Next(result.creation_time_ns);
  std::string id = result.result_id;
  queue_.push_back(std::move(result));
  if (queue_.size() == 1 || queue_.size() == options_.rows_per_commit) changed_.NotifyAll();
  return id;
}

ResultStoreState ResultStore::State() const {
  MutexLock lock(mutex_);
  ResultStoreState state = state_;
  state.queued = queue_.size() + writing_;
  return state;
}

void ResultStore::WriteLoop() {
  while (true) {
    std::vector<StoredResult> group = NextGroup();
    if (group.empty()) return;
    if (!WriteUntilDone(group)) {
      LogError("results", Str(State().queued,
                              " results are lost: the store had to close before "
                              "they could be written"));
      return;
    }
    committed_.Call(State().last_number);
  }
}

std::vector<StoredResult> ResultStore::NextGroup() {
  MutexLock lock(mutex_);
  while (queue_.empty() && !closing_) changed_.Wait(mutex_);
  const int64_t end_ns =
      clock_.MonotonicNs() + std::chrono::nanoseconds(options_.commit_interval).count();
  while (queue_.size() < options_.rows_per_commit && !closing_) {
    const int64_t left_ns = end_ns - clock_.MonotonicNs();
    if (left_ns <= 0 || !changed_.WaitFor(mutex_, std::chrono::nanoseconds(left_ns))) break;
  }
  const size_t count = std::min(queue_.size(), options_.rows_per_commit);
  const auto end = queue_.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<StoredResult> group(std::make_move_iterator(queue_.begin()),
                                  std::make_move_iterator(end));
  queue_.erase(queue_.begin(), end);
  writing_ = count;
  return group;
}

bool ResultStore::WriteUntilDone(std::vector<StoredResult>& group) {
  while (true) {
    const Status written = WriteGroup(group);
    MutexLock lock(mutex_);
    if (written.ok()) {
      if (!state_.fault.ok()) LogInfo("results", "results are written again");
      state_.fault = Status();
      state_.committed += group.size();
      state_.last_number = group.back().number;
      writing_ = 0;
      return true;
    }
    if (state_.fault.ok()) {
      LogError("results",
               Str("results cannot be written and queue in memory: ", written.message()));
    }
    state_.fault = written;
    if (closing_ && SystemClock().MonotonicNs() >= give_up_ns_) return false;
    changed_.WaitFor(mutex_, options_.retry_interval);
  }
}

Status ResultStore::WriteGroup(std::vector<StoredResult>& group) {
  VS_RETURN_IF_ERROR(CheckFreeSpace());
  VS_ASSIGN_OR_RETURN(Transaction transaction, Transaction::Begin(database_));
  for (StoredResult& result : group) {
    BindResult(result, insert_);
    const Status inserted = insert_.Run();
    insert_.Reset();
    VS_RETURN_IF_ERROR(inserted);
    result.number = static_cast<uint64_t>(database_.LastInsertRowId());
  }
  return transaction.Commit();
}

Status ResultStore::CheckFreeSpace() const {
  std::error_code error;
  const auto space = std::filesystem::space(file().parent_path(), error);
  if (error || space.available >= options_.min_free_bytes) return Status();
  return ResourceExhausted(Str("only ", space.available >> 20, " MB are free on the disk of ",
                               file().string(), ", ", options_.min_free_bytes >> 20,
                               " MB are needed: make room"));
}

}  // namespace vs
