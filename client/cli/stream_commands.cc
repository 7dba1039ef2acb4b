#include "client/cli/command.h"
#include "client/cli/words.h"

namespace vs::cli {
namespace {

Result<void> List(Session& session) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  return Show(session, client->ListStreams(), [](const v1::ListStreamsResponse& response) {
    Table table({"STREAM", "KIND", "SIZE", ">ITEMS", ">SUBSCRIBERS", "WHAT IT SHOWS"});
    for (const v1::StreamInfo& stream : response.streams()) {
      const std::string size = stream.width() == 0 ? "-"
                                                   : std::to_string(stream.width()) + "x" +
                                                         std::to_string(stream.height());
      table.Add({stream.stream(), StreamKindWord(stream.kind()), size, std::to_string(stream.seq()),
                 std::to_string(stream.subscribers()), stream.doc()});
    }
    table.Print("No sequence publishes anything now; visionctl sequences start SEQUENCE.");
  });
}

}  // namespace

void AddStreamCommands(CommandLine& line) {
  line.AddGroup("streams", "Live outputs of running sequences");
  line.Add("streams list", "Show what can be subscribed to").Run(List);
}

}  // namespace vs::cli
