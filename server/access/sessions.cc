#include "server/access/sessions.h"

#include <algorithm>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs {

Result<std::unique_ptr<Sessions>> Sessions::Open(AccessDatabase& database, const Clock& clock,
                                                 const SessionLimits& limits) {
  std::unique_ptr<Sessions> sessions(new Sessions(database, clock, limits));
  VS_RETURN_IF_ERROR(sessions->Load());
  return sessions;
}

Sessions::~Sessions() {
  if (const Status stored = StoreLastUse(); !stored.ok()) {
    LogWarn("access", Str("the last use of sessions is not stored: ", stored.message()));
  }
}

Status Sessions::Load() {
  VS_ASSIGN_OR_RETURN(const std::vector<SessionRecord> stored, database_.Sessions());
  const int64_t now_ns = clock_.MonotonicNs();
  const int64_t now_utc_ns = clock_.UtcNs();
  std::vector<std::string> ended;
  {
    MutexLock lock(mutex_);
    for (const SessionRecord& record : stored) {
      // The wall clock may have been set meanwhile: never give more than a whole life.
      const int64_t left_ns = std::min(record.expires_utc_ns - now_utc_ns, limits_.lifetime_ns);
      const int64_t unused_ns = std::max(now_utc_ns - record.last_used_utc_ns, int64_t{0});
      const Entry entry{.record = record,
                        .expires_ns = now_ns + left_ns,
                        .last_used_ns = now_ns - unused_ns,
                        .stored_use_ns = now_ns - unused_ns};
      if (Alive(entry, now_ns)) {
        sessions_[record.token_hash] = entry;
      } else {
        ended.push_back(record.id);
      }
    }
  }
  return DeleteAll(ended);
}

bool Sessions::Alive(const Entry& entry, int64_t now_ns) const {
  return now_ns < entry.expires_ns && now_ns - entry.last_used_ns < limits_.idle_ns;
}

std::vector<std::string> Sessions::MakeRoomFor(const std::string& user) {
  const int64_t now_ns = clock_.MonotonicNs();
  std::vector<std::string> removed;
  std::erase_if(sessions_, [&](const auto& item) {
    if (Alive(item.second, now_ns)) return false;
    removed.push_back(item.second.record.id);
    return true;
  });
  const auto is_users = [&](const auto& item) { return item.second.record.user == user; };
  while (static_cast<size_t>(std::count_if(sessions_.begin(), sessions_.end(), is_users)) >=
         limits_.per_user) {
    auto longest_unused = sessions_.end();
    for (auto item = sessions_.begin(); item != sessions_.end(); ++item) {
      if (is_users(*item) && (longest_unused == sessions_.end() ||
                              item->second.last_used_ns < longest_unused->second.last_used_ns)) {
        longest_unused = item;
      }
    }
    removed.push_back(longest_unused->second.record.id);
    sessions_.erase(longest_unused);
  }
  return removed;
}

Result<Sessions::Created> Sessions::Create(const std::string& user, const std::string& address,
                                           const std::string& client) {
  Created created;
  created.token = MakeToken("vst_");
  created.record = {.id = MakeId(),
                    .token_hash = HashToken(created.token),
                    .user = user,
                    .address = address,
                    .client = client,
                    .created_utc_ns = clock_.UtcNs(),
                    .expires_utc_ns = clock_.UtcNs() + limits_.lifetime_ns,
                    .last_used_utc_ns = clock_.UtcNs()};
  std::vector<std::string> removed;
  bool full = false;
  {
    MutexLock lock(mutex_);
    removed = MakeRoomFor(user);
    full = sessions_.size() >= limits_.total;
  }
  VS_RETURN_IF_ERROR(DeleteAll(removed));
  if (full) {
    return ResourceExhausted(Str("the server has ", limits_.total,
                                 " login sessions, which is its limit; log out somewhere"));
  }
  VS_RETURN_IF_ERROR(database_.Save(created.record));
  MutexLock lock(mutex_);
  const int64_t now_ns = clock_.MonotonicNs();
  sessions_[created.record.token_hash] = {.record = created.record,
                                          .expires_ns = now_ns + limits_.lifetime_ns,
                                          .last_used_ns = now_ns,
                                          .stored_use_ns = now_ns};
  return created;
}

