#include <algorithm>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/base/str.h"
#include "engine/core/sequence_spec.h"

namespace vs {
namespace {

using nlohmann::json;

constexpr size_t kMaxDepth = 8;  // a sequence needs 4
constexpr size_t kMaxFaults = 100;

// Builds the tree while refusing what nlohmann::json would accept: duplicate keys (the last would
// win silently) and deep nesting.
class StrictBuilder final : public nlohmann::json_sax<json> {
 public:
  json root;
  Fault fault;
  size_t syntax_error_byte = 0;  // counted from 1; 0 = none

  bool null() override { return Add(nullptr); }
  bool boolean(bool value) override { return Add(value); }
  bool number_integer(int64_t value) override { return Add(value); }
  // Beyond int64 an integer counts as a number.
  bool number_unsigned(uint64_t value) override {
    return value <= uint64_t{std::numeric_limits<int64_t>::max()} ? Add(static_cast<int64_t>(value))
                                                                  : Add(static_cast<double>(value));
  }
  bool number_float(double value, const std::string&) override { return Add(value); }
  bool string(std::string& value) override { return Add(std::move(value)); }
  bool binary(json::binary_t&) override { return false; }  // not in text
  bool start_object(size_t) override { return Open(json::object()); }
  bool start_array(size_t) override { return Open(json::array()); }
  bool end_object() override { return Close(); }
  bool end_array() override { return Close(); }

  bool key(std::string& name) override {
    levels_.back().key = std::move(name);
    return !levels_.back().value->contains(levels_.back().key) || Refuse("is there twice");
  }

  bool parse_error(size_t byte, const std::string&, const json::exception& error) override {
    syntax_error_byte = std::max<size_t>(byte, 1);
    std::string& message = fault.message;
    message = error.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 2: WHAT; last read: 'TEXT'".
    if (const size_t end = message.find("; last read"); end != std::string::npos) {
      message.resize(end);
    }
    if (const size_t end = message.find(": "); end != std::string::npos) message.erase(0, end + 2);
    return false;
  }

 private:
  struct Level {
    json* value;
    std::string key;  // of the member being read, when an object
  };

  json* Insert(json value) {
    if (levels_.empty()) return &(root = std::move(value));
    json& parent = *levels_.back().value;
    if (parent.is_array()) return &parent.emplace_back(std::move(value));
    return &(parent[levels_.back().key] = std::move(value));
  }
  bool Add(json value) {
    Insert(std::move(value));
    return true;
  }
  bool Open(json value) {
    if (levels_.size() == kMaxDepth) return Refuse("is nested too deeply");
    levels_.push_back({Insert(std::move(value)), ""});
    return true;
  }
  bool Close() {
    levels_.pop_back();
    return true;
  }
  bool Refuse(std::string_view why) {
    for (const Level& level : levels_) {
      if (level.value->is_array()) {
        // What is being read is already in the arrays further out, but not in the innermost.
        const size_t index = level.value->size() - (&level == &levels_.back() ? 0 : 1);
        fault.subject += Str("[", index, "]");
      } else {
        fault.subject += (fault.subject.empty() ? "" : ".") + level.key;
      }
    }
    fault.message = why;
    return false;
  }

  std::vector<Level> levels_;
};

// Takes the parts of the specification out of the tree and notes what does not belong there.
class Reader {
 public:
  struct Field {
    std::string_view key;
    bool required;
    std::function<void(const json&, const std::string& place)> read;
  };

  std::vector<Fault> faults;

  void Object(const json& value, const std::string& place, std::initializer_list<Field> fields) {
    if (!value.is_object()) return Refuse(place, "must be an object", value);
    for (const auto& [key, member] : value.items()) {
      const auto* field = std::find_if(fields.begin(), fields.end(),
                                       [&k = key](const Field& one) { return one.key == k; });
      if (field == fields.end()) {
        Note(place, Str("has no ", Quoted(key), ": remove it"));
      } else {
        field->read(member, place.empty() ? key : Str(place, ".", key));
      }
    }
    for (const Field& field : fields) {
      if (field.required && !value.contains(field.key)) {
        Note(place, Str("needs ", Quoted(field.key)));
      }
    }
  }

  template <class Read>
  void Array(const json& value, const std::string& place, const Read& read) {
    if (!value.is_array()) return Refuse(place, "must be an array", value);
    for (size_t i = 0; i < value.size() && faults.size() < kMaxFaults; ++i) {
      read(value[i], Str(place, "[", i, "]"));
    }
  }

  void Text(const json& value, const std::string& place, std::string* text) {
    if (!value.is_string()) return Refuse(place, "must be a text", value);
    *text = value.get<std::string>();
  }

  void Integer(const json& value, const std::string& place, int* integer) {
    if (!value.is_number_integer()) return Refuse(place, "must be an integer", value);
    const auto wide = value.get<int64_t>();
    *integer = static_cast<int>(wide);
    if (*integer != wide) Refuse(place, "must be a 32-bit integer", value);
  }

