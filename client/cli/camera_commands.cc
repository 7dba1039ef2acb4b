#include <algorithm>

#include "visionserver/v1/camera.grpc.pb.h"

#include "client/cli/command.h"
#include "client/cli/parse_value.h"
#include "client/cli/words.h"

namespace vs::cli {
namespace {

void PrintCameras(const google::protobuf::RepeatedPtrField<v1::Camera>& cameras) {
  Table table({"CAMERA", "STATE", ">FPS", ">FRAMES", ">LOST", ">INCOMPLETE", ">RESENT", "URI",
               "MODEL", "TROUBLE"});
  for (const v1::Camera& camera : cameras) {
    const v1::CameraCounters& counters = camera.counters();
    table.Add({camera.id(), CameraStateWord(camera.state()),
               NumberText(counters.frames_per_second(), 1), std::to_string(counters.frames()),
               std::to_string(counters.lost()), std::to_string(counters.incomplete()),
               std::to_string(counters.resent()), camera.uri(), camera.vendor_model(),
               camera.last_error()});
  }
  table.Print("The server knows no cameras; visionctl cameras discover looks for some.");
}

Result<void> List(Session& session) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  return Show(session, client->ListCameras(),
              [](const v1::ListCamerasResponse& response) { PrintCameras(response.cameras()); });
}

Result<void> Discover(Session& session, int64_t timeout_ms) {
  v1::DiscoverCamerasRequest request;
  request.set_timeout_ms(static_cast<uint32_t>(timeout_ms));
  const auto found = Ask(session, &v1::CameraService::Stub::DiscoverCameras, request);
  return Show(session, found, [](const v1::DiscoverCamerasResponse& response) {
    Table table({"URI", "MODEL", "SERIAL", "ADDRESS", "NAME", "KNOWN AS"});
    for (const v1::DiscoveredCamera& camera : response.cameras()) {
      table.Add({camera.uri(), camera.vendor_model(), camera.serial(), camera.address(),
                 camera.user_name(), camera.known_as()});
    }
    table.Print("No camera answered.");
  });
}

std::string Range(const v1::FeatureInfo& info) {
  if (!info.choices().empty()) {
    std::string text;
    for (const std::string& choice : info.choices()) text += (text.empty() ? "" : "|") + choice;
    return text;
  }
  if (!info.has_min() && !info.has_max()) return "";
  return client::ToText(client::ToValue(info.min())) + " .. " +
         client::ToText(client::ToValue(info.max()));
}

Result<void> Features(Session& session, const std::string& camera) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  return Show(session, client->ListFeatures(camera), [](const v1::ListFeaturesResponse& response) {
    Table table({"FEATURE", "TYPE", "SET", "RANGE", "UNIT"});
    for (const v1::FeatureInfo& info : response.features()) {
      table.Add({info.name(), FeatureTypeWord(info.type()), info.writable() ? "yes" : "no",
                 Range(info), info.unit()});
    }
    table.Print("The camera names no features.");
  });
}

template <class Response>
void PrintFeatures(const Response& response) {
  Table table({"FEATURE", "VALUE"});
  for (const v1::FeatureValue& feature : response.values()) {
    table.Add({feature.name(), client::ToText(feature.value())});
  }
  table.Print("");
}

Result<void> Get(Session& session, const std::string& camera,
                 const std::vector<std::string>& names) {
  v1::GetFeaturesRequest request;
  request.set_id(camera);
  for (const std::string& name : names) request.add_names(name);
  return Show(session, Ask(session, &v1::CameraService::Stub::GetFeatures, request),
              [](const v1::GetFeaturesResponse& response) { PrintFeatures(response); });
}

Result<void> Set(Session& session, const std::string& camera,
                 const std::vector<std::string>& pairs) {
  VS_CLI_TRY(const std::vector<NameAndText> settings, InPairs(pairs, "FEATURE VALUE"));
  VS_CLI_TRY(client::Client * client, session.Connect());
  VS_CLI_TRY(const v1::ListFeaturesResponse known, client->ListFeatures(camera));
  v1::SetFeaturesRequest request;
  request.set_id(camera);
  for (const NameAndText& setting : settings) {
    const auto info =
        std::find_if(known.features().begin(), known.features().end(),
                     [&](const v1::FeatureInfo& one) { return one.name() == setting.name; });
    if (info == known.features().end()) {
      return client::Failure(client::Code::kNotFound, camera + " has no feature " + setting.name +
                                                          "; visionctl cameras features " + camera +
                                                          " lists them");
    }
    v1::FeatureValue* value = request.add_values();
    value->set_name(setting.name);
    VS_CLI_TRY(*value->mutable_value(), ParseFeature(setting, info->type()));
  }
  return Show(session, Ask(session, &v1::CameraService::Stub::SetFeatures, request),
              [](const v1::SetFeaturesResponse& response) { PrintFeatures(response); });
}

Result<void> Trigger(Session& session, const std::string& camera) {
  v1::TriggerCameraRequest request;
  request.set_id(camera);
  return Show(session, Ask(session, &v1::CameraService::Stub::TriggerCamera, request),
              [](const v1::TriggerCameraResponse&) { PrintLine("Triggered."); });
}

}  // namespace

void AddCameraCommands(CommandLine& line) {
  line.AddGroup("cameras", "Cameras: what there is, and their features");

  line.Add("cameras list", "Show the cameras that the server knows").Run(List);

  Command& discover = line.Add("cameras discover", "Look for cameras on the server's networks");
  const auto wait_ms =
      discover.Count("--wait-ms", "How long to wait for answers, milliseconds", 1000, 100, 10'000);
  discover.Run([wait_ms](Session& session) { return Discover(session, *wait_ms); });

  Command& features = line.Add("cameras features", "Show what can be read and set on a camera");
  const auto of = features.Positional("CAMERA", "Its id, see cameras list");
  features.Example("visionctl cameras features left");
  features.Run([of](Session& session) { return Features(session, *of); });

  Command& get = line.Add("cameras get", "Read features of a camera");
  const auto get_camera = get.Positional("CAMERA", "Its id, see cameras list");
  const auto names = get.Positionals("FEATURE", "GenICam names");
  get.Example("visionctl cameras get left ExposureTimeAbs GainRaw");
  get.Run([=](Session& session) { return Get(session, *get_camera, *names); });

  Command& set = line.Add("cameras set", "Set features of a camera, in the given order");
  const auto set_camera = set.Positional("CAMERA", "Its id, see cameras list");
  const auto pairs = set.Positionals("FEATURE VALUE", "GenICam names, each with its value");
  set.Example("visionctl cameras set left ExposureTimeAbs 8000")
      .Example("visionctl cameras set left TriggerMode On TriggerSource Software");
  set.Run([=](Session& session) { return Set(session, *set_camera, *pairs); });

  Command& trigger = line.Add("cameras trigger", "Take one picture by software trigger");
  const auto triggered = trigger.Positional("CAMERA", "Its id, see cameras list");
  trigger.Run([triggered](Session& session) { return Trigger(session, *triggered); });
}

}  // namespace vs::cli
