// Makes a value of each frame available to clients as a stream.
#include "engine/base/str.h"
#include "engine/core/block.h"
#include "engine/core/sequence_spec.h"
#include "engine/core/topic.h"

namespace vs {
namespace {

class Publish final : public Block {
 public:
  In<Value> value{this, "value", "The value to publish; any type."};
  Param<std::string> stream{this,
                            "stream",
                            {.initial = "output",
                             .live = false,
                             .doc = "Name of the stream; clients find it as sequence/stream.",
                             .check = CheckSequenceId}};

  Status Start() override {
    TopicHub* topics = environment().topics;
    if (topics == nullptr) {
      return FailedPrecondition("streams need a server: run this sequence on one");
    }
    VS_ASSIGN_OR_RETURN(
        topic_, topics->Open(Str(run().sequence, "/", *stream), std::string(value.source_type())));
    return Status();
  }

  Status Run() override {
    topic_->Publish(*value, frame(), environment().clock->MonotonicNs());
    return Status();
  }

  void Stop() override { topic_.reset(); }

 private:
  std::shared_ptr<Topic> topic_;
};

VS_REGISTER_BLOCK(Publish, {.category = "Communicate",
                            .doc = "Makes a value of each frame available to clients as a "
                                   "stream; a slow client gets the newest."});

}  // namespace
}  // namespace vs