  void Number(const json& value, const std::string& place, double* number) {
    if (!value.is_number()) return Refuse(place, "must be a number", value);
    *number = value.get<double>();
  }

  void Parameters(const json& value, const std::string& place,
                  std::map<std::string, ParamValue>* params) {
    if (!value.is_object()) return Refuse(place, "must be an object", value);
    for (const auto& [name, member] : value.items()) {
      if (faults.size() >= kMaxFaults) return;
      ParamValue& param = (*params)[name];
      if (member.is_boolean()) {
        param = member.get<bool>();
      } else if (member.is_number_integer()) {
        param = member.get<int64_t>();
      } else if (member.is_number_float()) {
        param = member.get<double>();
      } else if (member.is_string()) {
        param = member.get<std::string>();
      } else {
        Refuse(Str(place, ".", name), "must be true, false, a number or a text", member);
      }
    }
  }

  // "match.left" -> "match", "left".
  void Port(const json& value, const std::string& place, std::string* block, std::string* port) {
    std::string text;
    Text(value, place, &text);
    const size_t dot = text.find('.');
    if (dot == std::string::npos || text.find('.', dot + 1) != std::string::npos) {
      if (value.is_string()) Note(place, Str("must be \"block.port\", not ", Quoted(text)));
      return;
    }
    *block = text.substr(0, dot);
    *port = text.substr(dot + 1);
  }

 private:
  void Note(const std::string& place, std::string message) {
    if (faults.size() < kMaxFaults) {
      faults.push_back({place.empty() ? "sequence" : place, std::move(message)});
    }
  }
  void Refuse(const std::string& place, std::string_view expected, const json& found) {
    Note(place, Str(expected, ", not ",
                    found.is_structured() ? Str("an ", found.type_name())
                                          : found.dump(-1, ' ', true).substr(0, 60)));
  }
};

SequenceSpec ReadSpec(const json& root, Reader* reader) {
  SequenceSpec spec;
  const auto block = [&](const json& value, const std::string& place) {
    BlockSpec& one = spec.blocks.emplace_back();
    reader->Object(
        value, place,
        {{"id", true, [&](auto& v, auto& p) { reader->Text(v, p, &one.id); }},
         {"type", true, [&](auto& v, auto& p) { reader->Text(v, p, &one.type); }},
         {"params", false, [&](auto& v, auto& p) { reader->Parameters(v, p, &one.params); }},
         {"x", false, [&](auto& v, auto& p) { reader->Number(v, p, &one.x); }},
         {"y", false, [&](auto& v, auto& p) { reader->Number(v, p, &one.y); }}});
  };
  const auto connection = [&](const json& value, const std::string& place) {
    Connection& one = spec.connections.emplace_back();
    reader->Object(
        value, place,
        {{"from", true,
          [&](auto& v, auto& p) { reader->Port(v, p, &one.from_block, &one.from_port); }},
         {"to", true, [&](auto& v, auto& p) { reader->Port(v, p, &one.to_block, &one.to_port); }}});
  };
  reader->Object(
      root, "",
      {{"id", true, [&](auto& v, auto& p) { reader->Text(v, p, &spec.id); }},
       {"description", false, [&](auto& v, auto& p) { reader->Text(v, p, &spec.description); }},
       {"priority", false, [&](auto& v, auto& p) { reader->Integer(v, p, &spec.priority); }},
       {"max_frames_in_flight", false,
        [&](auto& v, auto& p) { reader->Integer(v, p, &spec.max_frames_in_flight); }},
       {"latency_budget_ms", false,
        [&](auto& v, auto& p) { reader->Number(v, p, &spec.latency_budget_ms); }},
       {"blocks", false, [&](auto& v, auto& p) { reader->Array(v, p, block); }},
       {"connections", false, [&](auto& v, auto& p) { reader->Array(v, p, connection); }}});
  return spec;
}

// "line 3, column 7" of the byte with this number, counted from 1.
std::string PlaceOf(size_t byte, std::string_view text) {
  const std::string_view before = text.substr(0, byte - 1);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const size_t newline = before.rfind('\n');
  const size_t line_start = newline == std::string_view::npos ? 0 : newline + 1;
  return Str("line ", line, ", column ", before.size() - line_start + 1);
}

}  // namespace

Result<SequenceSpec> ParseSequence(std::string_view text) {
  if (text.size() > kMaxSequenceBytes) {
    return InvalidArgument(
        Str("a sequence may have at most ", kMaxSequenceBytes, " bytes, not ", text.size()));
  }
  StrictBuilder builder;
  if (!json::sax_parse(text, &builder)) {
    if (builder.syntax_error_byte != 0) {
      builder.fault.subject = PlaceOf(builder.syntax_error_byte, text);
    }
    return Status(StatusCode::kInvalidArgument, "the sequence is not valid JSON",
                  {std::move(builder.fault)});
  }
  Reader reader;
  SequenceSpec spec = ReadSpec(builder.root, &reader);
  if (!reader.faults.empty()) {
    return Status(StatusCode::kInvalidArgument, "the text is not a sequence",
                  std::move(reader.faults));
  }
  return spec;
}

}  // namespace vs
