#include "engine/core/registry.h"

#include <utility>

#include "engine/base/check.h"

namespace vs {

BlockRegistry& BlockRegistry::Get() {
  static BlockRegistry registry;
  return registry;
}

bool BlockRegistry::Add(std::string type, BlockInfo info, Factory make) {
  Entry entry{type, std::move(info), std::move(make)};
  const bool added = entries_.emplace(std::move(type), std::move(entry)).second;
  VS_CHECK(added);
  return added;
}

const BlockRegistry::Entry* BlockRegistry::Find(const std::string& type) const {
  const auto found = entries_.find(type);
  return found == entries_.end() ? nullptr : &found->second;
}

std::vector<const BlockRegistry::Entry*> BlockRegistry::All() const {
  std::vector<const Entry*> all;
  all.reserve(entries_.size());
  for (const auto& [type, entry] : entries_) all.push_back(&entry);
  return all;
}

}  // namespace vs
