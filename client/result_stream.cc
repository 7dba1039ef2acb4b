#include "client/result_stream.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <utility>

#include "visionserver/v1/result.grpc.pb.h"

#include "client/stream_thread.h"

namespace vs::client {

namespace v1 = ::visionserver::v1;

namespace {

constexpr size_t kQueue = 256;

v1::WatchResultsRequest Request(v1::ResultFilter filter, std::optional<uint64_t> after_number) {
  v1::WatchResultsRequest request;
  *request.mutable_filter() = std::move(filter);
  if (after_number) request.set_after_number(*after_number);
  return request;
}

}  // namespace

struct ResultStream::State {
  State(std::shared_ptr<Connection> server, v1::ResultFilter filter,
        std::optional<uint64_t> after_number)
      : connection(std::move(server)),
        request(Request(std::move(filter), after_number)),
        thread(connection,
               {.read = [this](grpc::ClientContext& context) { return Read(context); },
                .ended = [this](const Error& error, bool final) { Ended(error, final); }}) {}

  ~State() {
    const std::lock_guard lock(mutex);
    stop = true;
    if (beginning != nullptr) beginning->TryCancel();
    changed.notify_all();
  }

  grpc::Status Read(grpc::ClientContext& context) {
    v1::ResultService::Stub stub(connection->channel());
    if (!request.has_after_number()) {
      if (grpc::Status status = BeginAtNewest(stub); !status.ok()) return status;
    }
    const auto reader = stub.WatchResults(&context, request);
    v1::Result result;
    while (reader->Read(&result)) {
      thread.Progress();
      request.set_after_number(result.number());
      std::unique_lock lock(mutex);
      changed.wait(lock, [this] { return stop || queue.size() < kQueue; });
      if (stop) context.TryCancel();
      queue.push_back(std::move(result));
      result = v1::Result();
      changed.notify_all();
    }
    grpc::Status status = reader->Finish();
    if (status.error_code() == grpc::OUT_OF_RANGE && request.after_number() > 0) {
      request.set_after_number(0);
      return {grpc::UNAVAILABLE, "the server has begun its results anew"};
    }
    return status;
  }

  // Without a number to go on from, results that come while the connection is lost would be missed.
  grpc::Status BeginAtNewest(v1::ResultService::Stub& stub) {
    grpc::ClientContext context;
    connection->Prepare(context, connection->options().call_timeout);
    v1::ListResultsRequest newest;
    *newest.mutable_filter() = request.filter();
    newest.set_page_size(1);
    v1::ListResultsResponse response;
    {
      const std::lock_guard lock(mutex);
      if (stop) return grpc::Status::CANCELLED;
      beginning = &context;
    }
    grpc::Status status = stub.ListResults(&context, newest, &response);
    {
      const std::lock_guard lock(mutex);
      beginning = nullptr;
    }
    if (status.ok()) {
      request.set_after_number(response.results().empty() ? 0 : response.results(0).number());
    }
    return status;
  }

  void Ended(const Error& error, bool final) {
    const std::lock_guard lock(mutex);
    waits_for = error.message + "; trying again";
    if (final) refused = error;
    changed.notify_all();
  }

  const std::shared_ptr<Connection> connection;
  v1::WatchResultsRequest request;  // the thread's own; goes on after the last result received
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<v1::Result> queue;
  std::optional<Error> refused;
  std::string waits_for;
  bool stop = false;
  grpc::ClientContext* beginning = nullptr;  // the call of BeginAtNewest, to be cancelled
  StreamThread thread;                       // the last: it uses all the others
};

ResultStream::ResultStream(std::shared_ptr<Connection> connection, v1::ResultFilter filter,
                           std::optional<uint64_t> after_number)
    : state_(std::make_unique<State>(std::move(connection), std::move(filter), after_number)) {}

ResultStream::~ResultStream() = default;
ResultStream::ResultStream(ResultStream&&) noexcept = default;
ResultStream& ResultStream::operator=(ResultStream&&) noexcept = default;

Result<v1::Result> ResultStream::Next(std::chrono::milliseconds timeout) {
  State& state = *state_;
  std::unique_lock lock(state.mutex);
  state.changed.wait_for(lock, timeout, [&] { return !state.queue.empty() || state.refused; });
  if (!state.queue.empty()) {
    v1::Result result = std::move(state.queue.front());
    state.queue.pop_front();
    state.changed.notify_all();
    return result;
  }
  if (state.refused) return tl::unexpected(*state.refused);
  return Failure(Code::kDeadlineExceeded,
                 "no new result within " + std::to_string(timeout.count()) + " ms" +
                     (state.waits_for.empty() ? "" : ": " + state.waits_for),
                 "NO_RESULT");
}

}  // namespace vs::client
