#include "server/config/config.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "engine/base/str.h"

namespace vs {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

constexpr size_t kMaxFileBytes = size_t{1} << 20;

struct Range {
  std::string_view field;  // full name without the package
  int32_t min;
  int32_t max;
};
// The ranges that server_config.proto tells its reader.
constexpr std::array<Range, 22> kRanges = {{{"Limits.connections", 1, 10'000},
                                            {"Limits.connections_per_address", 1, 10'000},
                                            {"Limits.streams_per_connection", 1, 1'000},
                                            {"Limits.open_streams", 1, 100'000},
                                            {"Limits.request_kib", 64, 65'536},
                                            {"Limits.receive_memory_mib", 64, 65'536},
                                            {"Limits.handshake_ms", 500, 60'000},
                                            {"Limits.keepalive_ms", 1'000, 3'600'000},
                                            {"Limits.unread_ms", 500, 600'000},
                                            {"Limits.streams_per_session", 1, 100'000},
                                            {"WebLimits.connections", 1, 10'000},
                                            {"WebLimits.connections_per_address", 1, 10'000},
                                            {"WebLimits.head_ms", 500, 60'000},
                                            {"WebLimits.body_ms", 500, 600'000},
                                            {"WebLimits.idle_ms", 500, 3'600'000},
                                            {"Sessions.idle_minutes", 1, 10'080},
                                            {"Sessions.lifetime_minutes", 1, 43'200},
                                            {"Sessions.per_user", 1, 1'000},
                                            {"Sessions.total", 1, 10'000},
                                            {"Audit.keep_days", 1, 3'650},
                                            {"Audit.keep_entries", 1'000, 10'000'000},
                                            {"Processing.workers", 0, 256}}};

// Gathers all faults of one file, with their lines.
class Faults final : public google::protobuf::io::ErrorCollector {
 public:
  Faults(std::string_view name, std::string_view text) : name_(name), text_(text) {}

  void AddError(int line, google::protobuf::io::ColumnNumber /*column*/,
                const std::string& message) override {
    Add(LineOf(message, line), message);
  }
  void AddWarning(int line, google::protobuf::io::ColumnNumber /*column*/,
                  const std::string& message) override {
    Add(LineOf(message, line), message);
  }
  // Lines count from 0 here, and from 1 for people; -1 is the file as a whole.
  void Add(int line, const std::string& message) {
    faults_.push_back({line < 0 ? name_ : Str(name_, ":", line + 1), message});
  }
  Status ToStatus() const {
    if (faults_.empty()) return Status();
    return Status(StatusCode::kInvalidArgument, Str(name_, " is not a valid configuration"),
                  faults_);
  }

 private:
  // The parser finds a bad value when it has gone on to the next word, perhaps lines later: go back
  // to where the last word that it quotes is.
  int LineOf(const std::string& message, int line) const {
    const size_t end = message.rfind('"');
    const size_t begin = end == std::string::npos ? end : message.rfind('"', end - 1);
    if (begin == std::string::npos || begin == end) return line;
    const std::string_view quoted = std::string_view(message).substr(begin + 1, end - begin - 1);
    std::vector<std::string_view> lines;
    for (size_t start = 0; start <= text_.size() && static_cast<int>(lines.size()) <= line;) {
      const size_t stop = std::min(text_.find('\n', start), text_.size());
      lines.push_back(text_.substr(start, stop - start));
      start = stop + 1;
    }
    for (int i = static_cast<int>(lines.size()) - 1; i >= 0; --i) {
      if (lines[i].find(quoted) != std::string_view::npos) return i;
    }
    return line;
  }

  const std::string name_;
  const std::string_view text_;
  std::vector<Fault> faults_;
};

class Checker {
 public:
  Checker(Faults& faults, const TextFormat::ParseInfoTree& places)
      : faults_(faults), places_(places) {}

  void Check(const config::ServerConfig& config) {
    Require(config.has_data_dir() && !config.data_dir().empty(),
            "data_dir is missing: say where to store, such as data_dir: \"/var/lib/visionserver\"");
    Require(config.has_listen_address() && !config.listen_address().empty(),
            "listen_address is missing: say where to listen, such as listen_address:"
            " \"0.0.0.0:50051\"");
    Require(config.tls_certificate().empty() == config.tls_key().empty(),
            "tls_certificate and tls_key belong together: give both or none");
    Require(!config.plaintext() || config.tls_certificate().empty(),
            "plaintext and tls_certificate contradict each other: keep one");
    Require(config.name().size() <= 64, "name has more than 64 bytes");
    CheckPictureRoots(config);
    CheckRanges(config, &places_);
    CheckCameras(config);
  }

 private:
  void Require(bool holds, const std::string& message) {
    if (!holds) faults_.Add(-1, message);
  }

  void CheckRanges(const Message& message, const TextFormat::ParseInfoTree* places) {
    std::vector<const FieldDescriptor*> set;
    message.GetReflection()->ListFields(message, &set);
    for (const FieldDescriptor* field : set) {
      if (field->is_repeated()) continue;
      if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
        CheckRanges(message.GetReflection()->GetMessage(message, field),
                    places == nullptr ? nullptr : places->GetTreeForNested(field, -1));
      } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_INT32) {
        CheckRange(*field, message.GetReflection()->GetInt32(message, field),
                   places == nullptr ? -1 : places->GetLocation(field, -1).line);
      }
    }
  }

  void CheckRange(const FieldDescriptor& field, int32_t value, int line) {
    const std::string name = Str(field.containing_type()->name(), ".", field.name());
    const auto* range = std::find_if(kRanges.begin(), kRanges.end(),
                                     [&](const Range& entry) { return entry.field == name; });
    if (range == kRanges.end() || (value >= range->min && value <= range->max)) return;
    faults_.Add(line,
                Str(field.name(), " is ", value, ", it must be ", range->min, " to ", range->max));
  }

  void CheckPictureRoots(const config::ServerConfig& config) {
    const FieldDescriptor* field =
        config.GetDescriptor()->FindFieldByNumber(config::ServerConfig::kPictureRootFieldNumber);
    for (int i = 0; i < config.picture_root_size(); ++i) {
      if (!config.picture_root(i).empty()) continue;
      faults_.Add(places_.GetLocation(field, i).line,
                  "picture_root is empty: name a folder such as \"/srv/pictures\"");
    }
  }

  void CheckCameras(const config::ServerConfig& config) {
    const FieldDescriptor* field =
        config.GetDescriptor()->FindFieldByNumber(config::ServerConfig::kCameraFieldNumber);
    std::set<std::string> ids;
    for (int i = 0; i < config.camera_size(); ++i) {
      const config::Camera& camera = config.camera(i);
      const int line = places_.GetLocation(field, i).line;
      const std::string& id = camera.id();
      const bool well_formed =
          !id.empty() && id.size() <= 63 && id[0] >= 'a' && id[0] <= 'z' &&
          std::all_of(id.begin(), id.end(), [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
          });
      if (!well_formed) {
        faults_.Add(line, Str("camera id \"", id, "\" must be 1 to 63 of a-z, 0-9 and underscore,",
                              " beginning with a letter"));
      } else if (!ids.insert(id).second) {
        faults_.Add(line, Str("camera id \"", id, "\" is used twice"));
      }
      if (camera.uri().empty()) {
        faults_.Add(line, Str("camera \"", id, "\" needs a uri such as \"gev:21000001\""));
      }
      for (const config::Feature& feature : camera.feature()) {
        if (!feature.has_name() || !feature.has_value()) {
          faults_.Add(line, Str("a feature of camera \"", id, "\" needs a name and a value"));
        }
      }
    }
  }

  Faults& faults_;
  const TextFormat::ParseInfoTree& places_;
};

void MakeAbsolute(const std::filesystem::path& folder, std::string* path) {
  *path = std::filesystem::absolute(folder / *path).lexically_normal().string();
}

std::string DefaultWebAddress(const std::string& listen_address) {
  const size_t colon = std::min(listen_address.rfind(':'), listen_address.size());
  return listen_address.substr(0, colon) + (listen_address.substr(colon) == ":0" ? ":0" : ":8443");
}

void SetDefaults(Message* message) {
  const auto* descriptor = message->GetDescriptor();
  const auto* reflection = message->GetReflection();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor* field = descriptor->field(i);
    if (field->is_repeated()) continue;
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        SetDefaults(reflection->MutableMessage(message, field));
        break;
      case FieldDescriptor::CPPTYPE_INT32:
        reflection->SetInt32(message, field, reflection->GetInt32(*message, field));
        break;
      case FieldDescriptor::CPPTYPE_BOOL:
        reflection->SetBool(message, field, reflection->GetBool(*message, field));
        break;
      case FieldDescriptor::CPPTYPE_ENUM:
        reflection->SetEnum(message, field, reflection->GetEnum(*message, field));
        break;
      case FieldDescriptor::CPPTYPE_STRING:
        reflection->SetString(message, field, reflection->GetString(*message, field));
        break;
      default:
        break;
    }
  }
}

}  // namespace

Result<config::ServerConfig> ParseConfig(std::string_view text, std::string_view name,
                                         const std::filesystem::path& folder) {
  Faults faults(name, text);
  TextFormat::ParseInfoTree places;
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&faults);
  parser.WriteLocationsTo(&places);
  parser.SetRecursionLimit(20);
  config::ServerConfig config;
  google::protobuf::io::ArrayInputStream input(text.data(), static_cast<int>(text.size()));
  if (parser.Parse(&input, &config)) Checker(faults, places).Check(config);
  VS_RETURN_IF_ERROR(faults.ToStatus());

  MakeAbsolute(folder, config.mutable_data_dir());
  if (!config.has_sequences_dir()) config.set_sequences_dir(config.data_dir() + "/sequences");
  if (!config.has_rigs_dir()) config.set_rigs_dir(config.data_dir() + "/rigs");
  MakeAbsolute(folder, config.mutable_sequences_dir());
  MakeAbsolute(folder, config.mutable_rigs_dir());
  if (!config.has_web_address()) {
    config.set_web_address(DefaultWebAddress(config.listen_address()));
  }
  for (std::string& root : *config.mutable_picture_root()) MakeAbsolute(folder, &root);
  if (config.has_tls_certificate()) {
    MakeAbsolute(folder, config.mutable_tls_certificate());
    MakeAbsolute(folder, config.mutable_tls_key());
  }
  return config;
}

Result<config::ServerConfig> LoadConfig(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) {
    return NotFound(Str(file.string(), " is a folder, not a configuration file"));
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    return NotFound(
        Str("cannot read the configuration file ", file.string(), ": ", std::strerror(errno)));
  }
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  if (text.size() > kMaxFileBytes) {
    return InvalidArgument(Str(file.string(), " has ", text.size(), " bytes; at most ",
                               kMaxFileBytes, " are read: is it a configuration file?"));
  }
  return ParseConfig(text, file.string(), std::filesystem::absolute(file).parent_path());
}

std::string Describe(const config::ServerConfig& config) {
  config::ServerConfig complete = config;
  SetDefaults(&complete);
  std::string text;
  TextFormat::PrintToString(complete, &text);
  return text;
}

}  // namespace vs
