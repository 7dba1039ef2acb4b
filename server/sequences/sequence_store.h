#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/sequences/stored_sequence.h"

namespace vs {

// The stored sequences: one file ID.json for each, all of them in memory. A change is on the disk
// when the call returns, its parameters in one form (NormalizeParameters), and two people who
// change the same revision cannot both succeed. Thread-safe; changes wait for the disk, reading
// does not.
class SequenceStore {
 public:
  // Makes the folder if necessary. A file that cannot be understood is put aside (see PutAside)
  // with an ERROR in the log: never a default in its place.
  static Result<std::unique_ptr<SequenceStore>> Open(const std::filesystem::path& folder,
                                                     const Clock& clock);

  // By id.
  std::vector<StoredSequence> List() const VS_EXCLUDES(mutex_);
  // The ids alone, in their order.
  std::vector<std::string> Ids() const VS_EXCLUDES(mutex_);
  // NOT_FOUND names the sequences that there are.
  Status Find(const std::string& id) const VS_EXCLUDES(mutex_);
  // Errors as Find.
  Result<StoredSequence> Get(const std::string& id) const VS_EXCLUDES(mutex_);

  // ABORTED when the current revision is not the one of `etag` (empty: any).
  Result<StoredSequence> GetIfUnchanged(const std::string& id, const std::string& etag) const;

  // ALREADY_EXISTS; INVALID_ARGUMENT for an id that is none.
  Result<StoredSequence> Create(const SequenceSpec& spec, bool autostart, const std::string& user);
  // Stores what `change` makes of the current revision; `etag` as in GetIfUnchanged. An error of
  // `change` comes back, and nothing is stored.
  Result<StoredSequence> Update(const std::string& id, const std::string& etag,
                                const std::string& user,
                                const std::function<Status(StoredSequence*)>& change);
  Status Delete(const std::string& id, const std::string& etag);

 private:
  SequenceStore(std::filesystem::path folder, const Clock& clock)
      : folder_(std::move(folder)), clock_(clock) {}

  void Load(const std::filesystem::path& file);
  Status FindLocked(const std::string& id) const VS_REQUIRES(mutex_);
  Status Write(StoredSequence* stored) VS_EXCLUDES(mutex_);
  std::filesystem::path FileOf(const std::string& id) const { return folder_ / (id + ".json"); }

  const std::filesystem::path folder_;
  const Clock& clock_;
  Mutex writing_;  // held by whoever changes something, before mutex_
  mutable Mutex mutex_;
  std::map<std::string, StoredSequence> sequences_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
