#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "server/http/http_message.h"

namespace vs {

// The files of the page, read into memory at the start: what is not in this table does not exist,
// so no path leads out of the folder, and a file is never half of one build and half of another.
//
// Beside "app.js", "app.js.gz" is the same compressed, for clients that take it. Below /assets/
// names change with their content, and browsers keep the files for good.
class WebRoot {
 public:
  // Symbolic links that lead out of `folder` are left out. Where there is no index.html, a page
  // built in here says what is missing.
  static WebRoot Load(const std::filesystem::path& folder);

  // To a GET; to a HEAD, the sender leaves the body out. A path that names no file and has no dot
  // is a place within the page, and gets index.html.
  HttpResponse Answer(const HttpRequest& request) const;
  bool HasPage() const { return files_.contains("/index.html"); }

 private:
  using Content = std::shared_ptr<const std::string>;
  struct File {
    Content content;
    Content compressed;  // null when there is none
    std::string tag;     // of the content, for If-None-Match
    std::string_view media_type;
  };

  void Add(const std::filesystem::path& folder, const std::filesystem::path& file);
  HttpResponse Send(const File& file, const HttpRequest& request, bool keeps_for_good) const;

  std::map<std::string, File, std::less<>> files_;  // by "/assets/app.js"
  Content notice_;
};

}  // namespace vs
