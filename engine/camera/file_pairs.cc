#include "engine/camera/file_pairs.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/host_folders.h"
#include "engine/base/str.h"
#include "engine/camera/image_file.h"

namespace vs {
namespace {

namespace fs = std::filesystem;

// A pattern with at most one '*'.
class Naming {
 public:
  static Result<Naming> Parse(const std::string& pattern) {
    if (std::ranges::count(pattern, '*') > 1 || pattern.find_first_of("?[") != std::string::npos) {
      return InvalidArgument(Str("pattern \"", pattern,
                                 "\" must have at most one '*', and no '?' or '[', so that the "
                                 "files of a pair can be found by each other's names"));
    }
    return Naming(pattern);
  }

  // What the '*' stands for in `name`; nullopt when the name does not match.
  std::optional<std::string> KeyOf(const std::string& name) const {
    if (star_ == std::string::npos) return name == pattern_ ? std::optional("") : std::nullopt;
    const std::string_view prefix = std::string_view(pattern_).substr(0, star_);
    const std::string_view suffix = std::string_view(pattern_).substr(star_ + 1);
    if (name.size() < prefix.size() + suffix.size() || !name.starts_with(prefix) ||
        !name.ends_with(suffix)) {
      return std::nullopt;
    }
    return name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
  }

  std::string NameOf(const std::string& key) const {
    if (star_ == std::string::npos) return pattern_;
    return std::string(pattern_).replace(star_, 1, key);
  }

 private:
  explicit Naming(const std::string& pattern) : pattern_(pattern), star_(pattern.find('*')) {}

  std::string pattern_;
  size_t star_;
};

fs::path IfThere(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) ? file : fs::path();
}

// Empty when there is no such file; an error when the name leads out of the folder.
Result<fs::path> IfThere(const fs::path& folder, const std::string& name) {
  VS_ASSIGN_OR_RETURN(const fs::path file, PathBelow(folder, name));
  return IfThere(file);
}

// The file whose name has `word` instead of the last "left"; empty when there is none.
fs::path Sibling(const fs::path& left, const std::string& word, const char* extension) {
  std::string name = left.filename().string();
  const size_t at = name.rfind("left");
  if (at == std::string::npos) return {};
  name.replace(at, 4, word);
  fs::path sibling = left.parent_path() / name;
  if (extension != nullptr) sibling.replace_extension(extension);
  return IfThere(sibling);
}

Result<std::vector<FilePair>> FindByWord(const fs::path& folder) {
  VS_ASSIGN_OR_RETURN(const std::vector<fs::path> files, FindFiles(folder, "*left*"));
  std::vector<FilePair> pairs;
  for (const fs::path& left : files) {
    const fs::path right = Sibling(left, "right", nullptr);
    if (right.empty()) continue;
    pairs.push_back({left, right, Sibling(left, "disp", ".png"), Sibling(left, "nonocc", ".png")});
  }
  if (pairs.empty()) {
    return NotFound(Str("no picture in ", folder.string(),
                        " has its partner: ", files[0].filename().string(),
                        " needs a file with \"right\" in its name "
                        "instead of \"left\""));
  }
  return pairs;
}

Result<fs::path> Optional(const fs::path& folder, const std::string& pattern,
                          const std::string& key) {
  if (pattern.empty()) return fs::path();
  VS_ASSIGN_OR_RETURN(const Naming naming, Naming::Parse(pattern));
  return IfThere(folder, naming.NameOf(key));
}

}  // namespace

Result<std::vector<FilePair>> FindFilePairs(const FilePairOptions& options) {
  if (options.left_pattern.empty() && options.right_pattern.empty()) {
    return FindByWord(options.folder);
  }
  if (options.left_pattern.empty() || options.right_pattern.empty()) {
    return InvalidArgument("give a pattern for the left and for the right pictures, or none");
  }
  VS_ASSIGN_OR_RETURN(const Naming left, Naming::Parse(options.left_pattern));
  VS_ASSIGN_OR_RETURN(const Naming right, Naming::Parse(options.right_pattern));
  VS_ASSIGN_OR_RETURN(const std::vector<fs::path> files,
                      FindFiles(options.folder, options.left_pattern));
  std::vector<FilePair> pairs;
  for (const fs::path& file : files) {
    const auto key = left.KeyOf(file.lexically_relative(options.folder).string());
    if (!key) continue;
    FilePair pair;
    pair.left = file;
    VS_ASSIGN_OR_RETURN(pair.right, IfThere(options.folder, right.NameOf(*key)));
    if (pair.right.empty()) continue;
    VS_ASSIGN_OR_RETURN(pair.truth, Optional(options.folder, options.truth_pattern, *key));
    VS_ASSIGN_OR_RETURN(pair.visible, Optional(options.folder, options.visible_pattern, *key));
    pairs.push_back(std::move(pair));
  }
  if (pairs.empty()) {
    const auto key = left.KeyOf(files[0].lexically_relative(options.folder).string());
    return NotFound(Str("no picture in ", options.folder.string(), " has its partner: ",
                        files[0].filename().string(), " needs ", right.NameOf(key.value_or(""))));
  }
  return pairs;
}

}  // namespace vs
