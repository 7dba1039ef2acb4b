#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "visionserver/v1/sequence.grpc.pb.h"

#include "client/cli/command.h"
#include "client/cli/sequence_text.h"
#include "client/cli/words.h"
#include "client/values.h"

namespace vs::cli {
namespace {

using Stub = v1::SequenceService::Stub;

Result<void> List(Session& session) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  return Show(session, client->ListSequences(), [](const v1::ListSequencesResponse& response) {
    Table table({"SEQUENCE", "STATE", ">REVISION", "CHANGED", "BY", "AUTOSTART"});
    for (const v1::Sequence& one : response.sequences()) {
      table.Add({one.id(), RunStateWord(one.run_state()), std::to_string(one.revision()),
                 TimeText(one.updated()), one.updated_by(), one.autostart() ? "yes" : "no"});
    }
    table.Print("No sequences are stored.");
  });
}

Result<void> ShowOne(Session& session, const std::string& id) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  return Show(session, client->GetSequence(id), [](const v1::Sequence& sequence) {
    std::fputs(SequenceToJson(sequence.id(), sequence.spec()).c_str(), stdout);
  });
}

// A name of something that is stored, or a file.
Result<v1::ValidateSequenceRequest> Subject(const std::string& id, const std::string& file) {
  v1::ValidateSequenceRequest request;
  if (file.empty()) {
    request.set_id(id);
  } else {
    VS_CLI_TRY(NamedSpec read, ReadSequenceFile(file));
    *request.mutable_spec() = std::move(read.spec);
  }
  return request;
}

// Who writes "s.json" for the id of a sequence means --file.
Result<void> CheckIsNoFile(const std::string& id) {
  std::error_code ignored;
  if (id.find_first_of("./") == std::string::npos || !std::filesystem::exists(id, ignored)) {
    return {};
  }
  return client::Failure(client::Code::kInvalidArgument,
                         id + " is a file, not a sequence; did you mean --file " + id + "?");
}

Result<void> Validate(Session& session, const std::string& id, const std::string& file) {
  if (id.empty() == file.empty()) {
    return client::Failure(client::Code::kInvalidArgument,
                           "name one stored sequence, or a file with --file");
  }
  if (auto checked = CheckIsNoFile(id); !checked) return checked;
  const std::string name = file.empty() ? id : file;
  VS_CLI_TRY(const v1::ValidateSequenceRequest request, Subject(id, file));
  VS_CLI_TRY(const v1::ValidateSequenceResponse response,
             Ask(session, &Stub::ValidateSequence, request));
  if (response.faults().empty() || session.options().json) {
    auto done = Show(session, Result<v1::ValidateSequenceResponse>(response),
                     [&](const auto&) { PrintLine(name + " has no faults."); });
    if (response.faults().empty()) return done;
  }
  client::Error error{.code = client::Code::kInvalidArgument,
                      .message = name + " has " + std::to_string(response.faults_size()) +
                                 (response.faults_size() == 1 ? " fault" : " faults") +
                                 " and cannot be started",
                      .reason = "INVALID_ARGUMENT",
                      .faults = {}};
  for (const v1::Fault& fault : response.faults()) {
    error.faults.push_back({.subject = fault.subject(), .message = fault.message()});
  }
  return tl::unexpected(error);
}

// What the sources say of their pictures.
void PrintReadings(const v1::SequenceState& state) {
  Table table({"BLOCK", "READING", ">VALUE"});
  bool any = false;
  for (const v1::BlockState& block : state.blocks()) {
    for (const v1::Reading& reading : block.readings()) {
      table.Add({block.block(), reading.name(), client::ToText(reading.value())});
      any = true;
    }
  }
  if (any) table.Print("");
}

