#include "server/services/result_service.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/base/str.h"
#include "server/convert/result.h"
#include "server/convert/time.h"
#include "server/results/result_csv.h"
#include "server/results/result_file.h"
#include "server/services/loading_source.h"
#include "server/services/page_token.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

constexpr uint32_t kDefaultPage = 100;
constexpr uint32_t kMaxPage = 1000;
constexpr uint32_t kDefaultRows = 1000;
constexpr uint32_t kMaxRows = 10'000;
constexpr int64_t kMaxQueryNs = 30'000'000'000;
constexpr size_t kRowsPerLoad = 500;
constexpr size_t kPieceBytes = 1u << 20;
constexpr size_t kMaxColumns = 16'384;  // as many as spreadsheets take

Result<SqlLimits> LimitsOf(const pb::QueryResultsRequest& request) {
  SqlLimits limits;
  limits.max_rows = request.max_rows() == 0 ? kDefaultRows : request.max_rows();
  if (limits.max_rows > kMaxRows) {
    return InvalidArgument(Str("max_rows must be 1 to ", kMaxRows, ", or 0 for ", kDefaultRows));
  }
  if (request.has_timeout()) {
    const int64_t timeout_ns = ToNs(request.timeout());
    if (timeout_ns <= 0 || timeout_ns > kMaxQueryNs) {
      return InvalidArgument(
          Str("timeout must be more than 0 and at most ", kMaxQueryNs / 1'000'000'000, " s"));
    }
    limits.timeout =
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::nanoseconds(timeout_ns));
  }
  return limits;
}

// All matching results up to `last` as CSV, in two passes: the first finds out which columns there
// are.
class Exporter {
 public:
  Exporter(ResultReader& reader, ResultFilter filter, uint64_t last)
      : reader_(reader), filter_(std::move(filter)), last_(last) {}

  Result<LoadedPage> Next() {
    VS_ASSIGN_OR_RETURN(const ResultPage page, reader_.After(filter_, after_, last_, kRowsPerLoad));
    return csv_ ? Rows(page) : Names(page);
  }

 private:
  // The first pass; its end gives the header.
  Result<LoadedPage> Names(const ResultPage& page) {
    for (const StoredResult& result : page.results) {
      for (const auto& [name, value] : result.record.values) names_.insert(name);
    }
    if (names_.size() > kMaxColumns) {
      return ResourceExhausted(Str("the results have more than ", kMaxColumns,
                                   " different fields: export those of one job at a time"));
    }
    after_ = page.more ? page.results.back().number : 0;
    if (page.more) return LoadedPage();
    csv_.emplace(names_);
    return Piece(csv_->Header());
  }

  // The second pass. A row has all columns, so it may be much larger than its result.
  LoadedPage Rows(const ResultPage& page) {
    std::string text;
    size_t count = 0;
    while (count < page.results.size() && text.size() < kPieceBytes) {
      text += csv_->Row(page.results[count++]);
    }
    const bool all = count == page.results.size() && !page.more;
    if (count > 0) after_ = page.results[count - 1].number;
    LoadedPage piece = Piece(std::move(text));
    if (all) piece.then = LoadedPage::Then::kEnd;
    return piece;
  }

  static LoadedPage Piece(std::string text) {
    LoadedPage page;
    if (text.empty()) return page;
    pb::ExportResultsResponse response;
    response.set_data(std::move(text));
    page.messages.push_back(Serialize(response));
    return page;
  }

  ResultReader& reader_;
  const ResultFilter filter_;
  const uint64_t last_;
  uint64_t after_ = 0;
  std::set<std::string> names_;
  std::optional<ResultCsv> csv_;
};

}  // namespace

Result<std::unique_ptr<ResultService>> ResultService::Make(ResultStore& store,
                                                           const std::filesystem::path& data_dir,
                                                           const Clock& clock) {
  Readers readers;
  VS_ASSIGN_OR_RETURN(readers.single, ResultReader::Open(store.file()));
  VS_ASSIGN_OR_RETURN(readers.lists, ResultReader::Open(store.file()));
  VS_ASSIGN_OR_RETURN(readers.exports, ResultReader::Open(store.file()));
  VS_ASSIGN_OR_RETURN(readers.watches, ResultReader::Open(store.file()));
  VS_ASSIGN_OR_RETURN(readers.query, SqlQuery::Open(store.file(), clock, kQueriesAtOnce));
  return std::unique_ptr<ResultService>(new ResultService(store, data_dir, std::move(readers)));
}

void ResultService::Register(Router& router) {
  const std::string service = "/visionserver.v1.ResultService/";
  router.Unary(service + "ListResults", this, &ResultService::ListResults, {.lane = Lane::kList});
  router.Unary(service + "GetResult", this, &ResultService::GetResult);
  router.Unary(service + "GetResultFile", this, &ResultService::GetResultFile,
               {.lane = Lane::kList});
  router.Unary(service + "QueryResults", this, &ResultService::QueryResults,
               {.lane = Lane::kQuery});
  router.Stream(service + "ExportResults", this, &ResultService::ExportResults);
  router.Stream(service + "WatchResults", this, &ResultService::WatchResults);
}

