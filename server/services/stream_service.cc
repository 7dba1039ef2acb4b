#include "server/services/stream_service.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/base/str.h"
#include "server/convert/time.h"
#include "server/results/uuid.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

constexpr int64_t kMaxWaitNs = 60'000'000'000;

template <class T>
std::vector<T> ToVector(const google::protobuf::RepeatedPtrField<T>& field) {
  return std::vector<T>(field.begin(), field.end());
}

class SubscriberSource final : public StreamSource {
 public:
  explicit SubscriberSource(std::shared_ptr<Subscriber> subscriber)
      : subscriber_(std::move(subscriber)) {}

  void Start(std::function<void()> wake) override { subscriber_->OnWake(std::move(wake)); }
  StreamStep Next() override { return subscriber_->Next(); }

 private:
  const std::shared_ptr<Subscriber> subscriber_;
};

// One item, as soon as it is there.
class LatestSource final : public StreamSource {
 public:
  LatestSource(std::shared_ptr<StreamChannel> channel, pb::GetLatestRequest request,
               int64_t until_ns, const Clock& clock)
      : channel_(std::move(channel)),
        request_(std::move(request)),
        until_ns_(until_ns),
        clock_(clock) {
    want_.after_seq = request_.after_seq();
  }

  void Start(std::function<void()> wake) override { waker_->wake = std::move(wake); }

  StreamStep Next() override {
    if (channel_->LiveOrWake(waker_)) {
      const auto encoding = Resolve(channel_->kind(), WantedBy(request_));
      if (!encoding) return StreamStep::End(encoding.error());
      if (const auto item = channel_->Take(*encoding, &want_, waker_)) {
        if (!item->status.ok()) return StreamStep::End(item->status);
        return StreamStep::Message(item->message);
      }
      // What is there already only has to be packed.
      if (channel_->Newest().second > request_.after_seq()) return StreamStep::Wait();
    }
    if (clock_.MonotonicNs() < until_ns_) return StreamStep::Wait(until_ns_);
    return StreamStep::End(channel_->live()
                               ? DeadlineExceeded("no newer item came in time")
                               : NotFound(Str("there is no stream ", Quoted(request_.stream()),
                                              ": ", channel_->absence())));
  }

 private:
  const std::shared_ptr<StreamChannel> channel_;
  const pb::GetLatestRequest request_;
  const int64_t until_ns_;
  const Clock& clock_;
  const std::shared_ptr<Waker> waker_ = std::make_shared<Waker>();
  Want want_;
};

std::pair<uint32_t, uint32_t> SizeOf(const std::shared_ptr<const Sample>& sample) {
  if (sample == nullptr) return {0, 0};
  const auto size = [](const auto& image) {
    return std::pair(static_cast<uint32_t>(image.width()), static_cast<uint32_t>(image.height()));
  };
  const Value& value = sample->value;
  if (const auto* map = value.GetIf<DisparityMap>()) return size(map->disparity);
  if (const auto* map = value.GetIf<DepthMap>()) return size(map->depth_m);
  if (const auto* image = value.GetIf<GreyImage>()) return size(*image);
  if (const auto* image = value.GetIf<ColorImage>()) return size(*image);
  if (const auto* frame = value.GetIf<Frame>()) return size(frame->image);
  if (const auto* pair = value.GetIf<StereoFrame>()) return size(pair->left->image);
  return {0, 0};
}

}  // namespace

void StreamService::Register(Router& router) {
  const std::string service = "/visionserver.v1.StreamService/";
  router.Unary(service + "ListStreams", this, &StreamService::ListStreams);
  router.Stream(service + "Subscribe", this, &StreamService::Subscribe);
  router.Unary(service + "Ack", this, &StreamService::Ack, {.lane = Lane::kInline});
  router.Unary(service + "UpdateSubscriptions", this, &StreamService::UpdateSubscriptions);
  router.Stream(service + "GetLatest", this, &StreamService::GetLatest);
}

Result<pb::ListStreamsResponse> StreamService::ListStreams(
    const Call& /*call*/, const pb::ListStreamsRequest& /*request*/) {
  std::map<std::string, uint32_t> subscriptions;
  {
    MutexLock lock(mutex_);
    for (const auto& [id, weak] : subscribers_) {
      if (const auto subscriber = weak.lock()) subscriber->CountStreams(&subscriptions);
    }
  }
  pb::ListStreamsResponse response;
  for (const auto& channel : hub_.Live()) {
    const auto [newest, seq] = channel->Newest();
    const auto [width, height] = SizeOf(newest);
    pb::StreamInfo* info = response.add_streams();
    info->set_stream(channel->name());
    info->set_kind(channel->kind());
    const std::string& name = channel->name();
    info->set_doc(
        Str(name.substr(name.find('/') + 1), " of sequence ", name.substr(0, name.find('/'))));
    info->set_seq(seq);
    info->set_width(width);
    info->set_height(height);
    for (const pb::Codec codec : CodecsOf(channel->kind())) info->add_codecs(codec);
    info->set_subscribers(subscriptions[name]);
  }
  return response;
}

Result<std::unique_ptr<StreamSource>> StreamService::Subscribe(
    const Call& call, const pb::SubscribeRequest& request) {
  const auto subscriber =
      std::make_shared<Subscriber>(RandomUuid(), call.caller.credential_id, hub_, clock_);
  VS_RETURN_IF_ERROR(subscriber->Update(ToVector(request.subscriptions()), {}));
  MutexLock lock(mutex_);
  std::erase_if(subscribers_, [](const auto& entry) { return entry.second.expired(); });
  subscribers_[subscriber->id()] = subscriber;
  return std::make_unique<SubscriberSource>(subscriber);
}

Result<pb::AckResponse> StreamService::Ack(const Call& call, const pb::AckRequest& request) {
  VS_ASSIGN_OR_RETURN(const auto subscriber, Find(call, request.stream_id()));
  subscriber->Ack(ToVector(request.items()));
  return pb::AckResponse();
}

Result<pb::UpdateSubscriptionsResponse> StreamService::UpdateSubscriptions(
    const Call& call, const pb::UpdateSubscriptionsRequest& request) {
  VS_ASSIGN_OR_RETURN(const auto subscriber, Find(call, request.stream_id()));
  VS_RETURN_IF_ERROR(
      subscriber->Update(ToVector(request.set()),
                         std::vector<uint32_t>(request.remove().begin(), request.remove().end())));
  return pb::UpdateSubscriptionsResponse();
}

Result<std::unique_ptr<StreamSource>> StreamService::GetLatest(
    const Call& /*call*/, const pb::GetLatestRequest& request) {
  const int64_t wait_ns = ToNs(request.wait());
  if (wait_ns < 0 || wait_ns > kMaxWaitNs) {
    return InvalidArgument(Str("wait must be 0 to ", kMaxWaitNs / 1'000'000'000, " s"));
  }
  return std::make_unique<LatestSource>(hub_.Channel(request.stream()), request,
                                        clock_.MonotonicNs() + wait_ns, clock_);
}

Result<std::shared_ptr<Subscriber>> StreamService::Find(const Call& call,
                                                        const std::string& stream_id) {
  std::shared_ptr<Subscriber> subscriber;
  {
    MutexLock lock(mutex_);
    const auto found = subscribers_.find(stream_id);
    if (found != subscribers_.end()) subscriber = found->second.lock();
  }
  if (subscriber == nullptr || subscriber->owner() != call.caller.credential_id) {
    return NotFound(Str("there is no open stream ", Quoted(stream_id),
                        " of yours: its id is in the first item of Subscribe"));
  }
  return subscriber;
}

}  // namespace vs