void PrintState(const v1::SequenceState& state) {
  PrintLine(state.sequence() + ": " + RunStateWord(state.state()) +
            (state.revision() == 0 ? "" : ", revision " + std::to_string(state.revision())));
  if (state.revision() != 0) {
    PrintLine(NumberText(state.frames_per_second(), 1) + " fps, " + std::to_string(state.frames()) +
              " frames, " + std::to_string(state.dropped()) + " dropped at the source, " +
              std::to_string(state.failed()) + " failed; latency p50 " +
              NumberText(state.latency_p50_us() / 1000, 1) + " ms, p99 " +
              NumberText(state.latency_p99_us() / 1000, 1) + " ms");
    if (state.latency_budget_ms() != 0) {
      PrintLine(std::to_string(state.over_budget()) + " frames took longer than the budget of " +
                NumberText(state.latency_budget_ms(), 1) + " ms");
    }
    Table table({"BLOCK", ">RUNS", ">FAILED", ">P50 MS", ">P99 MS", ">SKIPPED", "LAST ERROR"});
    for (const v1::BlockState& block : state.blocks()) {
      table.Add({block.block(), std::to_string(block.runs()), std::to_string(block.failures()),
                 NumberText(block.p50_us() / 1000, 2), NumberText(block.p99_us() / 1000, 2),
                 std::to_string(block.skipped()), block.last_error()});
    }
    table.Print("It has no blocks.");
    PrintReadings(state);
  }
  if (state.has_last_error()) {
    const v1::SequenceError& error = state.last_error();
    PrintLine("last error, since " + TimeText(error.time()) + ": " + error.path() + ": " +
              error.message());
  }
}

void PrintShortState(const v1::SequenceState& state) {
  PrintLine(state.sequence() + ": " + RunStateWord(state.state()));
}

Result<void> Create(Session& session, const std::string& id, const std::string& file,
                    bool autostart, bool allow_faults) {
  if (auto checked = CheckIsNoFile(id); !checked) return checked;
  if (file.empty() && ::isatty(STDIN_FILENO) != 0) {
    return client::Failure(client::Code::kInvalidArgument,
                           "name the sequence's JSON with --file, or pipe it in");
  }
  VS_CLI_TRY(NamedSpec read, ReadSequenceFile(file.empty() ? "-" : file));
  v1::CreateSequenceRequest request;
  request.set_id(id.empty() ? read.id : id);
  *request.mutable_spec() = std::move(read.spec);
  request.set_autostart(autostart);
  request.set_allow_faults(allow_faults);
  return Show(session, Ask(session, &Stub::CreateSequence, request), [](const v1::Sequence& made) {
    PrintLine(made.id() + " is stored as revision " + std::to_string(made.revision()) + ".");
  });
}

Result<void> Update(Session& session, const std::string& id, const std::string& file,
                    const std::string& autostart, const std::string& etag, bool allow_faults) {
  v1::UpdateSequenceRequest request;
  request.set_id(id);
  request.set_allow_faults(allow_faults);
  if (!file.empty()) {
    VS_CLI_TRY(NamedSpec read, ReadSequenceFile(file));
    *request.mutable_spec() = std::move(read.spec);
    request.mutable_update_mask()->add_paths("spec");
  }
  if (!autostart.empty()) {
    request.set_autostart(autostart == "on");
    request.mutable_update_mask()->add_paths("autostart");
  }
  if (request.update_mask().paths().empty()) {
    return client::Failure(client::Code::kInvalidArgument,
                           "say what to change: --file, --autostart");
  }
  request.set_etag(etag);
  if (etag.empty()) {
    VS_CLI_TRY(client::Client * client, session.Connect());
    VS_CLI_TRY(const v1::Sequence stored, client->GetSequence(id));
    request.set_etag(stored.etag());
  }
  return Show(session, Ask(session, &Stub::UpdateSequence, request), [](const v1::Sequence& now) {
    PrintLine(now.id() + " is stored as revision " + std::to_string(now.revision()) +
              (now.running_revision() == 0 || now.running_revision() == now.revision()
                   ? "."
                   : "; what runs is revision " + std::to_string(now.running_revision()) + "."));
  });
}

Result<void> Delete(Session& session, const std::string& id) {
  v1::DeleteSequenceRequest request;
  request.set_id(id);
  return Show(session, Ask(session, &Stub::DeleteSequence, request),
              [&](const v1::DeleteSequenceResponse&) { PrintLine(id + " is deleted."); });
}

