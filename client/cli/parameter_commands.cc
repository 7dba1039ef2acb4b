#include <algorithm>

#include "client/cli/command.h"
#include "client/cli/parse_value.h"
#include "client/cli/words.h"

namespace vs::cli {
namespace {

std::string Range(const v1::ParameterInfo& info) {
  if (!info.choices().empty()) {
    std::string text;
    for (const std::string& choice : info.choices()) text += (text.empty() ? "" : "|") + choice;
    return text;
  }
  const auto limit = [](bool given, double value) {
    return given ? client::ToText(client::ToValue(value)) : std::string();
  };
  if (!info.has_min() && !info.has_max()) return "";
  return limit(info.has_min(), info.min()) + " .. " + limit(info.has_max(), info.max());
}

bool IsMeant(const v1::Parameter& parameter, const std::vector<std::string>& paths) {
  return paths.empty() || std::any_of(paths.begin(), paths.end(), [&](const std::string& path) {
           return parameter.path() == path || parameter.path().starts_with(path + ".");
         });
}

Result<void> Get(Session& session, const std::string& sequence,
                 const std::vector<std::string>& paths) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  VS_CLI_TRY(v1::ListParametersResponse response, client->ListParameters(sequence));
  auto* parameters = response.mutable_parameters();
  parameters->erase(std::remove_if(parameters->begin(), parameters->end(),
                                   [&](const v1::Parameter& one) { return !IsMeant(one, paths); }),
                    parameters->end());
  if (parameters->empty() && !paths.empty()) {
    return client::Failure(client::Code::kNotFound, sequence + " has no parameter or block \"" +
                                                        paths.front() + "\"; visionctl get " +
                                                        sequence + " lists them all");
  }
  return Show(
      session, Result<v1::ListParametersResponse>(response),
      [](const v1::ListParametersResponse& shown) {
        Table table({"PARAMETER", ">VALUE", "UNIT", "RANGE", "WHO", "WHAT IT DOES"});
        for (const v1::Parameter& one : shown.parameters()) {
          table.Add({one.path(), client::ToText(one.value()), one.info().unit(), Range(one.info()),
                     one.info().operator_editable() ? "operator" : "engineer", one.info().doc()});
        }
        table.Print("The sequence has no parameters.");
      });
}

Result<void> Set(Session& session, const std::string& sequence,
                 const std::vector<std::string>& pairs) {
  VS_CLI_TRY(const std::vector<NameAndText> settings, InPairs(pairs, "BLOCK.PARAM VALUE"));
  VS_CLI_TRY(client::Client * client, session.Connect());
  VS_CLI_TRY(const v1::ListParametersResponse known, client->ListParameters(sequence));
  std::vector<client::Client::ParameterSetting> values;
  for (const NameAndText& setting : settings) {
    const auto parameter =
        std::find_if(known.parameters().begin(), known.parameters().end(),
                     [&](const v1::Parameter& one) { return one.path() == setting.name; });
    if (parameter == known.parameters().end()) {
      return client::Failure(client::Code::kNotFound, sequence + " has no parameter " +
                                                          setting.name + "; visionctl get " +
                                                          sequence + " lists them all");
    }
    VS_CLI_TRY(v1::Value value, ParseParameter(setting, parameter->info()));
    values.push_back({.path = setting.name, .value = std::move(value)});
  }
  return Show(session, client->SetParameters(sequence, values),
              [](const v1::SetParametersResponse& response) {
                for (const v1::ParameterValue& one : response.values()) {
                  PrintLine(one.path() + " = " + client::ToText(one.value()));
                }
                PrintLine(response.applied_at_frame() == 0
                              ? "Stored; the sequence does not run."
                              : "Stored, and in force from frame " +
                                    std::to_string(response.applied_at_frame()) + " on.");
              });
}

}  // namespace

void AddParameterCommands(CommandLine& line) {
  Command& get = line.Add("get", "Show parameters of a sequence with range, unit and meaning");
  const auto get_sequence = get.Positional("SEQUENCE", "Its id, see sequences list");
  const auto paths = get.Positionals("BLOCK[.PARAM]", "Only these", /*optional=*/true);
  get.Example("visionctl get stereo_depth").Example("visionctl get stereo_depth match.p2");
  get.Run([=](Session& session) { return Get(session, *get_sequence, *paths); });

  Command& set = line.Add("set", "Set parameters of a sequence, all at once between two frames");
  const auto set_sequence = set.Positional("SEQUENCE", "Its id, see sequences list");
  const auto pairs = set.Positionals("BLOCK.PARAM VALUE", "Parameters, each with its value");
  set.Example("visionctl set stereo_depth match.p2 40")
      .Example("visionctl set stereo_depth match.p1 8 match.p2 40");
  set.Run([=](Session& session) { return Set(session, *set_sequence, *pairs); });
}

}  // namespace vs::cli
