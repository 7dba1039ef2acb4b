#include "client/latest_stream.h"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "visionserver/v1/stream.grpc.pb.h"

#include "client/acknowledger.h"
#include "client/stream_thread.h"

namespace vs::client {

namespace v1 = ::visionserver::v1;

namespace {

constexpr uint32_t kSubscription = 1;

v1::SubscribeRequest Request(const std::string& stream, const StreamOptions& options) {
  v1::SubscribeRequest request;
  v1::Subscription* subscription = request.add_subscriptions();
  subscription->set_id(kSubscription);
  subscription->set_stream(stream);
  subscription->set_codec(options.codec);
  subscription->set_window(options.window);
  subscription->set_max_fps(options.max_fps);
  subscription->set_include_confidence(options.confidence);
  subscription->set_include_reasons(options.reasons);
  subscription->set_jpeg_quality(options.jpeg_quality);
  return request;
}

}  // namespace

struct LatestStream::State {
  State(const std::shared_ptr<Connection>& connection, std::string stream_name,
        StreamOptions options)
      : stream(std::move(stream_name)),
        pause_while_unread(options.pause_while_unread),
        request(Request(stream, options)),
        channel(connection->channel()),
        acknowledger(connection),
        thread(connection,
               {.read = [this](grpc::ClientContext& context) { return Read(context); },
                .ended = [this](const Error& error, bool final) { Ended(error, final); }}) {}

  grpc::Status Read(grpc::ClientContext& context) {
    v1::StreamService::Stub stub(channel);
    const auto reader = stub.Subscribe(&context, request);
    v1::StreamItem item;
    while (reader->Read(&item)) {
      thread.Progress();
      if (!item.stream_id().empty()) acknowledger.Begin(item.stream_id());
      Take(std::move(item));
      item = v1::StreamItem();
    }
    return reader->Finish();
  }

  void Take(v1::StreamItem item) {
    if (item.subscription_id() != kSubscription) return;
    const uint64_t seq = item.seq();
    {
      const std::lock_guard lock(mutex);
      connected = true;
      waits_for = item.notice();
      if (!item.notice().empty()) return;
      ++stats.items;
      stats.bytes += item.ByteSizeLong();
      stats.dropped += item.dropped();
      if (newest) {
        ++stats.skipped;
        item.set_dropped(item.dropped() + newest->dropped() + 1);
      }
      newest = std::move(item);
    }
    changed.notify_one();
    if (!pause_while_unread) acknowledger.Acknowledge(kSubscription, seq);
  }

  void Ended(const Error& error, bool final) {
    {
      const std::lock_guard lock(mutex);
      if (connected) ++stats.reconnects;
      connected = false;
      waits_for = error.message + "; trying again";
      if (final) refused = error;
    }
    changed.notify_one();
  }

  const std::string stream;
  const bool pause_while_unread;
  const v1::SubscribeRequest request;
  const std::shared_ptr<grpc::Channel> channel;

  std::mutex mutex;
  std::condition_variable changed;
  std::optional<v1::StreamItem> newest;
  std::optional<Error> refused;
  bool connected = false;
  std::string waits_for;  // why no item comes; empty while they come
  StreamStats stats;

  Acknowledger acknowledger;
  StreamThread thread;  // the last: it uses all the others
};

LatestStream::LatestStream(const std::shared_ptr<Connection>& connection, std::string stream,
                           StreamOptions options)
    : state_(std::make_unique<State>(connection, std::move(stream), options)) {}

LatestStream::~LatestStream() = default;
LatestStream::LatestStream(LatestStream&&) noexcept = default;
LatestStream& LatestStream::operator=(LatestStream&&) noexcept = default;

Result<v1::StreamItem> LatestStream::Next(std::chrono::milliseconds timeout) {
  State& state = *state_;
  v1::StreamItem item;
  {
    std::unique_lock lock(state.mutex);
    state.changed.wait_for(lock, timeout, [&] { return state.newest || state.refused; });
    if (!state.newest) {
      if (state.refused) return tl::unexpected(*state.refused);
      return Failure(Code::kDeadlineExceeded,
                     "no new item of " + state.stream + " within " +
                         std::to_string(timeout.count()) + " ms" +
                         (state.waits_for.empty() ? "" : ": " + state.waits_for),
                     "NO_ITEM");
    }
    item = std::move(*state.newest);
    state.newest.reset();
  }
  if (state.pause_while_unread) state.acknowledger.Acknowledge(kSubscription, item.seq());
  return item;
}

StreamStats LatestStream::stats() const {
  const std::lock_guard lock(state_->mutex);
  return state_->stats;
}

}  // namespace vs::client
