#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

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

// FNV-1a over all assignments in their order: two results with equal sequence revision and hash
// were computed with equal settings.
uint64_t HashParameters(const std::vector<ParamAssignment>& assignments);

// A checked, loaded sequence: its blocks exist, their order and wiring are fixed.
//
// Blocks are numbered in topological order (sources first; ties by id, so the order does not
// depend on the file). Every output port of every block has one slot number; a frame in flight
// holds one Value for each slot.
class Sequence {
 public:
  // A connected input.
  struct Input {
    PortBase* port;
    int slot;
    bool integer_to_number;
  };
  struct Node {
    std::string id;
    std::string type;
    std::unique_ptr<Block> block;
    std::vector<Input> inputs;    // those that are connected
    int first_output_slot = 0;    // outputs follow in the block's order
    std::vector<int> upstream;    // indices of the nodes that feed it, each once, ascending
    std::vector<int> downstream;  // indices of the nodes that it feeds, each once, ascending
    int distance_to_output = 0;   // longest way to a node without downstream, in nodes

    bool is_source() const { return upstream.empty(); }
  };

  // INVALID_ARGUMENT with all faults of CheckSequence.
  static Result<std::unique_ptr<Sequence>> Load(const SequenceSpec& spec, uint64_t revision);

  const SequenceSpec& spec() const { return spec_; }
  uint64_t revision() const { return revision_; }
  std::vector<Node>& nodes() { return nodes_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  int slot_count() const { return static_cast<int>(slot_readers_.size()); }
  // How many inputs each slot feeds.
  const std::vector<int>& slot_readers() const { return slot_readers_; }
  // -1 when there is no such block.
  int FindNode(const std::string& id) const;

  // All parameters with their loaded values, in topological and declaration order. While a
  // sequence runs, ask Run::Parameters().
  std::vector<ParamAssignment> Parameters() const;

 private:
  Sequence() = default;
  Status AddNode(const BlockSpec& spec);
  void Connect(const Connection& connection);

  SequenceSpec spec_;
  uint64_t revision_ = 0;
  std::vector<Node> nodes_;
  std::unordered_map<std::string, int> index_;  // of nodes_, by id
  std::vector<int> slot_readers_;
};

}  // namespace vs
