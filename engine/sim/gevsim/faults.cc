#include "engine/sim/gevsim/faults.h"

#include <map>
#include <sstream>
#include <string>

#include "engine/base/str.h"
#include "engine/sim/hash.h"

namespace vs::sim {
namespace {

// Reads the words of one command.
class Words {
 public:
  explicit Words(std::string_view text) : stream_(std::string(text)) {}

  template <class T>
  bool Next(T* value) {
    return static_cast<bool>(stream_ >> *value);
  }
  bool AtEnd() { return (stream_ >> std::ws).eof(); }

 private:
  std::istringstream stream_;
};

bool ReadProbability(Words& words, double* probability) {
  return words.Next(probability) && *probability >= 0 && *probability <= 1 && words.AtEnd();
}

Status Expected(std::string_view what, std::string_view command) {
  return InvalidArgument(Str("expected '", what, "', found '", command, "'"));
}

}  // namespace

FaultSettings Faults::Get() const {
  MutexLock lock(mutex_);
  return settings_;
}

Status Faults::Apply(std::string_view command, int64_t now_ns) {
  Words words(command);
  std::string name;
  words.Next(&name);
  MutexLock lock(mutex_);
  FaultSettings wanted = settings_;
  const std::map<std::string, double*> probabilities = {{"drop", &wanted.drop_packets},
                                                        {"duplicate", &wanted.duplicate_packets},
                                                        {"reorder", &wanted.reorder_packets},
                                                        {"drop-frames", &wanted.drop_frames}};
  if (const auto found = probabilities.find(name); found != probabilities.end()) {
    if (!ReadProbability(words, found->second)) {
      return Expected(Str(name, " PROBABILITY (0 to 1)"), command);
    }
  } else if (name == "payload-type") {
    if (!words.Next(&wanted.wrong_type) || !words.Next(&wanted.wrong_type_every) ||
        wanted.wrong_type < 0 || wanted.wrong_type > 0xffff || wanted.wrong_type_every < 0) {
      return Expected("payload-type TYPE EVERY", command);
    }
  } else if (name == "freeze") {
    double seconds = 0;
    if (!words.Next(&seconds) || seconds < 0 || seconds > 1e6) {
      return Expected("freeze SECONDS", command);
    }
    wanted.frozen_until_ns = now_ns + static_cast<int64_t>(seconds * 1e9);
  } else if (name == "unplug" || name == "plug") {
    wanted.unplugged = name == "unplug";
  } else if (name == "black") {
    std::string state;
    if (!words.Next(&state) || (state != "on" && state != "off")) {
      return Expected("black on|off", command);
    }
    wanted.black = state == "on";
  } else if (name == "slow-answer") {
    if (!words.Next(&wanted.slow_answer_ms) || wanted.slow_answer_ms < 0) {
      return Expected("slow-answer MILLISECONDS", command);
    }
  } else if (name == "clear") {
    wanted = {};
  } else {
    return InvalidArgument(
        Str("unknown fault '", name,
            "'; there are drop, duplicate, reorder, drop-frames, payload-type, freeze, unplug, "
            "plug, black, slow-answer and clear"));
  }
  if (!words.AtEnd()) return InvalidArgument(Str("too many words in '", command, "'"));
  settings_ = wanted;
  return {};
}

bool Faults::Happens(double probability) {
  if (probability <= 0) return false;
  constexpr double kTwoTo53 = 9007199254740992.0;
  return static_cast<double>(Hash(draws_++) >> 11) < probability * kTwoTo53;
}

}  // namespace vs::sim
