// A robot program: how far away is what lies at a place in the image, and was the part good?
//
//   VISIONSERVER_TOKEN=API_KEY robot_guidance SERVER FINGERPRINT SEQUENCE STREAM
//
// The API key comes from `visionctl keys create NAME`, the fingerprint from the server's start.
#include <cstdio>
#include <cstdlib>

#include "client/client.h"

using namespace std::chrono_literals;
using vs::client::Client;

namespace {

// What went wrong and what to do about it; the code tells a program the same.
int Fail(const vs::client::Error& error) {
  std::fprintf(stderr, "%s\n", error.ToString().c_str());
  return static_cast<int>(error.code);
}

}  // namespace

int main(int argument_count, char** arguments) {
  const char* key = std::getenv("VISIONSERVER_TOKEN");
  if (argument_count != 5 || key == nullptr) {
    std::fputs(
        "usage: VISIONSERVER_TOKEN=API_KEY robot_guidance SERVER FINGERPRINT SEQUENCE STREAM\n",
        stderr);
    return 2;
  }
  const std::string sequence = arguments[3];

  // Connect once; the connection comes back by itself when the server or the cable does.
  auto client =
      Client::Connect({.address = arguments[1], .fingerprint = arguments[2], .credential = key});
  if (!client) return Fail(client.error());

  // Leaves a running sequence as it is.
  if (auto state = (*client)->StartSequence(sequence); !state) return Fail(state.error());

  // A smoother surface from here on: in force between two frames, and stored.
  auto set = (*client)->SetParameters(sequence, {{"match.p2", vs::client::ToValue(40)}});
  if (!set) return Fail(set.error());

  // The newest depth image whenever it is asked for, however long the arm was busy in between.
  auto depth = (*client)->OpenDepth(sequence + "/" + arguments[4]);
  for (int cycle = 0; cycle < 5; ++cycle) {
    auto frame = depth.Next(10s);
    if (!frame) return Fail(frame.error());
    const vs::client::Roi middle = {
        .x = frame->width / 2 - 20, .y = frame->height / 2 - 20, .width = 40, .height = 40};
    if (const auto depth_m = frame->MedianDepth(middle)) {
      std::printf("frame %llu: %.4f m\n", static_cast<unsigned long long>(frame->frame_number),
                  *depth_m);
    } else {
      std::printf("nothing seen there\n");  // no error: the robot decides
    }
  }

  // What the sequence logged last.
  vs::client::v1::ResultFilter filter;
  filter.set_job_id(sequence);
  auto results = (*client)->ListResults(filter, 1);
  if (!results) return Fail(results.error());
  for (const auto& result : results->results()) {
    std::printf("result %llu: %s\n", static_cast<unsigned long long>(result.number()),
                result.result_class() == vs::client::v1::RESULT_CLASS_PASS ? "good" : "not good");
  }
  return 0;
}
