#pragma once

#include "visionserver/v1/audit.pb.h"

#include "engine/base/status.h"
#include "server/audit/audit_store.h"
#include "server/rpc/router.h"

namespace vs {

// Who changed what, for administrators: see audit.proto.
class AuditService {
 public:
  explicit AuditService(AuditStore& store) : store_(store) {}
  void Register(Router& router);

 private:
  Result<visionserver::v1::ListAuditEntriesResponse> ListAuditEntries(
      const Call& call, const visionserver::v1::ListAuditEntriesRequest& request);

  AuditStore& store_;
};

}  // namespace vs
