#include "server/sequences/sequence_store.h"

#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"
#include "engine/core/normalize_parameters.h"
#include "server/storage/atomic_file.h"

namespace vs {

Result<std::unique_ptr<SequenceStore>> SequenceStore::Open(const std::filesystem::path& folder,
                                                           const Clock& clock) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::filesystem::directory_iterator files(folder, error);
  if (error) {
    return FailedPrecondition(
        Str("the folder of sequences ", folder.string(), " cannot be used: ", error.message()));
  }
  std::unique_ptr<SequenceStore> store(new SequenceStore(folder, clock));
  for (const auto& entry : files) {
    if (entry.path().extension() == ".json") store->Load(entry.path());
  }
  return store;
}

void SequenceStore::Load(const std::filesystem::path& file) {
  const auto read = [&file]() -> Result<StoredSequence> {
    VS_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, 2 * kMaxSequenceBytes));
    VS_ASSIGN_OR_RETURN(StoredSequence stored, ParseSequenceFile(text));
    if (!IsSequenceId(stored.spec.id) || stored.spec.id != file.stem()) {
      return InvalidArgument(Str("the sequence calls itself ", Quoted(stored.spec.id),
                                 ", which is not the name of its file"));
    }
    return stored;
  };
  Result<StoredSequence> stored = read();
  if (stored.has_value()) {
    MutexLock lock(mutex_);
    sequences_[stored->spec.id] = std::move(*stored);
    return;
  }
  const auto aside = PutAside(file);
  LogError("sequences", Str(file.string(), " is left out: ", stored.error().message(),
                            aside ? Str("; put aside as ", aside->string()) : ""));
}

std::vector<StoredSequence> SequenceStore::List() const {
  std::vector<StoredSequence> list;
  MutexLock lock(mutex_);
  for (const auto& [id, stored] : sequences_) list.push_back(stored);
  return list;
}

std::vector<std::string> SequenceStore::Ids() const {
  std::vector<std::string> ids;
  MutexLock lock(mutex_);
  for (const auto& [id, stored] : sequences_) ids.push_back(id);
  return ids;
}

Result<StoredSequence> SequenceStore::Get(const std::string& id) const {
  MutexLock lock(mutex_);
  VS_RETURN_IF_ERROR(FindLocked(id));
  return sequences_.at(id);
}

Status SequenceStore::Find(const std::string& id) const {
  MutexLock lock(mutex_);
  return FindLocked(id);
}

Status SequenceStore::FindLocked(const std::string& id) const {
  if (sequences_.contains(id)) return Status();
  std::string names;
  for (const auto& [name, stored] : sequences_) names += (names.empty() ? "" : ", ") + name;
  return NotFound(Str("there is no sequence ", Quoted(id),
                      "; stored are: ", names.empty() ? "none" : names.substr(0, 500)));
}

Result<StoredSequence> SequenceStore::GetIfUnchanged(const std::string& id,
                                                     const std::string& etag) const {
  VS_ASSIGN_OR_RETURN(StoredSequence stored, Get(id));
  if (etag.empty() || etag == stored.etag) return stored;
  return Aborted(Str("sequence ", id, " was changed by ",
                     stored.updated_by.empty() ? "somebody else" : stored.updated_by,
                     " (it is at revision ", stored.revision,
                     "): get it again and repeat the change"));
}

Result<StoredSequence> SequenceStore::Create(const SequenceSpec& spec, bool autostart,
                                             const std::string& user) {
  if (!IsSequenceId(spec.id)) {
    return InvalidArgument(
        Str("the id of a sequence is a-z, 0-9 and _, begins with a letter and has at most 63 "
            "characters; ",
            Quoted(spec.id), " is none"));
  }
  MutexLock writing(writing_);
  if (Get(spec.id).has_value()) {
    return AlreadyExists(Str("there is a sequence ", spec.id, " already: choose another id"));
  }
  StoredSequence stored;
  stored.spec = spec;
  stored.autostart = autostart;
  stored.created_ns = stored.updated_ns = clock_.UtcNs();
  stored.updated_by = user;
  VS_RETURN_IF_ERROR(Write(&stored));
  return stored;
}

Result<StoredSequence> SequenceStore::Update(const std::string& id, const std::string& etag,
                                             const std::string& user,
                                             const std::function<Status(StoredSequence*)>& change) {
  MutexLock writing(writing_);
  VS_ASSIGN_OR_RETURN(StoredSequence stored, GetIfUnchanged(id, etag));
  VS_RETURN_IF_ERROR(change(&stored));
  ++stored.revision;
  stored.updated_ns = clock_.UtcNs();
  stored.updated_by = user;
  VS_RETURN_IF_ERROR(Write(&stored));
  return stored;
}

Status SequenceStore::Delete(const std::string& id, const std::string& etag) {
  MutexLock writing(writing_);
  if (const auto stored = GetIfUnchanged(id, etag); !stored.has_value()) return stored.error();
  Status removed = RemoveFile(FileOf(id));
  // Gone already is as good.
  if (!removed.ok() && removed.code() != StatusCode::kNotFound) return removed;
  MutexLock lock(mutex_);
  sequences_.erase(id);
  return Status();
}

Status SequenceStore::Write(StoredSequence* stored) {
  NormalizeParameters(&stored->spec);
  stored->etag = EtagOf(*stored);
  const std::string text = FormatSequenceFile(*stored);
  if (text.size() > kMaxSequenceBytes) {
    return ResourceExhausted(Str("sequence ", stored->spec.id, " takes ", text.size(),
                                 " bytes, at most ", kMaxSequenceBytes, " are stored"));
  }
  VS_RETURN_IF_ERROR(WriteFileAtomically(FileOf(stored->spec.id), text));
  MutexLock lock(mutex_);
  sequences_[stored->spec.id] = *stored;
  return Status();
}

}  // namespace vs
