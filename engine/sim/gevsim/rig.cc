#include "engine/sim/gevsim/rig.h"

#include <utility>

#include "engine/base/clock.h"
#include "engine/base/str.h"
#include "engine/sim/demo_rig.h"
#include "engine/sim/gevsim/folder_camera.h"
#include "engine/sim/scene_camera.h"

namespace vs::sim {
namespace {

struct CameraPlan {
  Side side;
  const char* name;
  const char* serial_number;
  const std::string& address;
  const std::string& pattern;
  DeviceClock clock;
  double sensitivity;
};

Result<std::unique_ptr<PictureSource>> MakePictures(const Options& options,
                                                    const CameraPlan& plan) {
  if (!options.folder.empty()) {
    const std::vector<std::string> files = ListPictures(options.folder, plan.pattern);
    VS_ASSIGN_OR_RETURN(std::unique_ptr<PictureSource> pictures,
                        FolderCamera::Load(files, options.PicturePeriodNs(), {0, options.seed}));
    return pictures;
  }
  return std::make_unique<SceneCamera>(
      SceneCamera::Settings{.rig = options.ideal ? IdealRig() : DemoRig(),
                            .side = plan.side,
                            .sensitivity = plan.sensitivity,
                            .noise = {options.noise, options.seed}});
}

Status CheckFolder(const Options& options) {
  const size_t left = ListPictures(options.folder, options.left_pattern).size();
  const size_t right = ListPictures(options.folder, options.right_pattern).size();
  if (left > 0 && left == right) return {};
  return InvalidArgument(Str("--folder ", options.folder, " must hold as many left as right ",
                             "pictures; ", left, " match ", options.left_pattern, " and ", right,
                             " match ", options.right_pattern));
}

Result<std::unique_ptr<Device>> StartCamera(const Options& options, const CameraPlan& plan) {
  VS_ASSIGN_OR_RETURN(const uint32_t address, ParseAddress(plan.address));
  VS_ASSIGN_OR_RETURN(std::unique_ptr<PictureSource> pictures, MakePictures(options, plan));
  return Device::Start(
      {.serial_number = plan.serial_number,
       .user_name = plan.name,
       .address = address,
       .acquisition = {.clock = plan.clock,
                       .link_mbps = options.link_mbps,
                       .first_block_id = static_cast<uint16_t>(options.first_block_id)}},
      std::move(pictures));
}

}  // namespace

Result<std::unique_ptr<Rig>> Rig::Start(const Options& options) {
  if (!options.folder.empty()) VS_RETURN_IF_ERROR(CheckFolder(options));
  std::unique_ptr<Rig> rig(new Rig);
  const CameraPlan plans[] = {
      {Side::kLeft, "left", "21000001", options.left_address, options.left_pattern,
       options.LeftClock(), 1.0},
      {Side::kRight, "right", "21000002", options.right_address, options.right_pattern,
       options.RightClock(), options.right_sensitivity}};
  for (const CameraPlan& plan : plans) {
    if (!options.only.empty() && options.only != plan.name) continue;
    VS_ASSIGN_OR_RETURN(std::unique_ptr<Device> device, StartCamera(options, plan));
    rig->devices_.push_back({plan.name, std::move(device)});
  }
  for (const std::string& fault : options.faults) {
    if (const auto done = rig->Command(fault); !done) return done.error().Annotated("--fault");
  }
  rig->line_.emplace(options.line_hz > 0 ? options.PicturePeriodNs() : 0,
                     [&devices = rig->devices_](int64_t instant_ns) {
                       for (const NamedDevice& camera : devices) camera.device->OnLine(instant_ns);
                     });
  if (!options.control_path.empty()) {
    VS_ASSIGN_OR_RETURN(
        rig->control_,
        ControlSocket::Listen(options.control_path, [&rig = *rig](std::string_view command) {
          const auto answer = rig.Command(command);
          return answer ? *answer : "error: " + answer.error().message();
        }));
  }
  return rig;
}

std::vector<std::string> Rig::Greeting() const {
  std::vector<std::string> lines;
  for (const auto& [name, device] : devices_) {
    lines.push_back(Str("camera ", device->Settings().serial_number, " (", name, ") ready at ",
                        AddressText(device->Settings().address), ", ", device->Pictures().width(),
                        " x ", device->Pictures().height(), " px"));
  }
  return lines;
}

Result<std::string> Rig::Command(std::string_view command) {
  if (command == "trigger") {
    line_->Fire();
    return std::string("ok");
  }
  if (command == "stats") {
    std::string text;
    for (const auto& [name, device] : devices_) {
      text += Str(text.empty() ? "" : "; ", name, " ", device->Statistics());
    }
    return text;
  }
  const size_t space = command.find(' ');
  const std::string_view first = command.substr(0, space);
  const bool named = first == "left" || first == "right";
  const std::string_view fault =
      !named ? command : (space == std::string_view::npos ? "" : command.substr(space + 1));
  const int64_t now_ns = SystemClock().MonotonicNs();
  for (const auto& [name, device] : devices_) {
    if (named && name != first) continue;
    VS_RETURN_IF_ERROR(device->GetFaults().Apply(fault, now_ns));
  }
  return std::string("ok");
}

}  // namespace vs::sim
