#include "server/services/parameter_source.h"

#include <utility>

#include "visionserver/v1/parameter.pb.h"

#include "server/convert/parameter.h"
#include "server/convert/value.h"

namespace vs {

namespace pb = visionserver::v1;

ParameterSource::ParameterSource(SequenceManager& manager, std::string sequence)
    : manager_(manager), sequence_(std::move(sequence)) {}

void ParameterSource::Start(std::function<void()> wake) {
  listening_ =
      manager_.parameters_changed().Add([state = state_.get(), sequence = sequence_,
                                         wake = std::move(wake)](const ParameterEvent& event) {
        if (event.sequence != sequence) return;
        {
          MutexLock lock(state->mutex);
          if (event.values.empty() || state->waiting.size() >= kMaxWaiting) {
            state->waiting.clear();
            state->tell_all = true;
          }
          if (!state->tell_all) state->waiting.push_back(event);
        }
        wake();
      });
}

StreamStep ParameterSource::Next() {
  ParameterEvent event;
  {
    MutexLock lock(state_->mutex);
    if (state_->tell_all) {
      state_->tell_all = false;
    } else if (state_->waiting.empty()) {
      return StreamStep::Wait();
    } else {
      event = std::move(state_->waiting.front());
      state_->waiting.pop_front();
    }
  }
  if (event.values.empty()) return TellAll();
  pb::ParameterChange change;
  for (const ParamAssignment& value : event.values) *change.add_values() = ToProto(value);
  change.set_etag(event.etag);
  change.set_applied_at_frame(event.applied_at_frame);
  change.set_user(event.user);
  return StreamStep::Message(Serialize(change));
}

StreamStep ParameterSource::TellAll() {
  const Result<ParameterSet> set = manager_.Parameters(sequence_);
  if (!set) return StreamStep::End(set.error());
  pb::ParameterChange change;
  for (const BlockParameter& parameter : set->parameters) {
    *change.add_values() =
        ToProto(ParamAssignment{parameter.block, parameter.info().name, parameter.value});
  }
  change.set_etag(set->etag);
  return StreamStep::Message(Serialize(change));
}

}  // namespace vs
