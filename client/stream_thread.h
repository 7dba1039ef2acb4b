#pragma once

#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <random>
#include <thread>

#include "client/connection.h"

namespace vs::client {

// Holds one server stream open in a thread of its own: when the connection is lost or the server
// restarts, it tries again after a pause that grows to 5 s. The pauses are jittered, so that the
// clients of a restarted server do not all come at once.
class StreamThread {
 public:
  struct Hooks {
    // Opens the stream, reads it to its end and returns how it ended. Calls Progress() whenever
    // something has come.
    std::function<grpc::Status(grpc::ClientContext&)> read;
    // The stream ended; `final`: it will not be opened again, because the server refused it.
    std::function<void(const Error& error, bool final)> ended;
  };

  StreamThread(std::shared_ptr<Connection> connection, Hooks hooks);
  // Cancels the stream and waits for the thread.
  ~StreamThread();
  StreamThread(const StreamThread&) = delete;
  StreamThread& operator=(const StreamThread&) = delete;

  // The stream works: the next pause is the shortest again. For `read` only.
  void Progress() { attempts_ = 0; }

 private:
  void Run();
  // False when it is time to stop.
  bool Pause();

  const std::shared_ptr<Connection> connection_;
  const Hooks hooks_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;
  grpc::ClientContext* open_ = nullptr;  // the stream that stands, to be cancelled
  int attempts_ = 0;                     // since something came; the thread's own
  std::minstd_rand jitter_;
  std::thread thread_;
};

}  // namespace vs::client
