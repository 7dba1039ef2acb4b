#include "server/http/web_root.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

namespace vs {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string HeaderOf(const HttpResponse& response, std::string_view name) {
  for (const auto& [header, value] : response.headers) {
    if (header == name) return value;
  }
  return "";
}

std::string BodyOf(const HttpResponse& response) { return response.body ? *response.body : ""; }

class WebRootTest : public testing::Test {
 protected:
  WebRootTest() { fs::create_directories(folder_ / "web" / "assets"); }
  void Write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / "web" / name) << content;
  }
  HttpResponse Get(const std::string& target,
                   std::vector<std::pair<std::string, std::string>> headers = {}) {
    return WebRoot::Load(folder_ / "web")
        .Answer({.method = "GET", .target = target, .headers = std::move(headers)});
  }

  test::TempFolder folder_;
};

TEST_F(WebRootTest, ServesFilesByTheirNames) {
  Write("index.html", "<p>hello");
  Write("assets/app-1a2b.js", "let a;");
  EXPECT_EQ(BodyOf(Get("/index.html")), "<p>hello");
  const HttpResponse script = Get("/assets/app-1a2b.js?v=1#x");
  EXPECT_EQ(script.status, 200);
  EXPECT_EQ(BodyOf(script), "let a;");
  EXPECT_EQ(Get("/assets/none.js").status, 404);
  EXPECT_EQ(Get("/assets/%61pp-1a2b.js").status, 200);
}

TEST_F(WebRootTest, SaysWhatAFileIs) {
  const std::vector<std::pair<std::string, std::string>> types = {
      {"a.html", "text/html; charset=utf-8"},
      {"a.js", "text/javascript; charset=utf-8"},
      {"a.css", "text/css; charset=utf-8"},
      {"a.svg", "image/svg+xml"},
      {"a.woff2", "font/woff2"},
      {"a.wasm", "application/wasm"},
      {"a.json", "application/json"},
      {"a.png", "image/png"},
      {"a.unheard-of", "application/octet-stream"},
      {"a.", "application/octet-stream"}};
  for (const auto& [name, type] : types) {
    Write(name, "x");
    EXPECT_EQ(HeaderOf(Get("/" + name), "Content-Type"), type) << name;
  }
}

TEST_F(WebRootTest, GivesItsPageToPlacesWithinThePage) {
  Write("index.html", "<p>hello");
  for (const char* place : {"/", "/login", "/sequence/stereo_depth", "/results?job=7"}) {
    const HttpResponse response = Get(place);
    EXPECT_EQ(response.status, 200) << place;
    EXPECT_EQ(BodyOf(response), "<p>hello") << place;
    EXPECT_EQ(HeaderOf(response, "Cache-Control"), "no-cache") << place;
  }
  EXPECT_EQ(Get("/favicon.ico").status, 404);
  EXPECT_EQ(Get("/visionserver.v1.SessionService/Login").status, 404);
}

TEST_F(WebRootTest, LeadsToNothingOutside) {
  Write("index.html", "<p>hello");
  std::ofstream(folder_ / "secret.txt") << "secret";
  fs::create_symlink(folder_ / "secret.txt", folder_ / "web" / "link.txt");
  fs::create_directory_symlink(folder_.path(), folder_ / "web" / "up");
  fs::create_symlink("index.html", folder_ / "web" / "within.html");
  for (const char* path : {"/../secret.txt", "/assets/../../secret.txt", "/%2e%2e/secret.txt",
                           "/..%2fsecret.txt", "//secret.txt", "/link.txt", "/up/secret.txt",
                           "/./index.html", "/%00.txt", "/..\\secret.txt"}) {
    EXPECT_EQ(Get(path).status, 404) << path;
  }
  EXPECT_EQ(BodyOf(Get("/within.html")), "<p>hello");
  EXPECT_EQ(Get("/%2").status, 400);
  EXPECT_EQ(Get("/%zz").status, 400);
}

