#include "engine/core/check_sequence.h"

#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "engine/base/str.h"
#include "engine/core/block.h"
#include "engine/core/graph.h"

namespace vs {
namespace {

constexpr double kMaxBudgetMs = 60'000;
constexpr size_t kMaxDescriptionBytes = 4096;
constexpr size_t kMaxNames = 20;

std::string Listed(const std::vector<std::string>& names, std::string_view separator) {
  std::string text;
  for (size_t i = 0; i < names.size() && i < kMaxNames; ++i) {
    text += (i == 0 ? "" : std::string(separator)) + names[i];
  }
  if (names.size() > kMaxNames) text += Str(separator, "... (", names.size(), " in all)");
  return text;
}

template <class Described>
std::string NamesOf(const std::vector<Described*>& described) {
  std::vector<std::string> names;
  names.reserve(described.size());
  for (const Described* one : described) names.push_back(one->info().name);
  return names.empty() ? "none" : Listed(names, ", ");
}

class Checker {
 public:
  explicit Checker(const SequenceSpec& spec) : spec_(spec) {}

  std::vector<Fault> Check() {
    CheckHead();
    if (spec_.blocks.size() > kMaxBlocks || spec_.connections.size() > kMaxConnections) {
      return std::move(faults_);  // no use in naming thousands of others
    }
    for (size_t i = 0; i < spec_.blocks.size(); ++i) CheckBlock(i);
    for (size_t i = 0; i < spec_.connections.size(); ++i) CheckConnection(i);
    for (const Node& node : nodes_) CheckInputs(node);
    CheckCycles();
    return std::move(faults_);
  }

 private:
  struct Node {
    std::string id;
    const Block* type;  // null when unknown
    std::set<std::string> connected;
    std::vector<int> downstream;
  };

  void Add(std::string subject, std::string message) {
    faults_.push_back({std::move(subject), std::move(message)});
  }

  void CheckHead() {
    if (const Status status = CheckSequenceId(spec_.id); !status.ok()) {
      Add("sequence", "the id " + status.message());
    }
    if (spec_.description.size() > kMaxDescriptionBytes) {
      Add("sequence", Str("the description must have at most ", kMaxDescriptionBytes,
                          " bytes, not ", spec_.description.size()));
    }
    if (spec_.priority < -10 || spec_.priority > 10) {
      Add("sequence", Str("priority must be -10 to 10, not ", spec_.priority));
    }
    if (spec_.max_frames_in_flight < 1 || spec_.max_frames_in_flight > 16) {
      Add("sequence",
          Str("max_frames_in_flight must be 1 to 16, not ", spec_.max_frames_in_flight));
    }
    if (!(spec_.latency_budget_ms >= 0 && spec_.latency_budget_ms <= kMaxBudgetMs)) {
      Add("sequence",
          Str("latency_budget_ms must be 0 to ", kMaxBudgetMs, ", not ", spec_.latency_budget_ms));
    }
    if (spec_.blocks.empty()) Add("sequence", "has no source: add a camera or a file source");
    if (spec_.blocks.size() > kMaxBlocks) {
      Add("sequence", Str("may have at most ", kMaxBlocks, " blocks, not ", spec_.blocks.size()));
    }
    if (spec_.connections.size() > kMaxConnections) {
      Add("sequence", Str("may have at most ", kMaxConnections, " connections, not ",
                          spec_.connections.size()));
    }
  }

  // One block of each type is enough to know its ports and parameters.
  const Block* Describe(const std::string& type) {
    const auto [found, is_new] = described_.try_emplace(type);
    if (is_new) {
      const BlockRegistry::Entry* entry = BlockRegistry::Get().Find(type);
      if (entry != nullptr) found->second = entry->make();
    }
    return found->second.get();
  }

  void CheckBlock(size_t index) {
    const BlockSpec& block = spec_.blocks[index];
    const Status id_status = CheckSequenceId(block.id);
    const bool usable = id_status.ok();
    const std::string subject = usable ? block.id : Str("blocks[", index, "]");
    if (!usable) Add(subject, "a block's id " + id_status.message());
    const Block* type = Describe(block.type);
    if (type == nullptr) Add(subject, Str("there is no block type ", Quoted(block.type)));
    if (usable && !index_.emplace(block.id, nodes_.size()).second) {
      Add(subject, "there are several blocks of this id: rename one");
    } else if (usable) {
      nodes_.push_back({block.id, type, {}, {}});
    }
    if (!std::isfinite(block.x) || !std::isfinite(block.y)) {
      Add(subject, "its place in the editor must be finite numbers");
    }
    if (type != nullptr) CheckParams(subject, block, *type);
  }

  void CheckParams(const std::string& subject, const BlockSpec& block, const Block& type) {
    for (const auto& [name, value] : block.params) {
      const ParamBase* param = type.FindParam(name);
      if (param == nullptr) {
        Add(Str(subject, ".", IsSequenceId(name) ? name : Quoted(name)),
            Str("there is no such parameter; ", block.type, " has: ", NamesOf(type.params())));
      } else if (const Status status = param->Check(value); !status.ok()) {
        Add(Str(subject, ".", name), status.message());
      }
    }
    for (Fault& fault :
         CheckParamsTogether({subject, block.type, block.params}, spec_.connections)) {
      faults_.push_back(std::move(fault));
    }
  }

