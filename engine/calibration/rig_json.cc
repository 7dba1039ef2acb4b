#include "engine/calibration/rig_json.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/base/str.h"
#include "engine/calibration/validate_rig.h"

namespace vs {
namespace {

using nlohmann::json;

constexpr std::string_view kFormat = "visionserver.stereo_rig";
constexpr int kVersion = 1;

// The fields of a camera, in one place for reading and writing.
template <class Camera, class Visit>
void ForEachNumber(Camera& camera, Visit visit) {
  visit("fx_px", camera.fx_px);
  visit("fy_px", camera.fy_px);
  visit("cx_px", camera.cx_px);
  visit("cy_px", camera.cy_px);
  visit("k1", camera.k1);
  visit("k2", camera.k2);
  visit("p1", camera.p1);
  visit("p2", camera.p2);
  visit("k3", camera.k3);
}

json CameraToJson(const CameraModel& camera) {
  json object = {{"width", camera.width}, {"height", camera.height}};
  ForEachNumber(camera, [&](const char* key, double value) { object[key] = value; });
  return object;
}

// Reads fields out of a JSON object and collects what is wrong with them.
class Reader {
 public:
  // `object` may be of any type; `path` ("left.") begins the subject of each fault.
  Reader(const json& object, std::string path, std::vector<Fault>* faults)
      : object_(object), path_(std::move(path)), faults_(faults) {
    if (!object.is_object()) {
      Wrong(path_.empty() ? "file" : path_.substr(0, path_.size() - 1),
            Str("must be an object, is ", object.type_name()));
    }
  }
  ~Reader() {
    if (!object_.is_object()) return;
    for (const auto& [key, value] : object_.items()) {
      if (!known_.contains(key)) Wrong(path_ + key, "is unknown; remove or correct it");
    }
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  // Null, with a fault, when it is missing; null without when the whole object is none.
  const json* Find(const std::string& key) {
    known_.insert(key);
    if (!object_.is_object()) return nullptr;
    const auto found = object_.find(key);
    if (found != object_.end()) return &*found;
    Wrong(path_ + key, "is missing");
    return nullptr;
  }

  void Number(const std::string& key, double* out) {
    const json* value = Find(key);
    if (value != nullptr) ReadNumber(*value, path_ + key, out);
  }
  void Integer(const std::string& key, int* out) {
    const json* value = Find(key);
    if (value == nullptr) return;
    const bool fits = value->is_number_integer() && *value >= std::numeric_limits<int>::min() &&
                      *value <= std::numeric_limits<int>::max();
    if (!fits) return Wrong(path_ + key, Str("must be a whole number, is ", value->dump()));
    *out = value->get<int>();
  }
  void Text(const std::string& key, std::string* out) {
    const json* value = Find(key);
    if (value == nullptr) return;
    if (!value->is_string()) return Wrong(path_ + key, Str("must be text, is ", value->dump()));
    *out = value->get<std::string>();
  }
  template <size_t kCount>
  void Numbers(const std::string& key, std::array<double, kCount>* out) {
    const json* value = Find(key);
    if (value == nullptr) return;
    if (!value->is_array() || value->size() != kCount) {
      return Wrong(path_ + key, Str("must be a list of ", kCount, " numbers"));
    }
    for (size_t i = 0; i < kCount; ++i) {
      ReadNumber((*value)[i], Str(path_, key, "[", i, "]"), &(*out)[i]);
    }
  }
  void Wrong(std::string subject, std::string message) {
    faults_->push_back({std::move(subject), std::move(message)});
  }

 private:
  void ReadNumber(const json& value, const std::string& subject, double* out) {
    if (!value.is_number()) return Wrong(subject, Str("must be a number, is ", value.dump()));
    *out = value.get<double>();
  }

  const json& object_;
  std::string path_;
  std::vector<Fault>* faults_;
  std::set<std::string> known_;
};

void ReadCamera(const json* object, const std::string& path, std::vector<Fault>* faults,
                CameraModel* camera) {
  if (object == nullptr) return;
  Reader reader(*object, path, faults);
  reader.Integer("width", &camera->width);
  reader.Integer("height", &camera->height);
  ForEachNumber(*camera, [&](const char* key, double& value) { reader.Number(key, &value); });
}

// The keys that appear twice in one object; the parser itself would keep the last.
class DuplicateFinder {
 public:
  explicit DuplicateFinder(std::vector<Fault>* faults) : faults_(faults) {}

