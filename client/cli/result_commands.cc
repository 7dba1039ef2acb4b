#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "visionserver/v1/result.grpc.pb.h"

#include "client/cli/command.h"
#include "client/cli/interrupt.h"
#include "client/cli/words.h"

namespace vs::cli {
namespace {

struct FilterArguments {
  Argument<std::string> sequence;
  Argument<std::string> part;
  Argument<std::string> result_class;
};

FilterArguments AddFilter(Command& command) {
  return {.sequence = command.Text("--sequence", "SEQUENCE", "Only of this sequence"),
          .part = command.Text("--part", "ID", "Only of this part"),
          .result_class = command.Text("--class", "CLASS", "Only pass, warn or fail")};
}

Result<v1::ResultFilter> ToFilter(const FilterArguments& arguments) {
  v1::ResultFilter filter;
  filter.set_job_id(*arguments.sequence);
  filter.set_part_id(*arguments.part);
  VS_CLI_TRY(const v1::ResultClass result_class, ParseResultClass(*arguments.result_class));
  filter.set_result_class(result_class);
  return filter;
}

Result<void> Query(Session& session, const std::string& sql,
                   const std::vector<std::string>& arguments, int64_t max_rows) {
  v1::QueryResultsRequest request;
  request.set_sql(sql);
  request.set_max_rows(static_cast<uint32_t>(max_rows));
  for (const std::string& argument : arguments) {
    *request.add_arguments() = client::ToValue(argument);
  }
  return Show(session, Ask(session, &v1::ResultService::Stub::QueryResults, request),
              [](const v1::QueryResultsResponse& response) {
                Table table({response.table().columns().begin(), response.table().columns().end()});
                for (const v1::Table::Row& row : response.table().rows()) {
                  std::vector<std::string> cells;
                  for (const v1::Value& cell : row.cells()) cells.push_back(client::ToText(cell));
                  table.Add(std::move(cells));
                }
                table.Print("No rows.");
                if (response.truncated()) {
                  std::cerr << "There are more rows; --max-rows shows up to 10000.\n";
                }
              });
}

void PrintResult(const v1::Result& result) {
  std::string line = std::to_string(result.number()) + "  " + TimeText(result.creation_time()) +
                     "  " + result.job_id() + "  " + ResultClassWord(result.result_class());
  if (!result.part_id().empty()) line += "  part " + result.part_id();
  for (const v1::ResultField& field : result.fields()) {
    line += "  " + field.name() + "=" + client::ToText(field.value());
  }
  if (!result.reason().empty()) line += "  (" + result.reason() + ")";
  PrintLine(line);
  std::fflush(stdout);
}

Result<void> Tail(Session& session, const FilterArguments& arguments, int64_t lines,
                  int64_t after) {
  VS_CLI_TRY(const v1::ResultFilter filter, ToFilter(arguments));
  VS_CLI_TRY(client::Client * client, session.Connect());
  if (!arguments.sequence->empty()) {
    // One that is not there would be waited for without end.
    if (auto state = client->GetSequenceState(*arguments.sequence); !state) {
      return tl::unexpected(state.error());
    }
  }
  const Interrupt interrupt;
  client::ResultStream results = client->WatchResults(
      filter, after < 0 ? std::nullopt : std::optional(static_cast<uint64_t>(after)));
  for (int64_t printed = 0; (lines == 0 || printed < lines) && !interrupt.requested();) {
    const Result<v1::Result> result = results.Next(Interrupt::kGlance);
    if (!result && result.error().code == client::Code::kDeadlineExceeded) continue;
    if (!result) return tl::unexpected(result.error());
    ++printed;
    if (session.options().json) {
      PrintJson(*result, /*indented=*/false);
    } else {
      PrintResult(*result);
      std::cout.flush();
    }
  }
  return {};
}

struct Period {
  Argument<std::string> from;
  Argument<std::string> until;
};

Result<v1::ExportResultsRequest> ExportRequest(const FilterArguments& arguments,
                                               const Period& period) {
  v1::ExportResultsRequest request;
  VS_CLI_TRY(*request.mutable_filter(), ToFilter(arguments));
  if (!period.from->empty()) {
    VS_CLI_TRY(*request.mutable_filter()->mutable_from(), ParseTime(*period.from));
  }
  if (!period.until->empty()) {
    VS_CLI_TRY(*request.mutable_filter()->mutable_until(), ParseTime(*period.until));
  }
  return request;
}

Result<void> Export(Session& session, const FilterArguments& arguments, const Period& period,
                    const std::string& path) {
  VS_CLI_TRY(const v1::ExportResultsRequest request, ExportRequest(arguments, period));
  VS_CLI_TRY(client::Client * client, session.Connect());
  std::ofstream file;
  if (path != "-") file.open(path, std::ios::binary);
  std::ostream& out = path == "-" ? std::cout : file;
  grpc::ClientContext context;
  client->connection()->Prepare(context, std::nullopt);
  v1::ResultService::Stub stub(client->connection()->channel());
  const auto reader = stub.ExportResults(&context, request);
  v1::ExportResultsResponse piece;
  while (out && reader->Read(&piece)) out << piece.data();
  out.flush();
  if (!out) {
    context.TryCancel();
    reader->Finish();
    return client::Failure(client::Code::kUnknown, "cannot write " + path);
  }
  const grpc::Status status = reader->Finish();
  if (!status.ok()) return tl::unexpected(client::ToError(status));
  return {};
}

Result<void> File(Session& session, const std::string& result_id, const std::string& field,
                  const std::string& out) {
  v1::GetResultFileRequest request;
  request.set_result_id(result_id);
  request.set_field(field);
  VS_CLI_TRY(const v1::GetResultFileResponse response,
             Ask(session, &v1::ResultService::Stub::GetResultFile, request));
  if (out == "-") {
    std::cout << response.data() << std::flush;
    return {};
  }
  const std::filesystem::path path = out.empty()
                                         ? std::filesystem::path(response.file_name()).filename()
                                         : std::filesystem::path(out);
  std::ofstream file(path, std::ios::binary);
  file << response.data();
  file.close();
  if (!file) return client::Failure(client::Code::kUnknown, "cannot write " + path.string());
  PrintLine(path.string() + ": " + std::to_string(response.data().size()) + " bytes");
  return {};
}

}  // namespace

void AddResultCommands(CommandLine& line) {
  line.AddGroup("results", "Results: what sequences found");

  Command& query = line.Add("results query", "Ask the result tables in SQL (SELECT only)");
  const auto sql = query.Positional("SQL", "One SELECT of SQLite");
  const auto arguments = query.Texts("--arg", "TEXT", "Takes the place of ?1, then ?2 ...");
  const auto max_rows = query.Count("--max-rows", "How many rows to show at most", 1000, 1, 10'000);
  query.Example("visionctl results query \"SELECT * FROM result ORDER BY number DESC LIMIT 5\"")
      .Example(
          "visionctl results query \"SELECT count(*) FROM result WHERE part_id = ?1\" --arg P-17")
      .Example(
          "visionctl results query "
          "\"SELECT avg(value) FROM result_field WHERE name = 'valid_percent'\"");
  query.Run([=](Session& session) { return Query(session, *sql, *arguments, *max_rows); });

  Command& tail = line.Add("results tail", "Print each new result, until Ctrl-C");
  const FilterArguments tail_filter = AddFilter(tail);
  const auto lines = tail.Count("--lines", "End after so many; 0: never", 0, 0, 1'000'000'000);
  const auto after = tail.Count("--after", "Begin with those stored after this number; -1: now", -1,
                                -1, INT64_MAX);
  tail.Example("visionctl results tail --sequence inspect --class fail");
  tail.Run([=](Session& session) { return Tail(session, tail_filter, *lines, *after); });

  Command& fetch = line.Add("results file", "Fetch the picture or point cloud that a result names");
  const auto result_id = fetch.Positional("RESULT_ID", "Which result");
  const auto field = fetch.Positional("FIELD", "Its value with the path, such as picture");
  const auto out = fetch.Text(
      "--out", "FILE", "Where to; - is standard output. Without it: here, under its own name");
  fetch.Example(
      "visionctl results file 019b2a6c-0f3e-7c1a-8f57-1d2a3b4c5d6e picture --out part.png");
  fetch.Run([=](Session& session) { return File(session, *result_id, *field, *out); });

  Command& write = line.Add("results export", "Write results as CSV");
  const FilterArguments filter = AddFilter(write);
  const Period period = {.from = write.Text("--from", "TIME", "Created at this time or later"),
                         .until = write.Text("--until", "TIME", "Created before this time")};
  const auto path = write.Text("--out", "FILE", "Where to; - is standard output", "-");
  write.Example("visionctl results export --from 2026-01-31 --out january.csv");
  write.Run([=](Session& session) { return Export(session, filter, period, *path); });
}

}  // namespace vs::cli
