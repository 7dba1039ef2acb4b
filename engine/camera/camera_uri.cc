#include "engine/camera/camera_uri.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "engine/base/str.h"

namespace vs {
namespace {

bool IsFeature(std::string_view key) {
  return !key.empty() && std::isupper(static_cast<unsigned char>(key.front())) != 0;
}

Result<std::string> Unescaped(std::string_view text) {
  std::string plain;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      plain += text[i];
      continue;
    }
    unsigned code = 0;
    const char* digits = text.data() + i + 1;
    if (i + 2 >= text.size() || std::from_chars(digits, digits + 2, code, 16).ptr != digits + 2) {
      return InvalidArgument(
          Str("'%' in \"", text, "\" must be followed by two hex digits; write %25 for itself"));
    }
    plain += static_cast<char>(code);
    i += 2;
  }
  return plain;
}

std::string Escaped(std::string_view text, std::string_view special) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string escaped;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c != '%' && byte > 0x20 && byte != 0x7f && special.find(c) == std::string_view::npos) {
      escaped += c;
    } else {
      escaped += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return escaped;
}

bool IsSchemeChar(char c) {
  return std::islower(static_cast<unsigned char>(c)) != 0 ||
         std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '-';
}

template <class Number>
std::optional<Number> Parsed(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end) return std::nullopt;
  return value;
}

}  // namespace

Result<CameraUri> CameraUri::Parse(std::string_view text) {
  const auto shape = [text] {
    return Str("camera \"", text, "\" is not of the form scheme:address?key=value&key=value");
  };
  const size_t colon = text.find(':');
  if (colon == 0 || colon == std::string_view::npos) {
    return InvalidArgument(shape() + ", for example gev:21000001 or file:/data/run7");
  }
  CameraUri uri;
  uri.scheme = text.substr(0, colon);
  if (!std::ranges::all_of(uri.scheme, IsSchemeChar)) {
    return InvalidArgument(shape() + ": the scheme has lower-case letters, digits and '-' only");
  }
  const size_t question = std::min(text.find('?'), text.size());
  VS_ASSIGN_OR_RETURN(uri.address, Unescaped(text.substr(colon + 1, question - colon - 1)));
  if (uri.address.empty()) {
    return InvalidArgument(shape() + ": there is no address after '" + uri.scheme + ":'");
  }
  for (size_t start = question + 1; start < text.size();) {
    const size_t end = std::min(text.find('&', start), text.size());
    const std::string_view option = text.substr(start, end - start);
    const size_t equals = option.find('=');
    if (equals == 0 || equals == std::string_view::npos) {
      return InvalidArgument(Str(shape(), ": \"", option, "\" is not a key=value"));
    }
    VS_ASSIGN_OR_RETURN(std::string key, Unescaped(option.substr(0, equals)));
    VS_ASSIGN_OR_RETURN(std::string value, Unescaped(option.substr(equals + 1)));
    // A feature may come several times: selectors change what the next feature is about.
    if (!IsFeature(key) && uri.Option(key)) {
      return InvalidArgument(Str("camera \"", text, "\" gives ", key, " twice"));
    }
    uri.options.emplace_back(std::move(key), std::move(value));
    start = end + 1;
  }
  return uri;
}

std::string CameraUri::ToString() const {
  std::string text = scheme + ":" + Escaped(address, "?");
  char separator = '?';
  for (const auto& [key, value] : options) {
    text += separator + Escaped(key, "=&") + "=" + Escaped(value, "&");
    separator = '&';
  }
  return text;
}

std::optional<std::string> CameraUri::Option(std::string_view key) const {
  const auto found = std::ranges::find(options, key, &Options::value_type::first);
  if (found == options.end()) return std::nullopt;
  return found->second;
}

CameraUri::Options CameraUri::Features() const {
  Options features;
  std::ranges::copy_if(options, std::back_inserter(features),
                       [](const auto& option) { return IsFeature(option.first); });
  return features;
}

std::optional<std::string> UriOptions::Take(std::string_view key) {
  known_.emplace_back(key);
  return uri_.Option(key);
}

void UriOptions::Refuse(std::string_view key, const std::string& value,
                        const std::string& expected) {
  faults_.push_back({std::string(key), Str("\"", value, "\" is not ", expected)});
}

std::string UriOptions::Text(std::string_view key, std::string_view initial) {
  return Take(key).value_or(std::string(initial));
}

bool UriOptions::Flag(std::string_view key, bool initial) {
  const auto text = Take(key);
  if (!text) return initial;
  if (*text == "true" || *text == "1") return true;
  if (*text == "false" || *text == "0") return false;
  Refuse(key, *text, "true or false");
  return initial;
}

int64_t UriOptions::Integer(std::string_view key, int64_t initial, int64_t min, int64_t max) {
  const auto text = Take(key);
  if (!text) return initial;
  const auto value = Parsed<int64_t>(*text);
  if (value && *value >= min && *value <= max) return *value;
  Refuse(key, *text, Str("a whole number from ", min, " to ", max));
  return initial;
}

double UriOptions::Number(std::string_view key, double initial, double min, double max) {
  const auto text = Take(key);
  if (!text) return initial;
  const auto value = Parsed<double>(*text);
  if (value && *value >= min && *value <= max) return *value;
  Refuse(key, *text, Str("a number from ", min, " to ", max));
  return initial;
}

Status UriOptions::Check() const {
  std::vector<Fault> faults = faults_;
  for (const auto& [key, value] : uri_.options) {
    if (IsFeature(key) || std::ranges::count(known_, key) > 0) continue;
    std::string names;
    for (const std::string& name : known_) names += (names.empty() ? "" : ", ") + name;
    faults.push_back({key, Str("unknown option of ", uri_.scheme, ":; there are ", names)});
  }
  if (faults.empty()) return {};
  return Status(StatusCode::kInvalidArgument,
                Str("camera ", uri_.ToString(), " has options that make no sense"),
                std::move(faults));
}

}  // namespace vs
