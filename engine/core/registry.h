#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/status.h"

namespace vs {

class Block;

struct BlockInfo {
  std::string category;  // "Stereo", "Acquire" ...: the palette's group
  std::string doc;       // a full sentence for the user
};

// All block types, by name. Filled while the program starts, read-only afterwards.
class BlockRegistry {
 public:
  using Factory = std::function<std::unique_ptr<Block>()>;

  struct Entry {
    std::string type;
    BlockInfo info;
    Factory make;
  };

  static BlockRegistry& Get();
  // True. Two types of one name are a bug of ours, found as soon as the program starts.
  bool Add(std::string type, BlockInfo info, Factory make);
  // Null when there is no such type.
  const Entry* Find(const std::string& type) const;
  // Sorted by type.
  std::vector<const Entry*> All() const;

 private:
  std::map<std::string, Entry> entries_;
};

// The last line of a block's file. The class name is the type name in sequences.
#define VS_REGISTER_BLOCK(Class, ...)                                                       \
  [[maybe_unused]] static const bool k##Class##Registered = ::vs::BlockRegistry::Get().Add( \
      #Class, ::vs::BlockInfo __VA_ARGS__, [] { return std::make_unique<Class>(); })

}  // namespace vs
