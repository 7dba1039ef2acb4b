#include "engine/camera/feature_memory.h"

#include <algorithm>

namespace vs {
namespace {

bool IsSelector(const std::string& name) { return name.ends_with("Selector"); }

}  // namespace

void FeatureMemory::Remember(const std::string& name, const FeatureValue& value) {
  if (IsSelector(name)) {
    selectors_[name] = value;
    return;
  }
  std::erase_if(entries_, [&](const Entry& entry) {
    return entry.setting.name == name && entry.selectors == selectors_;
  });
  entries_.push_back({selectors_, {name, value}});
}

std::vector<FeatureMemory::Setting> FeatureMemory::Replay() const {
  std::vector<Setting> settings;
  Selectors now;
  const auto select = [&](const Selectors& wanted) {
    for (const auto& [name, value] : wanted) {
      const auto found = now.find(name);
      if (found != now.end() && found->second == value) continue;
      settings.push_back({name, value});
      now[name] = value;
    }
  };
  for (const Entry& entry : entries_) {
    select(entry.selectors);
    settings.push_back(entry.setting);
  }
  select(selectors_);
  return settings;
}

}  // namespace vs