TEST_F(WebRootTest, BrowsersKeepAssetsForGood) {
  Write("assets/app.js", "x");
  EXPECT_EQ(HeaderOf(Get("/assets/app.js"), "Cache-Control"),
            "public, max-age=31536000, immutable");
}

TEST_F(WebRootTest, SendsAKnownFileNoSecondTime) {
  Write("index.html", "<p>hello");
  const std::string tag = HeaderOf(Get("/"), "ETag");
  ASSERT_THAT(tag, ::testing::MatchesRegex("\"[0-9a-f]+-[0-9a-f]+\""));
  const HttpResponse known = Get("/", {{"if-none-match", tag}});
  EXPECT_EQ(known.status, 304);
  EXPECT_EQ(known.body, nullptr);
  EXPECT_EQ(HeaderOf(known, "ETag"), tag);
  EXPECT_EQ(Get("/", {{"if-none-match", "W/" + tag}}).status, 304);
  EXPECT_EQ(Get("/", {{"if-none-match", "\"other\", " + tag}}).status, 304);
  EXPECT_EQ(Get("/", {{"if-none-match", "*"}}).status, 304);
  EXPECT_EQ(Get("/", {{"if-none-match", "\"other\""}}).status, 200);
  Write("index.html", "<p>changed");
  EXPECT_EQ(Get("/", {{"if-none-match", tag}}).status, 200);
}

TEST_F(WebRootTest, SendsACompressedFileToWhoTakesIt) {
  Write("assets/app.js", "plain");
  Write("assets/app.js.gz", "packed");
  const auto encoded = [&](const std::string& accepted) {
    const HttpResponse response = Get("/assets/app.js", {{"accept-encoding", accepted}});
    EXPECT_EQ(HeaderOf(response, "Vary"), "Accept-Encoding");
    EXPECT_EQ(HeaderOf(response, "Content-Type"), "text/javascript; charset=utf-8");
    EXPECT_EQ(HeaderOf(response, "Content-Encoding"), BodyOf(response) == "packed" ? "gzip" : "");
    return BodyOf(response);
  };
  EXPECT_EQ(encoded("gzip"), "packed");
  EXPECT_EQ(encoded("gzip, deflate, br"), "packed");
  EXPECT_EQ(encoded("br, gzip;q=0.5"), "packed");
  EXPECT_EQ(encoded(""), "plain");
  EXPECT_EQ(encoded("br"), "plain");
  EXPECT_EQ(encoded("gzip;q=0"), "plain");
  EXPECT_EQ(encoded("gzip; q=0.0"), "plain");
  EXPECT_EQ(encoded("gzipped"), "plain");
  // The two have different tags.
  EXPECT_NE(HeaderOf(Get("/assets/app.js"), "ETag"),
            HeaderOf(Get("/assets/app.js", {{"accept-encoding", "gzip"}}), "ETag"));
  // Alone, the compressed file is none.
  Write("alone.js.gz", "packed");
  EXPECT_EQ(Get("/alone.js", {{"accept-encoding", "gzip"}}).status, 404);
}

TEST_F(WebRootTest, SaysThatThePageIsMissing) {
  const HttpResponse empty = Get("/");
  EXPECT_EQ(empty.status, 503);
  EXPECT_THAT(BodyOf(empty), HasSubstr("--web-root DIR"));
  EXPECT_EQ(Get("/index.html").status, 404);
  EXPECT_FALSE(WebRoot::Load(folder_ / "web").HasPage());
  const WebRoot nowhere = WebRoot::Load(folder_ / "nowhere");
  EXPECT_EQ(nowhere.Answer({.method = "GET", .target = "/overview"}).status, 503);
  EXPECT_FALSE(WebRoot::Load("").HasPage());
  Write("index.html", "<p>hello");
  EXPECT_TRUE(WebRoot::Load(folder_ / "web").HasPage());
}

}  // namespace
}  // namespace vs
