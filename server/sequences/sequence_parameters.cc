#include "server/sequences/sequence_parameters.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "engine/base/str.h"
#include "engine/core/block.h"
#include "engine/core/check_sequence.h"
#include "engine/core/registry.h"

namespace vs {
namespace {

const BlockParameter* Find(const std::vector<BlockParameter>& parameters, const std::string& block,
                           const std::string& name) {
  const auto found = std::find_if(
      parameters.begin(), parameters.end(),
      [&](const BlockParameter& one) { return one.block == block && one.info().name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

// A block with the values in effect.
BlockSpec BlockNow(const std::vector<BlockParameter>& parameters, const std::string& id) {
  BlockSpec block{id, "", {}};
  for (const BlockParameter& one : parameters) {
    if (one.block != id) continue;
    block.type = one.type;
    block.params[one.info().name] = one.value;
  }
  return block;
}

// Collects what is wrong with each assignment. What cannot be set at all outweighs what this caller
// may not set, and that what cannot be set now.
class FaultList {
 public:
  void Add(StatusCode code, std::string subject, std::string message) {
    if (Weight(code) > Weight(code_)) code_ = code;
    faults_.push_back({std::move(subject), std::move(message)});
  }

  Status ToStatus() const {
    if (faults_.empty()) return Status();
    const Fault& first = faults_.front();
    const std::string more =
        faults_.size() == 1 ? "" : Str(" (and ", faults_.size() - 1, " more faults)");
    return Status(code_, Str("nothing was changed: ", first.subject, ": ", first.message, more),
                  faults_);
  }

 private:
  static int Weight(StatusCode code) {
    switch (code) {
      case StatusCode::kInvalidArgument:
        return 3;
      case StatusCode::kPermissionDenied:
        return 2;
      case StatusCode::kFailedPrecondition:
        return 1;
      default:
        return 0;
    }
  }

  StatusCode code_ = StatusCode::kOk;
  std::vector<Fault> faults_;
};

// Why the rules forbid to change this parameter, whatever to; OK when they do not.
Status Judge(const ParamInfo& info, const ChangeRules& rules) {
  if (rules.operators_only && !info.operator_editable) {
    return PermissionDenied("is not meant for operators: ask an engineer");
  }
  if (rules.running && !info.live) {
    return FailedPrecondition("cannot change while the sequence runs: stop it first");
  }
  return Status();
}

}  // namespace

std::vector<BlockParameter> ParametersOf(const SequenceSpec& spec) {
  std::vector<BlockParameter> parameters;
  for (const BlockSpec& block_spec : spec.blocks) {
    const auto* entry = BlockRegistry::Get().Find(block_spec.type);
    if (entry == nullptr) continue;
    const std::shared_ptr<const Block> block = entry->make();
    for (const ParamBase* param : block->params()) {
      const ParamInfo& info = param->info();
      const auto stored = block_spec.params.find(info.name);
      parameters.push_back(
          {block_spec.id,
           block_spec.type,
           {block, param},
           stored == block_spec.params.end() ? info.initial : param->AsHeld(stored->second)});
    }
  }
  return parameters;
}

std::vector<BlockParameter> ParametersOf(const std::shared_ptr<const Run>& run) {
  std::vector<BlockParameter> parameters;
  const Sequence& sequence = run->sequence();
  for (ParamAssignment& assignment : run->Parameters()) {
    const Sequence::Node& node = sequence.nodes()[sequence.FindNode(assignment.block)];
    const ParamBase* param = node.block->FindParam(assignment.param);
    parameters.push_back({node.id, node.type, {run, param}, std::move(assignment.value)});
  }
  return parameters;
}

Result<std::vector<ParamAssignment>> CheckAssignments(
    const std::vector<BlockParameter>& parameters, const std::vector<Connection>& connections,
    const std::vector<ParamAssignment>& assignments, const ChangeRules& rules) {
  std::vector<ParamAssignment> checked;
  std::set<std::pair<std::string, std::string>> seen;
  std::map<std::string, BlockSpec> changed;  // as they would be, with what does not fit too
  FaultList faults;
  for (const ParamAssignment& one : assignments) {
    const std::string path = one.block + "." + one.param;
    const BlockParameter* parameter = Find(parameters, one.block, one.param);
    if (parameter == nullptr) {
      faults.Add(StatusCode::kInvalidArgument, path, "the sequence has no such parameter");
      continue;
    }
    if (!seen.insert({one.block, one.param}).second) {
      faults.Add(StatusCode::kInvalidArgument, path, "is there twice");
      continue;
    }
    const auto [block, is_new] = changed.try_emplace(one.block);
    if (is_new) block->second = BlockNow(parameters, one.block);
    block->second.params[one.param] = one.value;
    if (const Status fits = parameter->param->Check(one.value); !fits.ok()) {
      faults.Add(StatusCode::kInvalidArgument, path, fits.message());
    } else if (const Status allowed = Judge(parameter->info(), rules); !allowed.ok()) {
      faults.Add(allowed.code(), path, allowed.message());
    } else {
      checked.push_back({one.block, one.param, parameter->param->AsHeld(one.value)});
    }
  }
  for (const auto& [id, block] : changed) {
    for (Fault& fault : CheckParamsTogether(block, connections)) {
      faults.Add(StatusCode::kInvalidArgument, std::move(fault.subject), std::move(fault.message));
    }
  }
  VS_RETURN_IF_ERROR(faults.ToStatus());
  return checked;
}

Result<std::vector<ParamAssignment>> InitialValues(const std::vector<BlockParameter>& parameters,
                                                   const std::vector<Connection>& connections,
                                                   const std::vector<std::string>& paths,
                                                   const ChangeRules& rules) {
  std::vector<ParamAssignment> initial;
  if (paths.empty()) {
    for (const BlockParameter& one : parameters) {
      if (Judge(one.info(), rules).ok())
        initial.push_back({one.block, one.info().name, one.info().initial});
    }
  }
  for (const std::string& path : paths) {
    VS_ASSIGN_OR_RETURN(ParamAssignment assignment, SplitPath(path));
    const BlockParameter* parameter = Find(parameters, assignment.block, assignment.param);
    // Unknown ones are left for CheckAssignments to name.
    if (parameter != nullptr) assignment.value = parameter->info().initial;
    initial.push_back(std::move(assignment));
  }
  return CheckAssignments(parameters, connections, initial, rules);
}

void Store(const std::vector<ParamAssignment>& checked,
           const std::vector<BlockParameter>& parameters, SequenceSpec* spec) {
  for (const ParamAssignment& one : checked) {
    const BlockParameter* parameter = Find(parameters, one.block, one.param);
    for (BlockSpec& block : spec->blocks) {
      if (block.id != one.block || block.type != parameter->type) continue;
      block.params[one.param] = one.value;
    }
  }
}

Result<ParamAssignment> SplitPath(const std::string& path) {
  const size_t dot = path.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == path.size()) {
    return InvalidArgument(Str("a parameter is named block.parameter, not ", Quoted(path)));
  }
  return ParamAssignment{path.substr(0, dot), path.substr(dot + 1), {}};
}

}  // namespace vs
