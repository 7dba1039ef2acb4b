#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/listeners.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "engine/core/environment.h"
#include "engine/core/scheduler.h"
#include "server/sequences/sequence_instance.h"
#include "server/sequences/sequence_parameters.h"
#include "server/sequences/sequence_store.h"

namespace vs {

// A change of parameters, as its watchers hear of it.
struct ParameterEvent {
  std::string sequence;
  std::vector<ParamAssignment> values;  // empty: look at all of them, if they are still there
  std::string etag;
  uint64_t applied_at_frame = 0;
  std::string user;
};

// The parameters of a sequence: in effect, when it runs; stored, when it does not.
struct ParameterSet {
  std::vector<BlockParameter> parameters;
  std::string etag;  // of the stored sequence
};

struct ParameterRequest {
  std::vector<ParamAssignment> values;
  std::string etag;  // empty: over whatever is there
  bool validate_only = false;
  bool operators_only = false;  // refuse what is not meant for operators
  std::string user;
};

struct ParameterAnswer {
  uint64_t applied_at_frame = 0;  // 0: does not run
  std::vector<ParamAssignment> values;
  std::string etag;
  uint64_t revision = 0;  // in which they are stored
};

// Runs the stored sequences of a server and keeps what is stored and what runs together.
// Thread-safe. Calls that start or stop wait for blocks; those of one sequence wait for each other.
class SequenceManager {
 public:
  // Everything must outlive it; `environment.clock` is set.
  SequenceManager(SequenceStore& store, Scheduler& scheduler, const Environment& environment);
  // Stops all.
  ~SequenceManager();

  // Starts the stored revision; does nothing when the sequence runs. INVALID_ARGUMENT with all
  // faults of the sequence, or the error of the block that could not start.
  Status Start(const std::string& id);
  Status Stop(const std::string& id);
  Status Delete(const std::string& id, const std::string& etag);
  // Those that are marked for it; an ERROR in the log for each that cannot start.
  void StartMarked();
  // From then on nothing starts any more.
  void StopAll();

  Result<SequenceStatus> Look(const std::string& id);
  // Of all stored sequences, by id.
  std::vector<SequenceStatus> List();
  // Null when it does not run.
  std::shared_ptr<Run> FindRun(const std::string& id);

  Result<ParameterSet> Parameters(const std::string& id);
  // All or nothing, between two frames, stored as a new revision. Errors as CheckAssignments;
  // ABORTED when `etag` is out of date; UNAVAILABLE while the sequence is just starting.
  Result<ParameterAnswer> SetParameters(const std::string& id, const ParameterRequest& request);
  // Back to the initial values of `paths`; empty for all that the caller may set. `values` of the
  // request do not matter.
  Result<ParameterAnswer> ResetParameters(const std::string& id,
                                          const std::vector<std::string>& paths,
                                          const ParameterRequest& request);
  // Tells watchers that a sequence was edited as a whole.
  void NoteEdited(const StoredSequence& stored);

  // The id of a sequence that was started, stopped or deleted.
  Listeners<std::string>& changed() { return changed_; }
  Listeners<ParameterEvent>& parameters_changed() { return parameters_changed_; }

 private:
  // NOT_FOUND when there is no such sequence, UNAVAILABLE while the server shuts down.
  Result<std::shared_ptr<SequenceInstance>> Instance(const std::string& id) VS_EXCLUDES(mutex_);
  std::vector<std::shared_ptr<SequenceInstance>> Instances() VS_EXCLUDES(mutex_);
  using Decide = std::function<Result<std::vector<ParamAssignment>>(
      const std::vector<BlockParameter>&, const std::vector<Connection>&, const ChangeRules&)>;
  Result<ParameterAnswer> ChangeParameters(const std::string& id, const ParameterRequest& request,
                                           const Decide& decide) VS_EXCLUDES(editing_);

  SequenceStore& store_;
  Scheduler& scheduler_;
  const Environment environment_;
  Listeners<std::string> changed_;
  Listeners<ParameterEvent> parameters_changed_;
  // Held while parameters change and while a start reads what it starts: so what runs is what is
  // stored.
  Mutex editing_;
  Mutex mutex_;
  bool closing_ VS_GUARDED_BY(mutex_) = false;
  std::map<std::string, std::shared_ptr<SequenceInstance>> instances_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
