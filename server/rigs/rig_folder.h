#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "engine/base/status.h"
#include "engine/core/environment.h"

namespace vs {

// The stored stereo rigs: one file NAME.json each (see engine/calibration/rig_file.h), read when a
// block asks for it, so that a new file needs no restart. Thread-safe.
class RigFolder final : public RigStore {
 public:
  // Makes the folder if necessary.
  static Result<std::unique_ptr<RigFolder>> Open(const std::filesystem::path& folder);

  Result<std::shared_ptr<const StereoRig>> Find(const std::string& name) const override;

 private:
  explicit RigFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // The names of all files, for messages.
  std::string Names() const;

  const std::filesystem::path folder_;
};

}  // namespace vs
