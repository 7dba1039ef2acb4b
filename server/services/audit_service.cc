#include "server/services/audit_service.h"

#include <string>
#include <utility>

#include "engine/base/str.h"
#include "server/convert/time.h"
#include "server/services/page_token.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

constexpr uint32_t kDefaultPage = 100;
constexpr uint32_t kMaxPage = 1000;

pb::AuditEntry ToProto(const AuditEntry& entry) {
  pb::AuditEntry proto;
  proto.set_number(entry.number);
  *proto.mutable_time() = ToTimestamp(entry.time_utc_ns);
  proto.set_user(entry.user);
  proto.set_address(entry.address);
  proto.set_method(entry.method);
  proto.set_subject(entry.subject);
  proto.set_ok(entry.ok);
  proto.set_message(entry.message);
  return proto;
}

}  // namespace

void AuditService::Register(Router& router) {
  router.Unary("/visionserver.v1.AuditService/ListAuditEntries", this,
               &AuditService::ListAuditEntries, {.lane = Lane::kList});
}

Result<pb::ListAuditEntriesResponse> AuditService::ListAuditEntries(
    const Call& /*call*/, const pb::ListAuditEntriesRequest& request) {
  AuditFilter filter{.user = request.user(), .method = request.method()};
  if (request.has_from()) filter.from_ns = ToUtcNs(request.from());
  if (request.has_until()) filter.until_ns = ToUtcNs(request.until());
  VS_ASSIGN_OR_RETURN(const auto before, ParsePageToken(request.page_token()));
  const uint32_t size = request.page_size() == 0 ? kDefaultPage : request.page_size();
  if (size > kMaxPage) {
    return InvalidArgument(Str("page_size must be 1 to ", kMaxPage, ", or 0 for ", kDefaultPage,
                               ", not ", request.page_size()));
  }
  VS_ASSIGN_OR_RETURN(const AuditStore::Page page, store_.List(filter, before, size));
  pb::ListAuditEntriesResponse response;
  for (const AuditEntry& entry : page.entries) *response.add_entries() = ToProto(entry);
  if (page.more) response.set_next_page_token(std::to_string(page.entries.back().number));
  return response;
}

}  // namespace vs
