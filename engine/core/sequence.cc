#include "engine/core/sequence.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/str.h"
#include "engine/core/check_sequence.h"
#include "engine/core/graph.h"

namespace vs {
namespace {

class Fnv1a {
 public:
  void Add(std::string_view bytes) {
    for (const char byte : bytes) Add(static_cast<uint8_t>(byte));
    Add(uint8_t{0});  // "a", "bc" is not "ab", "c"
  }
  void Add(uint8_t byte) { hash_ = (hash_ ^ byte) * 0x100000001b3; }
  uint64_t value() const { return hash_; }

 private:
  uint64_t hash_ = 0xcbf29ce484222325;
};

// Indices of the specification's blocks in topological order, sources first, ties by id.
std::vector<int> BlockOrder(const SequenceSpec& spec) {
  std::vector<bool> fed(spec.blocks.size(), false);
  std::map<std::string_view, int> index;
  for (size_t i = 0; i < spec.blocks.size(); ++i) index[spec.blocks[i].id] = static_cast<int>(i);
  for (const Connection& one : spec.connections) fed[index.at(one.to_block)] = true;

  std::vector<int> by_rank(spec.blocks.size());
  std::iota(by_rank.begin(), by_rank.end(), 0);
  std::sort(by_rank.begin(), by_rank.end(), [&](int a, int b) {
    return fed[a] != fed[b] ? fed[b] : spec.blocks[a].id < spec.blocks[b].id;
  });
  std::vector<int> rank(spec.blocks.size());
  for (size_t i = 0; i < by_rank.size(); ++i) rank[by_rank[i]] = static_cast<int>(i);

  Graph graph(spec.blocks.size());
  for (const Connection& one : spec.connections) {
    graph[rank[index.at(one.from_block)]].push_back(rank[index.at(one.to_block)]);
  }
  std::vector<int> order = TopologicalOrder(graph);
  for (int& node : order) node = by_rank[node];
  return order;
}

void SortUnique(std::vector<int>* numbers) {
  std::sort(numbers->begin(), numbers->end());
  numbers->erase(std::unique(numbers->begin(), numbers->end()), numbers->end());
}

}  // namespace

uint64_t HashParameters(const std::vector<ParamAssignment>& assignments) {
  Fnv1a hash;
  for (const ParamAssignment& one : assignments) {
    hash.Add(one.block);
    hash.Add(one.param);
    hash.Add(static_cast<uint8_t>(one.value.index()));
    hash.Add(ToString(one.value));
  }
  return hash.value();
}

Result<std::unique_ptr<Sequence>> Sequence::Load(const SequenceSpec& spec, uint64_t revision) {
  if (std::vector<Fault> faults = CheckSequence(spec); !faults.empty()) {
    const size_t count = faults.size();
    return Status(
        StatusCode::kInvalidArgument,
        Str("sequence ", Quoted(spec.id), " has ", count, count == 1 ? " fault" : " faults"),
        std::move(faults));
  }
  std::unique_ptr<Sequence> sequence(new Sequence);
  sequence->spec_ = spec;
  sequence->revision_ = revision;
  for (const int index : BlockOrder(spec)) {
    VS_RETURN_IF_ERROR(sequence->AddNode(spec.blocks[index]));
  }
  for (const Connection& one : spec.connections) sequence->Connect(one);
  for (size_t i = sequence->nodes_.size(); i-- > 0;) {
    Node& node = sequence->nodes_[i];
    SortUnique(&node.upstream);
    SortUnique(&node.downstream);
    for (const int to : node.downstream) {
      node.distance_to_output =
          std::max(node.distance_to_output, sequence->nodes_[to].distance_to_output + 1);
    }
  }
  return sequence;
}

Status Sequence::AddNode(const BlockSpec& spec) {
  Node node;
  node.id = spec.id;
  node.type = spec.type;
  node.block = BlockRegistry::Get().Find(spec.type)->make();
  node.first_output_slot = slot_count();
  slot_readers_.resize(slot_readers_.size() + node.block->outputs().size(), 0);
  for (const auto& [name, value] : spec.params) {
    VS_RETURN_IF_ERROR(node.block->FindParam(name)->Set(value).Annotated(spec.id));
  }
  index_[node.id] = static_cast<int>(nodes_.size());
  nodes_.push_back(std::move(node));
  return Status();
}

void Sequence::Connect(const Connection& connection) {
  const int from = FindNode(connection.from_block);
  const int to = FindNode(connection.to_block);
  const std::vector<PortBase*>& outputs = nodes_[from].block->outputs();
  PortBase* output = nodes_[from].block->FindOutput(connection.from_port);
  PortBase* input = nodes_[to].block->FindInput(connection.to_port);
  VS_CHECK(from < to && output != nullptr && input != nullptr);
  const auto place = std::find(outputs.begin(), outputs.end(), output) - outputs.begin();
  const int slot = nodes_[from].first_output_slot + static_cast<int>(place);
  input->Connect(output->info().type);
  ++slot_readers_[slot];
  nodes_[to].inputs.push_back({input, slot,
                               output->info().type == PortType<int64_t>::kName &&
                                   input->info().type == PortType<double>::kName});
  nodes_[to].upstream.push_back(from);
  nodes_[from].downstream.push_back(to);
}

int Sequence::FindNode(const std::string& id) const {
  const auto found = index_.find(id);
  return found == index_.end() ? -1 : found->second;
}

std::vector<ParamAssignment> Sequence::Parameters() const {
  std::vector<ParamAssignment> all;
  for (const Node& node : nodes_) {
    for (const ParamBase* param : node.block->params()) {
      all.push_back({node.id, param->info().name, param->Get()});
    }
  }
  return all;
}

}  // namespace vs
