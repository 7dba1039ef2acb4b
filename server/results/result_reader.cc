#include "server/results/result_reader.h"

#include <cstdlib>
#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr std::string_view kSelect =
    "SELECT number, result_id, job_id, part_id, meas_id, sequence_revision, parameter_hash,"
    " frame_number, creation_time_ns, acquisition_time_ns, processing_ns, result_state,"
    " result_class, reason, fields FROM result WHERE ";

StoredResult ReadRow(const Statement& row) {
  StoredResult result;
  ResultRecord& record = result.record;
  result.number = static_cast<uint64_t>(row.Integer(0));
  result.result_id = row.Text(1);
  record.job_id = row.Text(2);
  record.part_id = row.Text(3);
  record.meas_id = row.Text(4);
  record.sequence_revision = static_cast<uint64_t>(row.Integer(5));
  record.parameter_hash = std::strtoull(row.Text(6).c_str(), nullptr, 16);
  record.frame_number = static_cast<uint64_t>(row.Integer(7));
  result.creation_time_ns = row.Integer(8);
  result.acquisition_time_ns = row.Integer(9);
  record.processing_ns = row.Integer(10);
  record.state = ResultStateOf(row.Text(11));
  record.result_class = ResultClassOf(row.Text(12));
  record.reason = row.Text(13);
  record.values = FieldsFromJson(row.Text(14));
  return result;
}

// Conditions and the values of their parameters grow together.
class Where {
 public:
  void Add(std::string_view condition, ParamValue value) {
    if (!text_.empty()) text_ += " AND ";
    text_ += condition;
    values_.push_back(std::move(value));
  }

  void Add(const ResultFilter& filter) {
    if (!filter.job_id.empty()) Add("job_id = ?", filter.job_id);
    // Says what the partial index wants to hear.
    if (!filter.part_id.empty()) Add("part_id <> '' AND part_id = ?", filter.part_id);
    if (filter.result_class == ResultRecord::Class::kFail) {
      Add("result_class = 'fail' AND number > ?", int64_t{0});
    } else if (filter.result_class) {
      Add("result_class = ?", std::string(ResultClassName(*filter.result_class)));
    }
    if (filter.result_state) {
      Add("result_state = ?", std::string(ResultStateName(*filter.result_state)));
    }
    if (filter.from_ns) Add("creation_time_ns >= ?", *filter.from_ns);
    if (filter.until_ns) Add("creation_time_ns < ?", *filter.until_ns);
  }

  Result<ResultPage> Select(Database& database, std::string_view order, size_t limit) const {
    // One more tells whether there are others.
    VS_ASSIGN_OR_RETURN(Statement query, database.Prepare(Str(kSelect, text_, " ORDER BY number ",
                                                              order, " LIMIT ", limit + 1)));
    for (size_t i = 0; i < values_.size(); ++i) {
      const int parameter = static_cast<int>(i) + 1;
      if (const auto* text = std::get_if<std::string>(&values_[i])) {
        query.Bind(parameter, *text);
      } else {
        query.Bind(parameter, std::get<int64_t>(values_[i]));
      }
    }
    ResultPage page;
    size_t bytes = 0;
    while (true) {
      VS_ASSIGN_OR_RETURN(const bool row, query.Step());
      if (!row) return page;
      page.more = page.results.size() == limit || bytes >= ResultReader::kMaxPageBytes;
      if (page.more) return page;
      page.results.push_back(ReadRow(query));
      bytes += SizeBytes(page.results.back());
    }
  }

 private:
  std::string text_;
  std::vector<ParamValue> values_;
};

}  // namespace

Result<std::unique_ptr<ResultReader>> ResultReader::Open(const std::filesystem::path& file) {
  VS_ASSIGN_OR_RETURN(Database database, Database::Open(file, Database::Access::kReadOnly));
  database.SetBusyTimeout(std::chrono::seconds(5));
  // Maps the shared memory of the log now: on a full disk it could not be made later.
  VS_RETURN_IF_ERROR(database.Execute("SELECT 1 FROM result LIMIT 1"));
  return std::unique_ptr<ResultReader>(new ResultReader(std::move(database)));
}

Result<StoredResult> ResultReader::Get(const std::string& result_id) {
  Where where;
  where.Add("result_id = ?", result_id);
  MutexLock lock(mutex_);
  VS_ASSIGN_OR_RETURN(ResultPage found, where.Select(database_, "DESC", 1));
  if (found.results.empty()) {
    return NotFound(Str("there is no result \"", result_id.substr(0, 64), "\""));
  }
  return std::move(found.results.front());
}

Result<ResultPage> ResultReader::Before(const ResultFilter& filter, std::optional<uint64_t> before,
                                        size_t limit) {
  Where where;
  where.Add("number < ?", before ? static_cast<int64_t>(*before) : INT64_MAX);
  where.Add(filter);
  MutexLock lock(mutex_);
  return where.Select(database_, "DESC", limit);
}

Result<ResultPage> ResultReader::After(const ResultFilter& filter, uint64_t after, uint64_t last,
                                       size_t limit) {
  Where where;
  where.Add("number > ?", static_cast<int64_t>(after));
  where.Add("number <= ?", static_cast<int64_t>(last));
  where.Add(filter);
  MutexLock lock(mutex_);
  return where.Select(database_, "ASC", limit);
}

}  // namespace vs