  void See(json::parse_event_t event, const json& value) {
    if (event == json::parse_event_t::object_start) {
      open_.emplace_back();
    } else if (event == json::parse_event_t::object_end) {
      open_.pop_back();
    } else if (event == json::parse_event_t::key) {
      const auto key = value.get<std::string>();
      if (!open_.back().insert(key).second) faults_->push_back({key, "is there twice"});
    }
  }

 private:
  std::vector<Fault>* faults_;
  std::vector<std::set<std::string>> open_;
};

// Depth that no rig file needs; a deeper text could exhaust the stack.
constexpr int kDeepest = 8;

Result<json> ParseJson(std::string_view text, std::vector<Fault>* faults) {
  DuplicateFinder duplicates(faults);
  try {
    return json::parse(text.begin(), text.end(),
                       [&](int depth, json::parse_event_t event, const json& value) {
                         if (depth > kDeepest) throw std::length_error("nested too deeply");
                         duplicates.See(event, value);
                         return true;
                       });
  } catch (const json::exception& error) {
    return InvalidArgument(Str("stereo rig file is no JSON: ", error.what()));
  } catch (const std::length_error& error) {
    return InvalidArgument(Str("stereo rig file: ", error.what()));
  }
}

// Adds what is wrong with the values that could be read.
void AddInvalidValues(const StereoRig& rig, std::vector<Fault>* faults) {
  const size_t unreadable = faults->size();
  const Status status = ValidateRig(rig);
  for (const Fault& fault : status.faults()) {
    const auto end = faults->begin() + static_cast<std::ptrdiff_t>(unreadable);
    const bool known = std::any_of(faults->begin(), end, [&](const Fault& other) {
      return other.subject.starts_with(fault.subject);
    });
    if (!known) faults->push_back(fault);
  }
}

}  // namespace

std::string FormatRig(const StereoRig& rig) {
  const json object = {{"format", kFormat},
                       {"version", kVersion},
                       {"name", rig.name},
                       {"left", CameraToJson(rig.left)},
                       {"right", CameraToJson(rig.right)},
                       {"right_from_left",
                        {{"rotation", rig.right_from_left_rotation},
                         {"translation_m", rig.right_from_left_translation_m}}}};
  return object.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

Result<StereoRig> ParseRig(std::string_view text) {
  if (text.size() > kLargestRigBytes) {
    return InvalidArgument(Str("stereo rig file: longer than ", kLargestRigBytes, " bytes"));
  }
  std::vector<Fault> faults;
  VS_ASSIGN_OR_RETURN(const json file, ParseJson(text, &faults));
  StereoRig rig;
  {
    Reader reader(file, "", &faults);
    std::string format(kFormat);
    reader.Text("format", &format);
    if (format != kFormat) reader.Wrong("format", Str("must be \"", kFormat, "\""));
    int version = kVersion;
    reader.Integer("version", &version);
    if (version != kVersion) {
      reader.Wrong("version", Str("is ", version, "; this program reads version ", kVersion));
    }
    reader.Text("name", &rig.name);
    ReadCamera(reader.Find("left"), "left.", &faults, &rig.left);
    ReadCamera(reader.Find("right"), "right.", &faults, &rig.right);
    if (const json* pose = reader.Find("right_from_left"); pose != nullptr) {
      Reader pose_reader(*pose, "right_from_left.", &faults);
      pose_reader.Numbers("rotation", &rig.right_from_left_rotation);
      pose_reader.Numbers("translation_m", &rig.right_from_left_translation_m);
    }
  }
  AddInvalidValues(rig, &faults);
  if (faults.empty()) return rig;
  const std::string message = Str("stereo rig file: ", faults.size(),
                                  faults.size() == 1 ? " field is wrong" : " fields are wrong");
  return Status(StatusCode::kInvalidArgument, message, std::move(faults));
}

}  // namespace vs