Result<pb::ListResultsResponse> ResultService::ListResults(const Call& /*call*/,
                                                           const pb::ListResultsRequest& request) {
  VS_ASSIGN_OR_RETURN(const ResultFilter filter, FromProto(request.filter()));
  VS_ASSIGN_OR_RETURN(const auto before, ParsePageToken(request.page_token()));
  const uint32_t size = request.page_size() == 0 ? kDefaultPage : request.page_size();
  if (size > kMaxPage) {
    return InvalidArgument(Str("page_size must be 1 to ", kMaxPage, ", or 0 for ", kDefaultPage));
  }
  VS_ASSIGN_OR_RETURN(const ResultPage page, readers_.lists->Before(filter, before, size));
  pb::ListResultsResponse response;
  for (const StoredResult& result : page.results) *response.add_results() = ToProto(result);
  if (page.more) response.set_next_page_token(std::to_string(page.results.back().number));
  return response;
}

Result<pb::Result> ResultService::GetResult(const Call& /*call*/,
                                            const pb::GetResultRequest& request) {
  VS_ASSIGN_OR_RETURN(const StoredResult result, readers_.single->Get(request.result_id()));
  return ToProto(result);
}

Result<pb::GetResultFileResponse> ResultService::GetResultFile(
    const Call& /*call*/, const pb::GetResultFileRequest& request) {
  VS_ASSIGN_OR_RETURN(const StoredResult result, readers_.single->Get(request.result_id()));
  const auto field = result.record.values.find(request.field());
  if (field == result.record.values.end()) {
    return NotFound(Str("result ", request.result_id(), " has no value ", Quoted(request.field())));
  }
  const auto* path = std::get_if<std::string>(&field->second);
  if (path == nullptr) {
    return InvalidArgument(Str("the value ", request.field(), " is no text, so it names no file"));
  }
  VS_ASSIGN_OR_RETURN(ResultFile file, ReadResultFile(data_dir_, *path));
  pb::GetResultFileResponse response;
  response.set_file_name(std::move(file.name));
  response.set_media_type(std::move(file.media_type));
  response.set_data(std::move(file.data));
  return response;
}

Result<pb::QueryResultsResponse> ResultService::QueryResults(
    const Call& call, const pb::QueryResultsRequest& request) {
  VS_ASSIGN_OR_RETURN(SqlLimits limits, LimitsOf(request));
  limits.since_ns = call.arrived_ns;
  std::vector<SqlValue> arguments;
  for (const pb::Value& argument : request.arguments()) {
    VS_ASSIGN_OR_RETURN(arguments.emplace_back(), ToSqlValue(argument));
  }
  VS_ASSIGN_OR_RETURN(const SqlTable table,
                      readers_.query->Run(request.sql(), arguments, limits,
                                          [&call] { return call.cancelled.stop_requested(); }));
  pb::QueryResultsResponse response;
  *response.mutable_table() = ToProto(table);
  response.set_truncated(table.truncated);
  return response;
}

Result<std::unique_ptr<StreamSource>> ResultService::ExportResults(
    const Call& /*call*/, const pb::ExportResultsRequest& request) {
  VS_ASSIGN_OR_RETURN(ResultFilter filter, FromProto(request.filter()));
  const auto exporter =
      std::make_shared<Exporter>(*readers_.exports, std::move(filter), store_.State().last_number);
  return std::make_unique<LoadingSource>(loads_, [exporter] { return exporter->Next(); });
}

Result<std::unique_ptr<StreamSource>> ResultService::WatchResults(
    const Call& /*call*/, const pb::WatchResultsRequest& request) {
  VS_ASSIGN_OR_RETURN(ResultFilter filter, FromProto(request.filter()));
  filter.from_ns = filter.until_ns = std::nullopt;
  const uint64_t newest = store_.State().last_number;
  if (request.after_number() > newest) {
    return OutOfRange(Str("the newest result has the number ", newest, ", not yet ",
                          request.after_number(),
                          ": the results were begun anew; go on after number 0"))
        .WithReason("RESULTS_BEGUN_ANEW");
  }
  const uint64_t first = request.has_after_number() ? request.after_number() : newest;
  const auto load = [this, filter, after = first]() mutable -> Result<LoadedPage> {
    // Looked at before reading: what comes later is announced.
    const uint64_t last = store_.State().last_number;
    VS_ASSIGN_OR_RETURN(const ResultPage found,
                        readers_.watches->After(filter, after, last, kRowsPerLoad));
    LoadedPage page;
    for (const StoredResult& result : found.results) {
      page.messages.push_back(Serialize(ToProto(result)));
    }
    after = found.more ? found.results.back().number : std::max(after, last);
    if (!found.more) page.then = LoadedPage::Then::kIdle;
    return page;
  };
  return std::make_unique<LoadingSource>(loads_, load, [this](std::function<void()> wake) {
    return store_.OnCommitted([wake = std::move(wake)](uint64_t) { wake(); });
  });
}

}  // namespace vs
