#include "server/services/health_service.h"

#include <optional>
#include <string>
#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

using grpc::health::v1::HealthCheckResponse;

HealthCheckResponse ToResponse(std::optional<bool> serving) {
  HealthCheckResponse response;
  if (!serving) {
    response.set_status(HealthCheckResponse::SERVICE_UNKNOWN);
  } else {
    response.set_status(*serving ? HealthCheckResponse::SERVING : HealthCheckResponse::NOT_SERVING);
  }
  return response;
}

class HealthSource final : public StreamSource {
 public:
  HealthSource(HealthBoard& board, std::string name) : board_(board), name_(std::move(name)) {}

  void Start(std::function<void()> wake) override { listening_ = board_.Listen(std::move(wake)); }

  StreamStep Next() override {
    const HealthCheckResponse now = ToResponse(board_.Get(name_));
    if (told_ == now.status()) return StreamStep::Wait();
    told_ = now.status();
    return StreamStep::Message(Serialize(now));
  }

 private:
  HealthBoard& board_;
  const std::string name_;
  std::shared_ptr<void> listening_;
  std::optional<HealthCheckResponse::ServingStatus> told_;
};

}  // namespace

void HealthService::Register(Router& router) {
  router.Unary("/grpc.health.v1.Health/Check", this, &HealthService::Check,
               {.lane = Lane::kInline, .max_request_bytes = 1024});
  router.Stream("/grpc.health.v1.Health/Watch", this, &HealthService::Watch,
                {.max_request_bytes = 1024});
}

Result<HealthService::Response> HealthService::Check(const Call& /*call*/, const Request& request) {
  const std::optional<bool> serving = board_.Get(request.service());
  if (!serving) return NotFound(Str("nothing is called \"", request.service(), "\" here"));
  return ToResponse(serving);
}

Result<std::unique_ptr<StreamSource>> HealthService::Watch(const Call& /*call*/,
                                                           const Request& request) {
  return std::make_unique<HealthSource>(board_, request.service());
}

}  // namespace vs
