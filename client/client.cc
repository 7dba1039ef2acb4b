#include "client/client.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "visionserver/v1/camera.grpc.pb.h"
#include "visionserver/v1/parameter.grpc.pb.h"
#include "visionserver/v1/result.grpc.pb.h"
#include "visionserver/v1/sequence.grpc.pb.h"
#include "visionserver/v1/session.grpc.pb.h"
#include "visionserver/v1/stream.grpc.pb.h"
#include "visionserver/v1/system.grpc.pb.h"

#include "client/call.h"

namespace vs::client {
namespace {

constexpr int kClockRounds = 5;

int64_t SteadyNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

template <class Request>
Request WithId(const std::string& id) {
  Request request;
  request.set_id(id);
  return request;
}

template <class Response>
Result<void> WithoutValue(const Result<Response>& result) {
  if (!result) return tl::unexpected(result.error());
  return {};
}

// The first of the values, which the server has to send.
template <class Response>
Result<v1::Value> OnlyValue(const Result<Response>& result) {
  if (!result) return tl::unexpected(result.error());
  if (result->values().empty()) return Failure(Code::kInternal, "the server sent no value");
  return result->values(0).value();
}

}  // namespace

Client::Client(std::shared_ptr<Connection> connection) : connection_(std::move(connection)) {}

Result<std::unique_ptr<Client>> Client::Connect(const ConnectOptions& options) {
  Result<std::shared_ptr<Connection>> connection = Connection::Open(options);
  if (!connection) return tl::unexpected(connection.error());
  return std::unique_ptr<Client>(new Client(std::move(*connection)));
}

Result<v1::LoginResponse> Client::Login(const std::string& user, const std::string& password) {
  v1::LoginRequest request;
  request.set_user(user);
  request.set_password(password);
  request.set_client(connection_->options().client_name);
  Result<v1::LoginResponse> login = Call(*connection_, &v1::SessionService::Stub::Login, request);
  if (login) connection_->SetCredential(login->token());
  return login;
}

Result<void> Client::Logout() {
  Result<void> done = WithoutValue(Call(*connection_, &v1::SessionService::Stub::Logout, {}));
  if (done) connection_->SetCredential({});
  return done;
}

Result<v1::WhoAmIResponse> Client::WhoAmI() {
  return Call(*connection_, &v1::SessionService::Stub::WhoAmI, {});
}

Result<void> Client::ChangePassword(const std::string& old_password,
                                    const std::string& new_password) {
  v1::ChangePasswordRequest request;
  request.set_old_password(old_password);
  request.set_new_password(new_password);
  return WithoutValue(Call(*connection_, &v1::SessionService::Stub::ChangePassword, request));
}

Result<v1::GetServerInfoResponse> Client::ServerInfo() {
  return Call(*connection_, &v1::SystemService::Stub::GetServerInfo, {});
}

Result<ServerClock> Client::ReadServerClock() {
  ServerClock clock{.offset_ns = 0, .uncertainty_ns = std::numeric_limits<int64_t>::max()};
  for (int round = 0; round < kClockRounds; ++round) {
    const int64_t asked_ns = SteadyNs();
    const Result<v1::GetServerInfoResponse> info = ServerInfo();
    if (!info) return tl::unexpected(info.error());
    const int64_t half_trip_ns = (SteadyNs() - asked_ns) / 2;
    if (half_trip_ns >= clock.uncertainty_ns) continue;
    clock = {.offset_ns = info->monotonic_ns() - (asked_ns + half_trip_ns),
             .uncertainty_ns = half_trip_ns};
  }
  return clock;
}

Result<v1::ListSequencesResponse> Client::ListSequences() {
  return Call(*connection_, &v1::SequenceService::Stub::ListSequences, {});
}

Result<v1::Sequence> Client::GetSequence(const std::string& id) {
  return Call(*connection_, &v1::SequenceService::Stub::GetSequence,
              WithId<v1::GetSequenceRequest>(id));
}

Result<v1::SequenceState> Client::StartSequence(const std::string& id) {
  return Call(*connection_, &v1::SequenceService::Stub::StartSequence,
              WithId<v1::StartSequenceRequest>(id));
}

Result<v1::SequenceState> Client::StopSequence(const std::string& id) {
  return Call(*connection_, &v1::SequenceService::Stub::StopSequence,
              WithId<v1::StopSequenceRequest>(id));
}

Result<v1::SequenceState> Client::GetSequenceState(const std::string& id) {
  return Call(*connection_, &v1::SequenceService::Stub::GetSequenceState,
              WithId<v1::GetSequenceStateRequest>(id));
}

Result<v1::ListParametersResponse> Client::ListParameters(const std::string& sequence) {
  v1::ListParametersRequest request;
  request.set_sequence(sequence);
  return Call(*connection_, &v1::ParameterService::Stub::ListParameters, request);
}

Result<v1::SetParametersResponse> Client::SetParameters(
    const std::string& sequence, const std::vector<ParameterSetting>& settings) {
  v1::SetParametersRequest request;
  request.set_sequence(sequence);
  for (const ParameterSetting& setting : settings) {
    v1::ParameterValue* value = request.add_values();
    value->set_path(setting.path);
    *value->mutable_value() = setting.value;
  }
  return Call(*connection_, &v1::ParameterService::Stub::SetParameters, request);
}

Result<v1::ListCamerasResponse> Client::ListCameras() {
  return Call(*connection_, &v1::CameraService::Stub::ListCameras, {});
}

Result<v1::ListFeaturesResponse> Client::ListFeatures(const std::string& camera) {
  return Call(*connection_, &v1::CameraService::Stub::ListFeatures,
              WithId<v1::ListFeaturesRequest>(camera));
}

Result<v1::Value> Client::GetFeature(const std::string& camera, const std::string& name) {
  auto request = WithId<v1::GetFeaturesRequest>(camera);
  request.add_names(name);
  return OnlyValue(Call(*connection_, &v1::CameraService::Stub::GetFeatures, request));
}

Result<v1::Value> Client::SetFeature(const std::string& camera, const std::string& name,
                                     const v1::Value& value) {
  auto request = WithId<v1::SetFeaturesRequest>(camera);
  v1::FeatureValue* feature = request.add_values();
  feature->set_name(name);
  *feature->mutable_value() = value;
  return OnlyValue(Call(*connection_, &v1::CameraService::Stub::SetFeatures, request));
}

Result<v1::ListStreamsResponse> Client::ListStreams() {
  return Call(*connection_, &v1::StreamService::Stub::ListStreams, {});
}

DepthStream Client::OpenDepth(const std::string& stream, const StreamOptions& options) {
  return DepthStream(OpenStream(stream, options));
}

LatestStream Client::OpenStream(const std::string& stream, const StreamOptions& options) {
  return {connection_, stream, options};
}

Result<v1::ListResultsResponse> Client::ListResults(const v1::ResultFilter& filter,
                                                    uint32_t count) {
  v1::ListResultsRequest request;
  *request.mutable_filter() = filter;
  request.set_page_size(count);
  return Call(*connection_, &v1::ResultService::Stub::ListResults, request);
}

Result<v1::QueryResultsResponse> Client::QueryResults(const std::string& sql,
                                                      const std::vector<v1::Value>& arguments) {
  v1::QueryResultsRequest request;
  request.set_sql(sql);
  for (const v1::Value& argument : arguments) *request.add_arguments() = argument;
  return Call(*connection_, &v1::ResultService::Stub::QueryResults, request);
}

ResultStream Client::WatchResults(const v1::ResultFilter& filter,
                                  std::optional<uint64_t> after_number) {
  return {connection_, filter, after_number};
}

}  // namespace vs::client
