#include "server/sequences/sequence_manager.h"

#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs {
namespace {

std::shared_ptr<Run> IfRunning(std::shared_ptr<Run> run) {
  if (run != nullptr && run->Stats().state != RunState::kRunning) run = nullptr;
  return run;
}

}  // namespace

SequenceManager::SequenceManager(SequenceStore& store, Scheduler& scheduler,
                                 const Environment& environment)
    : store_(store), scheduler_(scheduler), environment_(environment) {}

SequenceManager::~SequenceManager() { StopAll(); }

Status SequenceManager::Start(const std::string& id) {
  VS_ASSIGN_OR_RETURN(const std::shared_ptr<SequenceInstance> instance, Instance(id));
  Status started = instance->Start([&]() -> Result<StoredSequence> {
    MutexLock editing(editing_);
    return store_.Get(id);
  });
  changed_.Call(id);
  return started;
}

Status SequenceManager::Stop(const std::string& id) {
  VS_ASSIGN_OR_RETURN(const std::shared_ptr<SequenceInstance> instance, Instance(id));
  instance->Stop();
  changed_.Call(id);
  return Status();
}

Status SequenceManager::Delete(const std::string& id, const std::string& etag) {
  VS_ASSIGN_OR_RETURN(const std::shared_ptr<SequenceInstance> instance, Instance(id));
  VS_RETURN_IF_ERROR(instance->WhileStopped([&] { return store_.Delete(id, etag); }));
  {
    MutexLock lock(mutex_);
    instances_.erase(id);
  }
  changed_.Call(id);
  parameters_changed_.Call({.sequence = id});
  return Status();
}

void SequenceManager::StartMarked() {
  for (const StoredSequence& stored : store_.List()) {
    if (!stored.autostart) continue;
    const Status started = Start(stored.spec.id);
    if (!started.ok()) {
      LogError("sequences",
               Str("sequence ", stored.spec.id, " cannot start: ", started.ToString()));
    }
  }
}

void SequenceManager::StopAll() {
  {
    MutexLock lock(mutex_);
    closing_ = true;
  }
  for (const auto& instance : Instances()) instance->Stop();
}

Result<SequenceStatus> SequenceManager::Look(const std::string& id) {
  VS_ASSIGN_OR_RETURN(const std::shared_ptr<SequenceInstance> instance, Instance(id));
  return instance->Snapshot();
}

std::vector<SequenceStatus> SequenceManager::List() {
  std::vector<SequenceStatus> list;
  for (const std::string& id : store_.Ids()) {
    if (auto status = Look(id)) list.push_back(std::move(*status));
  }
  return list;
}

std::shared_ptr<Run> SequenceManager::FindRun(const std::string& id) {
  const auto instance = Instance(id);
  return instance.has_value() ? IfRunning((*instance)->run()) : nullptr;
}

Result<ParameterSet> SequenceManager::Parameters(const std::string& id) {
  VS_ASSIGN_OR_RETURN(const StoredSequence stored, store_.Get(id));
  const std::shared_ptr<Run> run = FindRun(id);
  return ParameterSet{run != nullptr ? ParametersOf(run) : ParametersOf(stored.spec), stored.etag};
}

Result<ParameterAnswer> SequenceManager::SetParameters(const std::string& id,
                                                       const ParameterRequest& request) {
  return ChangeParameters(
      id, request, [&](const auto& parameters, const auto& connections, const ChangeRules& rules) {
        return CheckAssignments(parameters, connections, request.values, rules);
      });
}

Result<ParameterAnswer> SequenceManager::ResetParameters(const std::string& id,
                                                         const std::vector<std::string>& paths,
                                                         const ParameterRequest& request) {
  return ChangeParameters(
      id, request, [&](const auto& parameters, const auto& connections, const ChangeRules& rules) {
        return InitialValues(parameters, connections, paths, rules);
      });
}

Result<ParameterAnswer> SequenceManager::ChangeParameters(const std::string& id,
                                                          const ParameterRequest& request,
                                                          const Decide& decide) {
  MutexLock editing(editing_);
  VS_ASSIGN_OR_RETURN(const SequenceStatus status, Look(id));
  if (status.activity == Activity::kStarting) {
    return Unavailable(Str("sequence ", id, " is just being started: try again in a moment"));
  }
  const std::shared_ptr<Run> run = FindRun(id);
  ParameterAnswer answer;
  const auto change = [&](StoredSequence* stored) -> Status {
    const auto parameters = run != nullptr ? ParametersOf(run) : ParametersOf(stored->spec);
    const SequenceSpec& spec = run != nullptr ? run->sequence().spec() : stored->spec;
    VS_ASSIGN_OR_RETURN(answer.values, decide(parameters, spec.connections,
                                              {.operators_only = request.operators_only,
                                               .running = run != nullptr}));
    Store(answer.values, parameters, &stored->spec);
    return Status();
  };
  if (request.validate_only) {
    VS_ASSIGN_OR_RETURN(StoredSequence copy, store_.GetIfUnchanged(id, request.etag));
    VS_RETURN_IF_ERROR(change(&copy));
    answer.etag = copy.etag;
    answer.revision = copy.revision;
    return answer;
  }
  VS_ASSIGN_OR_RETURN(const StoredSequence stored,
                      store_.Update(id, request.etag, request.user, change));
  answer.etag = stored.etag;
  answer.revision = stored.revision;
  if (run != nullptr) {
    // Checked already: it fails only when the run has ended meanwhile.
    answer.applied_at_frame = run->SetParameters(answer.values).value_or(0);
  }
  parameters_changed_.Call({id, answer.values, answer.etag, answer.applied_at_frame, request.user});
  return answer;
}

void SequenceManager::NoteEdited(const StoredSequence& stored) {
  parameters_changed_.Call({stored.spec.id, {}, stored.etag, 0, stored.updated_by});
}

Result<std::shared_ptr<SequenceInstance>> SequenceManager::Instance(const std::string& id) {
  VS_RETURN_IF_ERROR(store_.Find(id));
  MutexLock lock(mutex_);
  if (closing_) return Unavailable("the server is shutting down");
  std::shared_ptr<SequenceInstance>& instance = instances_[id];
  if (instance == nullptr) {
    instance = std::make_shared<SequenceInstance>(id, scheduler_, environment_);
  }
  return instance;
}

std::vector<std::shared_ptr<SequenceInstance>> SequenceManager::Instances() {
  MutexLock lock(mutex_);
  std::vector<std::shared_ptr<SequenceInstance>> instances;
  for (const auto& [id, instance] : instances_) instances.push_back(instance);
  return instances;
}

}  // namespace vs
