#pragma once

#include <google/protobuf/message.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "engine/base/status.h"
#include "server/rpc/call.h"
#include "server/rpc/request_subject.h"
#include "server/rpc/stream_source.h"
#include "server/rpc/wire_message.h"

namespace vs {

// Where a handler runs. A call that finds its lane's queue full gets RESOURCE_EXHAUSTED.
enum class Lane {
  kInline,    // on the network's own thread: must not wait for anything, microseconds only
  kQuick,     // milliseconds: memory and small files
  kSlow,      // anything that waits for a camera or for blocks to start and stop
  kList,      // a page of what is stored on the disk
  kQuery,     // a client's own SQL, which takes as long as it pleases: one at a time of each login
  kPassword,  // password hashing: one at a time
};

// Each takes a core, which the sequences need more; with one only, a slow query held up all others.
inline constexpr int kQueriesAtOnce = 2;

struct MethodOptions {
  Lane lane = Lane::kQuick;
  size_t max_request_bytes = size_t{4} << 20;
  // Asked on the network's thread before the call is queued, to turn it away cheaply.
  std::function<Status(const Call&)> admit;
};

// One method of the API, ready to be called with bytes.
struct Method {
  std::string name;
  MethodOptions options;
  bool client_streaming = false;
  bool server_streaming = false;
  // One of the two. `answer` also serves each request of a client stream in turn.
  std::function<Result<WireMessage>(const Call&, std::string_view request)> answer;
  std::function<Result<std::unique_ptr<StreamSource>>(const Call&, std::string_view request)> open;
  // Of a unary method: see SubjectOf.
  std::function<std::optional<std::string>(std::string_view request)> subject;
};

// All methods of the API and what they do. Services add theirs while the server is put together;
// after that it is only read. A handler is an ordinary member function of protobuf messages: it
// knows neither network nor threads, and its errors reach the client as they are.
//
// A method that is not in the linked .proto files, or whose types differ from its declaration, is
// a bug and throws.
class Router {
 public:
  // Result<Response> Service::Handler(const Call&, const Request&)
  template <class Service, class Request, class Response>
  void Unary(const std::string& name, Service* service,
             Result<Response> (Service::*handler)(const Call&, const Request&),
             MethodOptions options = {}) {
    Method method{.name = name, .options = std::move(options)};
    method.answer = [service, handler](const Call& call,
                                       std::string_view bytes) -> Result<WireMessage> {
      Request request;
      VS_RETURN_IF_ERROR(Parse(bytes, request));
      Result<Response> response = (service->*handler)(call, request);
      if (!response) return response.error();
      return Serialize(*response);
    };
    method.subject = [](std::string_view bytes) -> std::optional<std::string> {
      Request request;
      return Parse(bytes, request).ok() ? SubjectOf(request) : "";
    };
    Add(std::move(method), *Request::descriptor(), Response::descriptor());
  }

  // Result<std::unique_ptr<StreamSource>> Service::Handler(const Call&, const Request&)
  // Also for a unary method whose answer is not there yet: the source's first message is the
  // answer.
  template <class Service, class Request>
  void Stream(const std::string& name, Service* service,
              Result<std::unique_ptr<StreamSource>> (Service::*handler)(const Call&,
                                                                        const Request&),
              MethodOptions options = {}) {
    Method method{.name = name, .options = std::move(options)};
    method.open = [service, handler](
                      const Call& call,
                      std::string_view bytes) -> Result<std::unique_ptr<StreamSource>> {
      Request request;
      VS_RETURN_IF_ERROR(Parse(bytes, request));
      return (service->*handler)(call, request);
    };
    Add(std::move(method), *Request::descriptor(), nullptr);
  }

  // Null when there is no such method.
  const Method* Find(const std::string& name) const;
  const std::map<std::string, Method>& methods() const { return methods_; }

 private:
  static Status Parse(std::string_view bytes, google::protobuf::Message& request);
  void Add(Method method, const google::protobuf::Descriptor& request,
           const google::protobuf::Descriptor* response);

  std::map<std::string, Method> methods_;
};

}  // namespace vs
