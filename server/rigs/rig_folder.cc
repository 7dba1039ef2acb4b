#include "server/rigs/rig_folder.h"

#include <set>
#include <utility>

#include "engine/base/str.h"
#include "engine/calibration/rig_file.h"
#include "engine/core/sequence_spec.h"

namespace vs {

Result<std::unique_ptr<RigFolder>> RigFolder::Open(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return FailedPrecondition(
        Str("the folder of stereo rigs ", folder.string(), " cannot be made: ", error.message()));
  }
  return std::unique_ptr<RigFolder>(new RigFolder(folder));
}

Result<std::shared_ptr<const StereoRig>> RigFolder::Find(const std::string& name) const {
  const std::filesystem::path file = folder_ / (name + ".json");
  // A name is a name, not a way to other folders.
  if (!IsSequenceId(name) || !std::filesystem::exists(file)) {
    return NotFound(Str("there is no stereo rig ", Quoted(name), "; stored are: ", Names()));
  }
  VS_ASSIGN_OR_RETURN(StereoRig rig, LoadRig(file));
  return std::make_shared<const StereoRig>(std::move(rig));
}

std::string RigFolder::Names() const {
  std::set<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
    if (entry.path().extension() == ".json") names.insert(entry.path().stem());
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text.substr(0, 500);
}

}  // namespace vs
