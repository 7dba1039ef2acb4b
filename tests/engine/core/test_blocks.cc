#include "tests/engine/core/test_blocks.h"

#include <map>

#include "engine/base/str.h"

namespace vs {
namespace {

std::map<std::string, Probe>& Probes() {
  static std::map<std::string, Probe> probes;
  return probes;
}

// A block with hooks.
class ProbedBlock : public Block {
 public:
  Param<std::string> probe{this, "probe", {.doc = "Name of the probe to call."}};

  Status Start() override {
    if (const Probe* hooks = Hooks(); hooks != nullptr && hooks->start) return hooks->start();
    return Status();
  }
  void Stop() override {
    if (const Probe* hooks = Hooks(); hooks != nullptr && hooks->stop) hooks->stop();
  }

 protected:
  // Null without a probe. Looks the name up at each call, for Stop() is called also without Start.
  const Probe* Hooks() const {
    const auto found = Probes().find(*probe);
    return found == Probes().end() ? nullptr : &found->second;
  }
  Status Tell(const StepRun& run) const {
    const Probe* hooks = Hooks();
    return hooks != nullptr && hooks->run ? hooks->run(run) : Status();
  }
};

class TestSource final : public ProbedBlock {
 public:
  Out<int64_t> value{this, "value", "Counts the frames."};

  Status Start() override {
    if (const Probe* hooks = Hooks(); hooks != nullptr && hooks->take_wake) {
      hooks->take_wake([this] { Wake(); });
    }
    return ProbedBlock::Start();
  }
  bool Ready() override {
    const Probe* hooks = Hooks();
    return hooks == nullptr || !hooks->ready || hooks->ready();
  }
  Status Run() override {
    ++count_;
    VS_RETURN_IF_ERROR(Tell({frame(), count_, std::nullopt, 0}));
    value.Set(count_);
    return Status();
  }
  uint64_t Dropped() const override { return 7; }
  SourceReport Report() const override {
    const Probe* hooks = Hooks();
    return hooks != nullptr && hooks->report ? hooks->report() : SourceReport();
  }

 private:
  int64_t count_ = 0;
};

class TestStep final : public ProbedBlock {
 public:
  In<int64_t> a{this, "a", "The first summand."};
  In<int64_t> b{this, "b", "The second summand.", Need::kOptional};
  Out<int64_t> sum{this, "sum", "The sum."};
  Param<int> offset{this, "offset", {.min = -1000, .max = 1000, .doc = "Is added."}};
  Param<int> fixed{this, "fixed", {.initial = 1, .live = false, .doc = "Changes only at rest."}};

  Status Run() override {
    const std::optional<int64_t> second = b.has_value() ? std::optional<int64_t>(*b) : std::nullopt;
    VS_RETURN_IF_ERROR(Tell({frame(), *a, second, *offset}));
    sum.Set(*a + second.value_or(0) + *offset);
    return Status();
  }
};

class TestNumber final : public ProbedBlock {
 public:
  In<double> in{this, "in", "A number."};
  Out<double> out{this, "out", "Half of it."};

  Status Run() override {
    out.Set(*in / 2);
    return Status();
  }
};

class TestLimits final : public ProbedBlock {
 public:
  In<Value> a{this, "a", "Anything."};
  Param<double> low{this, "low", {.initial = 0, .min = -100, .max = 100, .doc = "A limit."}};
  Param<double> high{this, "high", {.initial = 10, .min = -100, .max = 100, .doc = "Another."}};

  Status CheckParams() const override {
    if (const Probe* hooks = Hooks(); hooks != nullptr && hooks->check) hooks->check();
    if (*low <= *high) return Status();
    return Status(StatusCode::kInvalidArgument, "limits are swapped",
                  {{"low", Str("is ", *low, "; it must be at most high, which is ", *high)}});
  }
  Status Run() override { return Status(); }
};

class TestSome final : public ProbedBlock {
 public:
  In<Value> a{this, "a", "Anything.", Need::kSome};
  In<Value> b{this, "b", "Anything.", Need::kSome};
  Out<int64_t> count{this, "count", "How many there are."};

  Status Run() override {
    count.Set(int64_t{a.has_value()} + int64_t{b.has_value()});
    return Tell({frame(), a.has_value(), b.has_value(), 0});
  }
};

VS_REGISTER_BLOCK(TestSource, {.category = "Test", .doc = "Counts."});
VS_REGISTER_BLOCK(TestStep, {.category = "Test", .doc = "Adds."});
VS_REGISTER_BLOCK(TestNumber, {.category = "Test", .doc = "Halves."});
VS_REGISTER_BLOCK(TestLimits, {.category = "Test", .doc = "Has limits."});
VS_REGISTER_BLOCK(TestSome, {.category = "Test", .doc = "Counts values."});

}  // namespace

Probe& ProbeOf(const std::string& name) { return Probes()[name]; }
void ClearProbes() { Probes().clear(); }

BlockSpec SourceSpec(const std::string& id) { return {id, "TestSource", {{"probe", id}}}; }
BlockSpec StepSpec(const std::string& id) { return {id, "TestStep", {{"probe", id}}}; }

Connection Wire(const std::string& from, const std::string& to) {
  const auto before = [](const std::string& text) { return text.substr(0, text.find('.')); };
  const auto after = [](const std::string& text) { return text.substr(text.find('.') + 1); };
  return {before(from), after(from), before(to), after(to)};
}

SequenceSpec ChainSpec(const std::string& id, const std::vector<std::string>& steps) {
  SequenceSpec spec;
  spec.id = id;
  spec.blocks.push_back(SourceSpec("source"));
  std::string output = "source.value";
  for (const std::string& step : steps) {
    spec.blocks.push_back(StepSpec(step));
    spec.connections.push_back(Wire(output, step + ".a"));
    output = step + ".sum";
  }
  return spec;
}

}  // namespace vs
