#include "server/http/web_root.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxFileBytes = size_t{64} << 20;

std::string_view MediaType(const std::string& extension) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 13> kTypes = {
      {{".html", "text/html; charset=utf-8"},
       {".js", "text/javascript; charset=utf-8"},
       {".css", "text/css; charset=utf-8"},
       {".json", "application/json"},
       {".map", "application/json"},
       {".svg", "image/svg+xml"},
       {".png", "image/png"},
       {".jpg", "image/jpeg"},
       {".ico", "image/x-icon"},
       {".woff2", "font/woff2"},
       {".wasm", "application/wasm"},
       {".txt", "text/plain; charset=utf-8"},
       {".webmanifest", "application/manifest+json"}}};
  const auto* found = std::find_if(kTypes.begin(), kTypes.end(),
                                   [&](const auto& type) { return type.first == extension; });
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

// FNV-1a: tells contents apart, which is all that a tag is for.
std::string Tag(std::string_view content) {
  uint64_t hash = 14'695'981'039'346'656'037U;
  for (const char c : content) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1'099'511'628'211U;
  }
  return Str(std::hex, hash, '-', content.size());
}

// The path of a target with its %XX written out; nothing when one of them is not right.
std::optional<std::string> PathOf(std::string_view target) {
  target = target.substr(0, target.find_first_of("?#"));
  std::string path;
  for (size_t i = 0; i < target.size(); ++i) {
    if (target[i] != '%') {
      path += target[i];
      continue;
    }
    unsigned value = 0;
    const std::string_view digits = target.substr(i + 1, 2);
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (digits.size() != 2 || parsed.ptr != digits.data() + 2) return std::nullopt;
    path += static_cast<char>(value);
    i += 2;
  }
  return path;
}

// Whether a comma-separated header has this word, whatever its parameters but "q=0".
bool Takes(std::string_view header, std::string_view word) {
  while (!header.empty()) {
    std::string item(header.substr(0, header.find(',')));
    header.remove_prefix(std::min(header.size(), item.size() + 1));
    std::erase(item, ' ');
    const size_t end = item.find(';');
    if (item.substr(0, end) != word) continue;
    const std::string quality = end == std::string::npos ? "" : item.substr(end);
    return !quality.starts_with(";q=0") || quality.find_first_of("123456789") != std::string::npos;
  }
  return false;
}

std::string Notice(const fs::path& folder) {
  return Str(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\"><title>VisionServer</title></head>\n"
      "<body><h1>VisionServer is running</h1>\n"
      "<p>Its page is not installed here: there is no index.html in the folder ",
      folder.empty() ? "of the page" : folder.filename().string(),
      ".</p>\n<p>Build the server on a machine with Node.js 20.19 or newer, or start it with "
      "<code>--web-root DIR</code> for the folder that holds the page.</p>\n"
      "<p>Everything else works: use <code>visionctl</code> or the gRPC interface.</p>\n"
      "</body></html>\n");
}

}  // namespace

WebRoot WebRoot::Load(const fs::path& folder) {
  WebRoot root;
  root.notice_ = std::make_shared<const std::string>(Notice(folder));
  std::error_code error;
  const fs::path real = fs::canonical(folder, error);
  if (error) return root;
  for (fs::recursive_directory_iterator entry(real, error), end; !error && entry != end;
       entry.increment(error)) {
    root.Add(real, entry->path());
  }
  if (error) LogWarn("http", Str("cannot read all of ", real.string(), ": ", error.message()));
  return root;
}

void WebRoot::Add(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return;
  const fs::path real = fs::canonical(file, error);
  const std::string outside = real.lexically_relative(folder).string();
  if (error || outside.starts_with("..")) {
    LogWarn("http", Str("left out ", file.string(), ": it leads out of the folder of the page"));
    return;
  }
  if (fs::file_size(real, error) > kMaxFileBytes || error) {
    LogWarn("http", Str("left out ", file.string(), ": larger than ", kMaxFileBytes, " bytes"));
    return;
  }
  std::ifstream stream(real, std::ios::binary);
  auto content = std::make_shared<const std::string>(std::istreambuf_iterator<char>(stream),
                                                     std::istreambuf_iterator<char>());
  std::string path = "/" + file.lexically_relative(folder).generic_string();
  if (file.extension() == ".gz") {
    path.resize(path.size() - 3);
    files_[path].compressed = std::move(content);
    return;
  }
  File& added = files_[path];
  added.tag = Tag(*content);
  added.media_type = MediaType(file.extension().string());
  added.content = std::move(content);
}

HttpResponse WebRoot::Answer(const HttpRequest& request) const {
  const std::optional<std::string> path = PathOf(request.target);
  if (!path) return PlainAnswer(400, "a % in the path must be followed by two hexadecimal digits");
  auto file = files_.find(*path);
  if (file == files_.end() && path->find('.') == std::string::npos) {
    file = files_.find("/index.html");
    if (file == files_.end()) {
      return {
          .status = 503,
          .headers = {{"Content-Type", "text/html; charset=utf-8"}, {"Cache-Control", "no-store"}},
          .body = notice_};
    }
  }
  if (file == files_.end() || !file->second.content) {
    return PlainAnswer(404, "there is no such file on this server");
  }
  return Send(file->second, request, path->starts_with("/assets/"));
}

HttpResponse WebRoot::Send(const File& file, const HttpRequest& request,
                           bool keeps_for_good) const {
  const bool compressed = file.compressed && Takes(request.Header("accept-encoding"), "gzip");
  const std::string tag = Str('"', file.tag, compressed ? "-gz" : "", '"');
  HttpResponse response{
      .headers = {
          {"ETag", tag},
          {"Cache-Control", keeps_for_good ? "public, max-age=31536000, immutable" : "no-cache"}}};
  if (file.compressed) response.headers.emplace_back("Vary", "Accept-Encoding");
  const std::string_view known = request.Header("if-none-match");
  if (known == "*" || known.find(tag) != std::string_view::npos) {
    response.status = 304;
    return response;
  }
  response.headers.emplace_back("Content-Type", file.media_type);
  if (compressed) response.headers.emplace_back("Content-Encoding", "gzip");
  response.body = compressed ? file.compressed : file.content;
  return response;
}

}  // namespace vs
