#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "visionserver/v1/camera.pb.h"
#include "visionserver/v1/parameter.pb.h"
#include "visionserver/v1/result.pb.h"
#include "visionserver/v1/sequence.pb.h"
#include "visionserver/v1/session.pb.h"
#include "visionserver/v1/system.pb.h"

#include "client/depth_stream.h"
#include "client/error.h"
#include "client/latest_stream.h"
#include "client/options.h"
#include "client/result_stream.h"
#include "client/values.h"

namespace vs::client {

namespace v1 = ::visionserver::v1;

// The server's monotonic clock as seen from here: server_ns = local steady_clock ns + offset_ns.
struct ServerClock {
  int64_t offset_ns = 0;
  int64_t uncertainty_ns = 0;  // half of the quickest round trip
};

// A connection to a VisionServer, and its everyday jobs as plain calls. What is not here can be
// called with `Call` of client/call.h. All members are thread-safe, block until the server answers
// (at most ConnectOptions::call_timeout) and never throw; a lost connection comes back by itself.
//
//   auto client = Client::Connect({.address = "cell-7", .fingerprint = "AB:CD:..."});
//   if (!client) return Report(client.error());
//   auto depth = (*client)->OpenDepth("stereo_depth/disparity");
//   auto frame = depth.Next(std::chrono::seconds(2));
class Client {
 public:
  // Errors as Connection::Open's: the message says what to do.
  static Result<std::unique_ptr<Client>> Connect(const ConnectOptions& options);

  // Exchanges name and password for a token, which all later calls carry. With
  // `must_change_password` only ChangePassword, WhoAmI and Logout work until that is done.
  Result<v1::LoginResponse> Login(const std::string& user, const std::string& password);
  // Ends the session of Login.
  Result<void> Logout();
  Result<v1::WhoAmIResponse> WhoAmI();
  Result<void> ChangePassword(const std::string& old_password, const std::string& new_password);

  Result<v1::GetServerInfoResponse> ServerInfo();
  // Asks several times and takes the quickest answer.
  Result<ServerClock> ReadServerClock();

  Result<v1::ListSequencesResponse> ListSequences();
  Result<v1::Sequence> GetSequence(const std::string& id);
  // Starts a sequence, or leaves it running. Returns once it runs, not once its first frame is out.
  Result<v1::SequenceState> StartSequence(const std::string& id);
  Result<v1::SequenceState> StopSequence(const std::string& id);
  Result<v1::SequenceState> GetSequenceState(const std::string& id);

  // Parameters are named "block.parameter".
  Result<v1::ListParametersResponse> ListParameters(const std::string& sequence);
  // Between two frames, all or none: SetParameters("stereo_depth", {{"sgm.p2", ToValue(96)}}).
  struct ParameterSetting {
    std::string path;
    v1::Value value;
  };
  Result<v1::SetParametersResponse> SetParameters(const std::string& sequence,
                                                  const std::vector<ParameterSetting>& settings);

  Result<v1::ListCamerasResponse> ListCameras();
  Result<v1::ListFeaturesResponse> ListFeatures(const std::string& camera);
  Result<v1::Value> GetFeature(const std::string& camera, const std::string& name);
  // Returns the value that the camera reads back.
  Result<v1::Value> SetFeature(const std::string& camera, const std::string& name,
                               const v1::Value& value);

  Result<v1::ListStreamsResponse> ListStreams();
  // A stream such as "stereo_depth/disparity"; it may begin later.
  DepthStream OpenDepth(const std::string& stream, const StreamOptions& options = {});
  // The same for pictures and values: items as they come from the server.
  LatestStream OpenStream(const std::string& stream, const StreamOptions& options = {});

  // The newest `count` (1..1000) that the filter lets through, newest first.
  Result<v1::ListResultsResponse> ListResults(const v1::ResultFilter& filter, uint32_t count);
  // One SELECT; `arguments` take the places of ?1, ?2 ...
  Result<v1::QueryResultsResponse> QueryResults(const std::string& sql,
                                                const std::vector<v1::Value>& arguments = {});
  ResultStream WatchResults(const v1::ResultFilter& filter = {},
                            std::optional<uint64_t> after_number = std::nullopt);

  const std::shared_ptr<Connection>& connection() const { return connection_; }

 private:
  explicit Client(std::shared_ptr<Connection> connection);

  const std::shared_ptr<Connection> connection_;
};

}  // namespace vs::client
