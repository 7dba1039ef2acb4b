#include "visionserver/v1/audit.grpc.pb.h"

#include "client/cli/command.h"
#include "client/cli/words.h"

namespace vs::cli {
namespace {

// "SequenceService/StartSequence" of "/visionserver.v1.SequenceService/StartSequence".
std::string ShortMethod(const std::string& method) {
  const size_t dot = method.rfind('.', method.rfind('/'));
  return dot == std::string::npos ? method : method.substr(dot + 1);
}

struct Arguments {
  Argument<std::string> user;
  Argument<std::string> method;
  Argument<std::string> from;
  Argument<std::string> until;
  Argument<int64_t> limit;
};

Result<v1::ListAuditEntriesRequest> ToRequest(const Arguments& arguments) {
  v1::ListAuditEntriesRequest request;
  request.set_user(*arguments.user);
  request.set_method(*arguments.method);
  request.set_page_size(static_cast<uint32_t>(*arguments.limit));
  if (!arguments.from->empty()) {
    VS_CLI_TRY(*request.mutable_from(), ParseTime(*arguments.from));
  }
  if (!arguments.until->empty()) {
    VS_CLI_TRY(*request.mutable_until(), ParseTime(*arguments.until));
  }
  return request;
}

Result<void> Audit(Session& session, const Arguments& arguments) {
  VS_CLI_TRY(const v1::ListAuditEntriesRequest request, ToRequest(arguments));
  return Show(session, Ask(session, &v1::AuditService::Stub::ListAuditEntries, request),
              [](const v1::ListAuditEntriesResponse& response) {
                Table table({"TIME", "USER", "FROM", "METHOD", "SUBJECT", "OUTCOME"});
                for (const v1::AuditEntry& entry : response.entries()) {
                  table.Add({TimeText(entry.time()), entry.user(), entry.address(),
                             ShortMethod(entry.method()), entry.subject(),
                             entry.ok() ? "ok" : entry.message()});
                }
                table.Print("Nothing was changed.");
              });
}

}  // namespace

void AddAuditCommand(CommandLine& line) {
  Command& audit = line.Add("audit", "Show who changed what, newest first (administrators only)");
  const Arguments arguments = {
      .user = audit.Text("--user", "NAME", "Only of this user or API key"),
      .method = audit.Text("--method", "TEXT", "Only methods whose name contains this"),
      .from = audit.Text("--from", "TIME", "At this time or later"),
      .until = audit.Text("--until", "TIME", "Before this time"),
      .limit = audit.Count("--limit", "How many to show at most", 50, 1, 1000)};
  audit.Example("visionctl audit --user ana --method SetParameters --limit 20");
  audit.Run([=](Session& session) { return Audit(session, arguments); });
}

}  // namespace vs::cli
