#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "engine/core/block.h"
#include "engine/core/sequence_spec.h"

namespace vs {

// One parameter assignment, or the value in effect.
struct ParamAssignment {
  std::string block;
  std::string param;
  ParamValue value;

  bool operator==(const ParamAssignment&) const = default;
};

// A checked, loaded sequence: its blocks exist, their order and wiring are fixed.
//
// Blocks are numbered in topological order (sources first; ties by id, so the order does not
// depend on the file). Every output port of every block has one slot number; a frame in flight
// holds one Value for each slot.
class Sequence {
 public:
  struct Input {
    PortBase* port;
    int slot;  // -1: not connected
  };
  struct Node {
    std::string id;
    std::string type;
    std::unique_ptr<Block> block;
    std::vector<Input> inputs;
    int first_output_slot;      // outputs follow in the block's order
    std::vector<int> upstream;  // indices of the nodes that feed it, each once
    std::vector<int> downstream;
    int distance_to_output;  // longest way to a node without downstream, in nodes
    bool is_source;          // no required input
  };

  // All faults of CheckSequence as one INVALID_ARGUMENT.
  static Result<std::unique_ptr<Sequence>> Load(const SequenceSpec& spec, uint64_t revision);

  const SequenceSpec& spec() const { return spec_; }
  uint64_t revision() const { return revision_; }
  std::vector<Node>& nodes() { return nodes_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  int slot_count() const { return slot_count_; }
  // -1 when there is no such block.
  int FindNode(const std::string& id) const;

  // FNV-1a over all parameter values in effect, in block and parameter order: two results with
  // equal revision and hash were computed with equal settings.
  uint64_t ParameterHash() const;

 private:
  Sequence() = default;

  SequenceSpec spec_;
  uint64_t revision_ = 0;
  std::vector<Node> nodes_;
  int slot_count_ = 0;
};

}  // namespace vs
