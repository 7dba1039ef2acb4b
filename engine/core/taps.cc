#include "engine/core/taps.h"

#include <string>

#include "engine/base/str.h"

namespace vs {

Taps::Taps(const Sequence& sequence, TopicHub& hub) {
  for (const Sequence::Node& node : sequence.nodes()) {
    for (const PortBase* output : node.block->outputs()) {
      topics_.push_back(hub.OpenTap(Str(sequence.spec().id, "/", node.id, ".", output->info().name),
                                    std::string(output->info().type)));
    }
  }
}

}  // namespace vs
