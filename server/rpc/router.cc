#include "server/rpc/router.h"

#include <google/protobuf/descriptor.h>

#include <limits>

#include "engine/base/check.h"
#include "engine/base/str.h"

namespace vs {

const Method* Router::Find(const std::string& name) const {
  const auto found = methods_.find(name);
  return found == methods_.end() ? nullptr : &found->second;
}

Status Router::Parse(std::string_view bytes, google::protobuf::Message& request) {
  if (bytes.size() <= std::numeric_limits<int>::max() &&
      request.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return Status();
  }
  return InvalidArgument(Str("the ", bytes.size(), " bytes of the request are not a valid ",
                             request.GetDescriptor()->full_name(),
                             "; is the client built from the same .proto files?"));
}

void Router::Add(Method method, const google::protobuf::Descriptor& request,
                 const google::protobuf::Descriptor* response) {
  // "/package.Service/Method" is "package.Service.Method" to protobuf.
  VS_CHECK(method.name.starts_with('/'));
  std::string full_name = method.name.substr(1);
  const size_t slash = full_name.find('/');
  VS_CHECK(slash != std::string::npos);
  full_name[slash] = '.';
  const auto* declared =
      google::protobuf::DescriptorPool::generated_pool()->FindMethodByName(full_name);
  VS_CHECK(declared != nullptr);
  VS_CHECK(declared->input_type() == &request);
  VS_CHECK(response == nullptr || declared->output_type() == response);
  method.client_streaming = declared->client_streaming();
  method.server_streaming = declared->server_streaming();
  const bool added = methods_.try_emplace(method.name, std::move(method)).second;
  VS_CHECK(added);
}

}  // namespace vs
