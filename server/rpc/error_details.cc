#include "server/rpc/error_details.h"

#include "visionserver/v1/error.pb.h"

#include "engine/base/str.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

constexpr size_t kMaxMessageBytes = 1024;
// Of the details before base64 makes them a third longer.
constexpr size_t kMaxDetailsBytes = 4096;

}  // namespace

std::string CutTo(const std::string& text, size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  size_t end = max_bytes - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // UTF-8
  return text.substr(0, end) + "...";
}

WireError ToWireError(const Status& status) {
  WireError error;
  error.message = CutTo(status.message(), kMaxMessageBytes);

  pb::ErrorDetail detail;
  detail.set_domain("vs");
  detail.set_reason(std::string(status.reason()));
  size_t left_out = 0;
  for (const Fault& fault : status.faults()) {
    if (left_out == 0) {
      pb::Fault* added = detail.add_faults();
      added->set_subject(CutTo(fault.subject, kMaxMessageBytes / 4));
      added->set_message(CutTo(fault.message, kMaxMessageBytes));
      if (detail.ByteSizeLong() + error.message.size() <= kMaxDetailsBytes) continue;
      detail.mutable_faults()->RemoveLast();
    }
    ++left_out;
  }
  if (left_out > 0) {
    detail.add_faults()->set_message(Str(left_out, " more; correct these first"));
  }

  pb::ErrorStatus whole;
  whole.set_code(static_cast<int>(status.code()));
  whole.set_message(error.message);
  whole.add_details()->PackFrom(detail);
  error.details = whole.SerializeAsString();
  return error;
}

}  // namespace vs