std::optional<SessionRecord> Sessions::Find(const TokenHash& token_hash) {
  MutexLock lock(mutex_);
  const auto found = sessions_.find(token_hash);
  if (found == sessions_.end()) return std::nullopt;
  const int64_t now_ns = clock_.MonotonicNs();
  if (!Alive(found->second, now_ns)) return std::nullopt;
  found->second.last_used_ns = now_ns;
  return found->second.record;
}

std::optional<SessionRecord> Sessions::FindById(const std::string& id, bool in_use) {
  MutexLock lock(mutex_);
  const int64_t now_ns = clock_.MonotonicNs();
  for (auto& [hash, entry] : sessions_) {
    if (entry.record.id != id) continue;
    if (!Alive(entry, now_ns)) return std::nullopt;
    if (in_use) entry.last_used_ns = now_ns;
    return entry.record;
  }
  return std::nullopt;
}

Status Sessions::Remove(const std::string& id, const std::string& user) {
  {
    MutexLock lock(mutex_);
    const size_t removed = std::erase_if(sessions_, [&](const auto& item) {
      const SessionRecord& record = item.second.record;
      return record.id == id && (user.empty() || record.user == user);
    });
    if (removed == 0) return NotFound(Str("there is no session ", id));
  }
  return DeleteAll({id});
}

Status Sessions::RemoveOf(const std::string& user, const std::string& except_id) {
  std::vector<std::string> removed;
  {
    MutexLock lock(mutex_);
    std::erase_if(sessions_, [&](const auto& item) {
      const SessionRecord& record = item.second.record;
      if (record.user != user || record.id == except_id) return false;
      removed.push_back(record.id);
      return true;
    });
  }
  return DeleteAll(removed);
}

Status Sessions::StoreLastUse() {
  std::vector<SessionRecord> used;
  {
    MutexLock lock(mutex_);
    const int64_t now_ns = clock_.MonotonicNs();
    const int64_t now_utc_ns = clock_.UtcNs();
    for (auto& [hash, entry] : sessions_) {
      if (entry.last_used_ns == entry.stored_use_ns) continue;
      entry.stored_use_ns = entry.last_used_ns;
      used.push_back(entry.record);
      used.back().last_used_utc_ns = now_utc_ns - (now_ns - entry.last_used_ns);
    }
  }
  return used.empty() ? Status() : database_.SaveLastUse(used);
}

std::vector<SessionInfo> Sessions::List(const std::string& user) const {
  std::vector<SessionInfo> list;
  {
    MutexLock lock(mutex_);
    const int64_t now_ns = clock_.MonotonicNs();
    for (const auto& [hash, entry] : sessions_) {
      if (!Alive(entry, now_ns) || (!user.empty() && entry.record.user != user)) continue;
      list.push_back({entry.record, clock_.UtcNs() - (now_ns - entry.last_used_ns)});
    }
  }
  std::sort(list.begin(), list.end(), [](const SessionInfo& a, const SessionInfo& b) {
    return a.record.created_utc_ns > b.record.created_utc_ns;
  });
  return list;
}

size_t Sessions::Count() const {
  MutexLock lock(mutex_);
  const int64_t now_ns = clock_.MonotonicNs();
  return std::count_if(sessions_.begin(), sessions_.end(),
                       [&](const auto& item) { return Alive(item.second, now_ns); });
}

Status Sessions::DeleteAll(const std::vector<std::string>& ids) {
  for (const std::string& id : ids) VS_RETURN_IF_ERROR(database_.DeleteSession(id));
  return Status();
}

}  // namespace vs
