#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/status.h"
#include "engine/sim/picture_source.h"

namespace vs::sim {

// The files of `folder` whose names match `pattern` (shell wildcards), sorted by name.
std::vector<std::string> ListPictures(const std::string& folder, const std::string& pattern);

// A camera that shows pictures from files, one after the other and over and over. At nominal
// settings and without noise its pixels are those of the files, as 8-bit grey.
class FolderCamera final : public PictureSource {
 public:
  // Reads all files. Errors name the file that cannot be read or differs in size from the first.
  // Which picture is shown depends on the instant alone, a new one every `period_ns`, so that two
  // cameras show the pictures of one pair at one instant.
  static Result<std::unique_ptr<FolderCamera>> Load(const std::vector<std::string>& files,
                                                    int64_t period_ns, const SensorNoise& noise);

 protected:
  void Look(int64_t instant_ns) override;
  const Light* LightRows(int y, int count) override;

 private:
  FolderCamera(int width, int height, int64_t period_ns, const SensorNoise& noise);

  int64_t period_ns_;
  std::vector<std::vector<uint8_t>> pictures_;  // width x height each
  size_t shown_ = 0;
  std::vector<Light> rows_;
};

}  // namespace vs::sim