Result<void> Blocks(Session& session) {
  return Show(session, Ask(session, &Stub::ListBlockTypes, {}),
              [](const v1::ListBlockTypesResponse& response) {
                const auto names = [](const auto& ports) {
                  std::string text;
                  for (const v1::PortInfo& port : ports) {
                    text += (text.empty() ? "" : " ") + port.name() + ":" + port.type() +
                            (port.optional() ? "?" : "");
                  }
                  return text;
                };
                Table table({"CATEGORY", "TYPE", "INPUTS", "OUTPUTS", "WHAT IT DOES"});
                for (const v1::BlockType& type : response.block_types()) {
                  table.Add({type.category(), type.type(), names(type.inputs()),
                             names(type.outputs()), type.doc()});
                }
                table.Print("The server has no blocks.");
              });
}

template <class Do>
void AddForOne(CommandLine& line, const std::string& path, const std::string& doc, Do run) {
  Command& command = line.Add(path, doc);
  const auto id = command.Positional("SEQUENCE", "Its id, see sequences list");
  command.Example("visionctl " + path + " stereo_depth");
  command.Run([=](Session& session) { return run(session, *id); });
}

void AddStartStop(CommandLine& line) {
  const auto with = [](auto call, auto print) {
    return [=](Session& session, const std::string& id) -> Result<void> {
      VS_CLI_TRY(client::Client * client, session.Connect());
      return Show(session, (client->*call)(id), print);
    };
  };
  AddForOne(line, "sequences start", "Start a stored sequence",
            with(&client::Client::StartSequence, PrintShortState));
  AddForOne(line, "sequences stop", "Stop a sequence after the frames in flight",
            with(&client::Client::StopSequence, PrintShortState));
  AddForOne(line, "sequences state", "Show rate, latency and errors, block by block",
            with(&client::Client::GetSequenceState, PrintState));
}

void AddEditing(CommandLine& line) {
  Command& validate = line.Add("sequences validate", "Check a sequence; shows all faults at once");
  const auto stored = validate.OptionalPositional("SEQUENCE", "Its id");
  const auto checked = validate.Text("--file", "FILE", "Check this JSON instead; - reads it");
  validate.Example("visionctl sequences validate stereo_depth")
      .Example("visionctl sequences validate --file stereo_depth.json");
  validate.Run([=](Session& session) { return Validate(session, *stored, *checked); });

  Command& create = line.Add("sequences create", "Store a new sequence from a JSON file");
  const auto named = create.OptionalPositional("SEQUENCE", "Its id; otherwise that in the file");
  const auto file = create.Text("--file", "FILE",
                                "As sequences show prints it; otherwise it is read from a pipe");
  const auto autostart = create.Flag("--autostart", "Start it whenever the server starts");
  const auto faulty = create.Flag("--allow-faults", "Store it although it cannot be started yet");
  create.Example("visionctl sequences create --file stereo_depth.json --autostart");
  create.Run([=](Session& session) { return Create(session, *named, *file, *autostart, *faulty); });

  Command& update = line.Add("sequences update", "Replace a stored sequence");
  const auto id = update.Positional("SEQUENCE", "Its id, see sequences list");
  const auto new_file = update.Text("--file", "FILE", "As sequences show prints it; - reads it");
  const auto start =
      update.Choice("--autostart", "Start it whenever the server starts", {"on", "off"}, "");
  const auto etag = update.Text("--etag", "ETAG",
                                "Refuse if somebody changed it since (see sequences show --json)");
  const auto faults = update.Flag("--allow-faults", "Store it although it cannot be started yet");
  update.Example("visionctl sequences show stereo_depth > s.json")
      .Example("visionctl sequences update stereo_depth --file s.json");
  update.Run(
      [=](Session& session) { return Update(session, *id, *new_file, *start, *etag, *faults); });
}

}  // namespace

void AddSequenceCommands(CommandLine& line) {
  line.AddGroup("sequences", "Sequences: what the server does with pictures");
  line.Add("sequences list", "Show the stored sequences and which of them run").Run(List);
  AddForOne(line, "sequences show", "Print a sequence as JSON, to edit or to keep", ShowOne);
  AddStartStop(line);
  AddEditing(line);
  AddForOne(line, "sequences delete", "Delete a sequence that does not run", Delete);
  line.Add("sequences blocks", "Show every block there is to build sequences of").Run(Blocks);
}

}  // namespace vs::cli
