#pragma once

#include <map>
#include <memory>
#include <string>

#include "visionserver/v1/stream.pb.h"

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/rpc/router.h"
#include "server/streams/stream_hub.h"
#include "server/streams/subscriber.h"

namespace vs {

// Live outputs of running sequences: see stream.proto.
class StreamService {
 public:
  // Both must outlive it, and it its open streams.
  StreamService(StreamHub& hub, const Clock& clock) : hub_(hub), clock_(clock) {}
  void Register(Router& router);

 private:
  Result<visionserver::v1::ListStreamsResponse> ListStreams(
      const Call& call, const visionserver::v1::ListStreamsRequest& request);
  Result<std::unique_ptr<StreamSource>> Subscribe(
      const Call& call, const visionserver::v1::SubscribeRequest& request);
  Result<visionserver::v1::AckResponse> Ack(const Call& call,
                                            const visionserver::v1::AckRequest& request);
  Result<visionserver::v1::UpdateSubscriptionsResponse> UpdateSubscriptions(
      const Call& call, const visionserver::v1::UpdateSubscriptionsRequest& request);
  Result<std::unique_ptr<StreamSource>> GetLatest(
      const Call& call, const visionserver::v1::GetLatestRequest& request);

  // NOT_FOUND also for a stream of somebody else.
  Result<std::shared_ptr<Subscriber>> Find(const Call& call, const std::string& stream_id)
      VS_EXCLUDES(mutex_);

  StreamHub& hub_;
  const Clock& clock_;
  Mutex mutex_;
  std::map<std::string, std::weak_ptr<Subscriber>> subscribers_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
