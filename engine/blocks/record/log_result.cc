// Writes one row of measured values for each frame.
#include <array>
#include <set>

#include "engine/base/str.h"
#include "engine/core/block.h"
#include "engine/core/result_sink.h"
#include "engine/core/sequence_spec.h"

namespace vs {
namespace {

using Class = ResultRecord::Class;

class LogResult final : public Block {
 public:
  In<Value> a{this, "a", "The first measured value; a number, text or yes/no.", Need::kSome};
  In<Value> b{this, "b", "The second measured value.", Need::kSome};
  In<Value> c{this, "c", "The third measured value.", Need::kSome};
  In<Value> d{this, "d", "The fourth measured value.", Need::kSome};
  In<Value> e{this, "e", "The fifth measured value.", Need::kSome};
  In<Value> f{this, "f", "The sixth measured value.", Need::kSome};
  In<Value> g{this, "g", "The seventh measured value.", Need::kSome};
  In<Value> h{this, "h", "The eighth measured value.", Need::kSome};
  In<bool> pass{this, "pass", "Whether the part is good.", Need::kSome};
  In<std::string> result_class{this, "result_class",
                               "The verdict: pass, warn, fail or undefined; goes before pass.",
                               Need::kSome};
  In<std::string> part_id{this, "part_id", "The part that was measured.", Need::kOptional};
  In<std::string> meas_id{this, "meas_id", "A free name of the measurement.", Need::kOptional};
  In<std::string> picture{this, "picture",
                          "The file with a picture of the frame, as SaveImages gives it; stored as "
                          "the value picture. A frame of which none was saved is no failure.",
                          Need::kOptional};
  Out<std::string> result_id{
      this, "result_id",
      "The id of the result, which is stored a moment later. Whoever must be sure that it is kept "
      "waits until it is found under this id."};
  Param<std::string> name_a{this, "name_a", Name("a")};
  Param<std::string> name_b{this, "name_b", Name("b")};
  Param<std::string> name_c{this, "name_c", Name("c")};
  Param<std::string> name_d{this, "name_d", Name("d")};
  Param<std::string> name_e{this, "name_e", Name("e")};
  Param<std::string> name_f{this, "name_f", Name("f")};
  Param<std::string> name_g{this, "name_g", Name("g")};
  Param<std::string> name_h{this, "name_h", Name("h")};

  Status Start() override {
    if (environment().results == nullptr) {
      return FailedPrecondition("results need a store: run this sequence on a server");
    }
    std::set<std::string> names;
    if (picture.connected()) names.insert("picture");
    for (const auto& [input, name] : Columns()) {
      if (!input->connected()) continue;
      if (!IsColumnType(input->source_type())) return WrongType(*input, input->source_type());
      if (!names.insert(**name).second) {
        return InvalidArgument(Str("two values are called ", **name, ": rename one"));
      }
    }
    return Status();
  }

  Status Run() override {
    ResultRecord record;
    record.job_id = run().sequence;
    record.sequence_revision = run().sequence_revision;
    record.parameter_hash = frame().parameter_hash;
    record.frame_number = frame().number;
    record.capture_ns = frame().capture_ns;
    record.processing_ns = environment().clock->MonotonicNs() - frame().popped_ns;
    if (part_id.has_value()) record.part_id = *part_id;
    if (meas_id.has_value()) record.meas_id = *meas_id;
    for (const auto& [input, name] : Columns()) {
      if (!input->has_value()) continue;
      VS_ASSIGN_OR_RETURN(record.values[**name], Column(*input));
    }
    if (picture.has_value()) record.values["picture"] = *picture;
    VS_ASSIGN_OR_RETURN(record.result_class, Verdict());
    // Also a frame whose measurement failed leaves its row.
    if (std::string missing = Missing(); !missing.empty()) {
      record.state = ResultRecord::State::kFailed;
      record.reason = Str("no value of ", missing);
    }
    VS_ASSIGN_OR_RETURN(std::string id, environment().results->Log(std::move(record)));
    result_id.Set(std::move(id));
    return Status();
  }

 private:
  struct NamedInput {
    const In<Value>* input;
    const Param<std::string>* name;
  };

  static ParamOptions<std::string> Name(const std::string& port) {
    return {.initial = port,
            .live = false,
            .doc = Str("The name under which value ", port, " is stored."),
            .check = CheckSequenceId};
  }

  std::array<NamedInput, 8> Columns() const {
    return {{{&a, &name_a},
             {&b, &name_b},
             {&c, &name_c},
             {&d, &name_d},
             {&e, &name_e},
             {&f, &name_f},
             {&g, &name_g},
             {&h, &name_h}}};
  }

  static bool IsColumnType(std::string_view type) {
    return type == "bool" || type == "integer" || type == "number" || type == "string" ||
           type == "any";
  }
  static Status WrongType(const PortBase& input, std::string_view type) {
    return InvalidArgument(
        Str(input.info().name, " must be a bool, integer, number or string, not ", type));
  }

  static Result<ParamValue> Column(const In<Value>& input) {
    const Value& value = *input;
    if (const auto* flag = value.GetIf<bool>()) return *flag;
    if (const auto* integer = value.GetIf<int64_t>()) return *integer;
    if (const auto* number = value.GetIf<double>()) return *number;
    if (const auto* text = value.GetIf<std::string>()) return *text;
    return InvalidArgument(Str(
        input.info().name, " must be a bool, integer, number or string, not ", TypeName(value)));
  }

  Result<Class> Verdict() const {
    if (result_class.has_value()) {
      if (*result_class == "pass") return Class::kPass;
      if (*result_class == "warn") return Class::kWarn;
      if (*result_class == "fail") return Class::kFail;
      if (*result_class == "undefined") return Class::kUndefined;
      return InvalidArgument(
          Str("result_class must be pass, warn, fail or undefined, not ", Quoted(*result_class)));
    }
    if (!pass.has_value()) return Class::kUndefined;
    return *pass ? Class::kPass : Class::kFail;
  }

  // Of the inputs that are connected; empty when all have a value.
  std::string Missing() const {
    std::string missing;
    const auto note = [&missing](const std::string& name) {
      missing += (missing.empty() ? "" : ", ") + name;
    };
    for (const auto& [input, name] : Columns()) {
      if (input->connected() && !input->has_value()) note(**name);
    }
    if (pass.connected() && !pass.has_value()) note("pass");
    if (result_class.connected() && !result_class.has_value()) note("result_class");
    return missing;
  }
};

VS_REGISTER_BLOCK(LogResult, {.category = "Record",
                              .doc = "Stores measured values and the verdict of each frame as one "
                                     "result."});

}  // namespace
}  // namespace vs
