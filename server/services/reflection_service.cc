#include "server/services/reflection_service.h"

#include <google/protobuf/descriptor.h>

#include <set>
#include <string>

#include <google/protobuf/descriptor.pb.h>

#include "engine/base/str.h"

namespace vs {
namespace {

using google::protobuf::DescriptorPool;
using google::protobuf::FileDescriptor;
using grpc::reflection::v1alpha::FileDescriptorResponse;
using grpc::reflection::v1alpha::ServerReflectionResponse;

void AddWithImports(const FileDescriptor& file, std::set<const FileDescriptor*>& added,
                    FileDescriptorResponse& response) {
  if (!added.insert(&file).second) return;
  google::protobuf::FileDescriptorProto proto;
  file.CopyTo(&proto);
  response.add_file_descriptor_proto(proto.SerializeAsString());
  for (int i = 0; i < file.dependency_count(); ++i) {
    AddWithImports(*file.dependency(i), added, response);
  }
}

void SetError(StatusCode code, const std::string& message, ServerReflectionResponse& response) {
  response.mutable_error_response()->set_error_code(static_cast<int>(code));
  response.mutable_error_response()->set_error_message(message);
}

void SetFile(const FileDescriptor* file, const std::string& name,
             ServerReflectionResponse& response) {
  if (file == nullptr) {
    SetError(StatusCode::kNotFound, Str("there is no ", name), response);
    return;
  }
  std::set<const FileDescriptor*> added;
  AddWithImports(*file, added, *response.mutable_file_descriptor_response());
}

}  // namespace

void ReflectionService::Register(Router& router) {
  router_ = &router;
  router.Unary("/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", this,
               &ReflectionService::Info, {.max_request_bytes = 4096});
}

Result<ReflectionService::Response> ReflectionService::Info(const Call& /*call*/,
                                                            const Request& request) {
  const DescriptorPool& pool = *DescriptorPool::generated_pool();
  Response response;
  response.set_valid_host(request.host());
  *response.mutable_original_request() = request;
  switch (request.message_request_case()) {
    case Request::kListServices: {
      std::set<std::string> names;
      for (const auto& [method, entry] : router_->methods()) {
        names.insert(method.substr(1, method.find('/', 1) - 1));
      }
      for (const std::string& name : names) {
        response.mutable_list_services_response()->add_service()->set_name(name);
      }
      break;
    }
    case Request::kFileByFilename:
      SetFile(pool.FindFileByName(request.file_by_filename()), request.file_by_filename(),
              response);
      break;
    case Request::kFileContainingSymbol:
      SetFile(pool.FindFileContainingSymbol(request.file_containing_symbol()),
              request.file_containing_symbol(), response);
      break;
    default:
      SetError(StatusCode::kNotFound, "this interface has no extensions", response);
  }
  return response;
}

}  // namespace vs
