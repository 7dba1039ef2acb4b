#include <google/protobuf/util/time_util.h>

#include "visionserver/v1/user.grpc.pb.h"

#include "client/cli/command.h"
#include "client/cli/words.h"

namespace vs::cli {
namespace {

using Stub = v1::UserService::Stub;

Result<void> List(Session& session) {
  return Show(
      session, Ask(session, &Stub::ListApiKeys, {}), [](const v1::ListApiKeysResponse& response) {
        Table table({"KEY", "NAME", "ROLE", "MADE BY", "CREATED", "UNTIL", "LAST USED"});
        for (const v1::ApiKey& key : response.keys()) {
          table.Add({key.id(), key.name(), RoleWord(key.role()), key.created_by(),
                     TimeText(key.created()), TimeText(key.expires()), TimeText(key.last_used())});
        }
        table.Print("There are no API keys.");
      });
}

Result<void> Create(Session& session, const std::string& name, const std::string& role,
                    int64_t days) {
  v1::CreateApiKeyRequest request;
  request.set_name(name);
  VS_CLI_TRY(const v1::Role parsed, ParseRole(role));
  request.set_role(parsed);
  if (days > 0) {
    *request.mutable_expires() = google::protobuf::util::TimeUtil::GetCurrentTime();
    request.mutable_expires()->set_seconds(request.expires().seconds() + days * 24 * 3600);
  }
  return Show(session, Ask(session, &Stub::CreateApiKey, request),
              [](const v1::CreateApiKeyResponse& response) {
                PrintLine("key " + response.key().id() + " for " + response.key().name());
                PrintLine("secret, shown only now: " + response.secret());
              });
}

Result<void> Revoke(Session& session, const std::string& id) {
  v1::RevokeApiKeyRequest request;
  request.set_id(id);
  return Show(
      session, Ask(session, &Stub::RevokeApiKey, request),
      [](const v1::RevokeApiKeyResponse&) { PrintLine("The key opens nothing any more."); });
}

}  // namespace

void AddKeyCommands(CommandLine& line) {
  line.AddGroup("keys",
                "API keys, with which robots call without logging in (administrators only)");
  line.Add("keys list", "Show all keys, without their secrets").Run(List);

  Command& create = line.Add("keys create", "Make a key; its secret is shown once");
  const auto name = create.Positional("NAME", "For people, such as \"robot cell 7\"");
  const auto role = create.Text("--role", "ROLE", "robot, or viewer to read only", "robot");
  const auto days =
      create.Count("--days", "How long it is valid; 0: until it is revoked", 0, 0, 36'500);
  create.Example("visionctl keys create \"robot cell 7\"");
  create.Run([=](Session& session) { return Create(session, *name, *role, *days); });

  Command& revoke = line.Add("keys revoke", "Make a key useless");
  const auto id = revoke.Positional("KEY", "Its id, see keys list");
  revoke.Run([=](Session& session) { return Revoke(session, *id); });
}

}  // namespace vs::cli
