#pragma once

#include <filesystem>
#include <memory>
#include <utility>

#include "visionserver/v1/result.pb.h"

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "server/results/result_reader.h"
#include "server/results/result_store.h"
#include "server/results/sql_query.h"
#include "server/rpc/executor.h"
#include "server/rpc/router.h"

namespace vs {

// Reading what sequences found: see result.proto. Only what is on the disk is shown.
class ResultService {
 public:
  // Store and clock must outlive it, and it its open streams. `data_dir` is where the files lie
  // that results name.
  static Result<std::unique_ptr<ResultService>> Make(ResultStore& store,
                                                     const std::filesystem::path& data_dir,
                                                     const Clock& clock);
  void Register(Router& router);

 private:
  // Connections of their own, so that a long list or export keeps nobody else waiting.
  struct Readers {
    std::unique_ptr<ResultReader> single;
    std::unique_ptr<ResultReader> lists;
    std::unique_ptr<ResultReader> exports;
    std::unique_ptr<ResultReader> watches;
    std::unique_ptr<SqlQuery> query;
  };

  ResultService(ResultStore& store, std::filesystem::path data_dir, Readers readers)
      : store_(store), data_dir_(std::move(data_dir)), readers_(std::move(readers)) {}

  Result<visionserver::v1::ListResultsResponse> ListResults(
      const Call& call, const visionserver::v1::ListResultsRequest& request);
  Result<visionserver::v1::Result> GetResult(const Call& call,
                                             const visionserver::v1::GetResultRequest& request);
  Result<visionserver::v1::GetResultFileResponse> GetResultFile(
      const Call& call, const visionserver::v1::GetResultFileRequest& request);
  Result<visionserver::v1::QueryResultsResponse> QueryResults(
      const Call& call, const visionserver::v1::QueryResultsRequest& request);
  Result<std::unique_ptr<StreamSource>> ExportResults(
      const Call& call, const visionserver::v1::ExportResultsRequest& request);
  Result<std::unique_ptr<StreamSource>> WatchResults(
      const Call& call, const visionserver::v1::WatchResultsRequest& request);

  ResultStore& store_;
  const std::filesystem::path data_dir_;
  const Readers readers_;
  Executor loads_{2, 1024};  // last: it goes first
};

}  // namespace vs