  Node* FindNode(const std::string& id) {
    const auto found = index_.find(id);
    return found == index_.end() ? nullptr : &nodes_[found->second];
  }

  void CheckConnection(size_t index) {
    const Connection& one = spec_.connections[index];
    Node* from = FindNode(one.from_block);
    Node* to = FindNode(one.to_block);
    if (from == nullptr || to == nullptr) {
      Add(from != nullptr ? one.from_block
          : to != nullptr ? one.to_block
                          : Str("connections[", index, "]"),
          Str("a connection goes from ", Quoted(one.from_block + "." + one.from_port), " to ",
              Quoted(one.to_block + "." + one.to_port), ", but there is no block ",
              Quoted(from == nullptr ? one.from_block : one.to_block)));
    }
    // The input counts as connected even so: one fault for one mistake.
    if (to != nullptr && !to->connected.insert(one.to_port).second) {
      Add(Str(one.to_block, ".", IsSequenceId(one.to_port) ? one.to_port : Quoted(one.to_port)),
          "is connected several times: an input has one source");
    }
    if (from == nullptr || to == nullptr) return;
    from->downstream.push_back(static_cast<int>(to - nodes_.data()));
    const PortBase* output = FindPort(*from, one.from_port, true);
    const PortBase* input = FindPort(*to, one.to_port, false);
    if (output != nullptr && input != nullptr &&
        !PortTypesFit(output->info().type, input->info().type)) {
      Add(Str(one.to_block, ".", one.to_port),
          Str("takes ", input->info().type, ", but ", one.from_block, ".", one.from_port, " gives ",
              output->info().type));
    }
  }

  const PortBase* FindPort(const Node& node, const std::string& name, bool output) {
    if (node.type == nullptr) return nullptr;  // said already
    const PortBase* port = output ? node.type->FindOutput(name) : node.type->FindInput(name);
    if (port == nullptr) {
      Add(Str(node.id, ".", IsSequenceId(name) ? name : Quoted(name)),
          Str("there is no such ", output ? "output" : "input", "; ", node.id,
              " has: ", NamesOf(output ? node.type->outputs() : node.type->inputs())));
    }
    return port;
  }

  void CheckInputs(const Node& node) {
    if (node.type == nullptr) return;
    std::vector<std::string> some;
    bool some_connected = false;
    for (const PortBase* input : node.type->inputs()) {
      const PortInfo& info = input->info();
      const bool connected = node.connected.count(info.name) != 0;
      if (info.need == Need::kRequired && !connected) {
        Add(Str(node.id, ".", info.name), Str("is not connected: it needs ", info.type));
      }
      if (info.need == Need::kSome) {
        some.push_back(info.name);
        some_connected = some_connected || connected;
      }
    }
    if (!some.empty() && !some_connected) {
      Add(node.id, Str("connect at least one of its inputs: ", Listed(some, ", ")));
    }
  }

  void CheckCycles() {
    Graph graph;
    graph.reserve(nodes_.size());
    for (Node& node : nodes_) graph.push_back(std::move(node.downstream));
    for (const std::vector<int>& cycle : FindCycles(graph)) {
      std::vector<std::string> ids;
      ids.reserve(cycle.size() + 1);
      for (const int node : cycle) ids.push_back(nodes_[node].id);
      ids.push_back(ids.front());
      Add(ids.front(), Str("feeds itself: ", Listed(ids, " -> "), ". Remove one connection"));
    }
  }

  const SequenceSpec& spec_;
  std::vector<Fault> faults_;
  std::map<std::string, std::unique_ptr<Block>> described_;
  std::vector<Node> nodes_;
  std::unordered_map<std::string, size_t> index_;
};

}  // namespace

std::vector<Fault> CheckSequence(const SequenceSpec& spec) { return Checker(spec).Check(); }

std::vector<Fault> CheckParamsTogether(const BlockSpec& spec,
                                       const std::vector<Connection>& connections) {
  const BlockRegistry::Entry* entry = BlockRegistry::Get().Find(spec.type);
  if (entry == nullptr) return {};
  const std::unique_ptr<Block> block = entry->make();
  for (const auto& [name, value] : spec.params) {
    ParamBase* param = block->FindParam(name);
    if (param == nullptr || !param->Set(value).ok()) return {};
  }
  for (const Connection& one : connections) {
    PortBase* input = one.to_block == spec.id ? block->FindInput(one.to_port) : nullptr;
    if (input != nullptr) input->Connect(input->info().type);
  }
  const Status status = block->CheckParams();
  if (status.ok()) return {};
  if (status.faults().empty()) return {{spec.id, status.message()}};
  std::vector<Fault> faults = status.faults();
  for (Fault& fault : faults) fault.subject = Str(spec.id, ".", fault.subject);
  return faults;
}

}  // namespace vs
