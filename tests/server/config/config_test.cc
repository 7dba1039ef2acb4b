#include "server/config/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kMinimal =
    "data_dir: \"data\"\n"
    "listen_address: \"0.0.0.0:50051\"\n";

Result<config::ServerConfig> Parse(const std::string& text) {
  return ParseConfig(text, "server.conf", "/etc/visionserver");
}

// "server.conf:3: what is wrong" for each fault.
std::vector<std::string> FaultsOf(const std::string& text) {
  const Result<config::ServerConfig> config = Parse(text);
  std::vector<std::string> faults;
  if (config) return faults;
  for (const Fault& fault : config.error().faults()) {
    faults.push_back(fault.subject + ": " + fault.message);
  }
  return faults;
}

TEST(Config, NeedsOnlyAFolderAndAnAddress) {
  const Result<config::ServerConfig> config = Parse(kMinimal);
  ASSERT_TRUE(config.has_value()) << config.error().ToString();
  EXPECT_EQ(config->data_dir(), "/etc/visionserver/data");
  EXPECT_EQ(config->sequences_dir(), "/etc/visionserver/data/sequences");
  EXPECT_EQ(config->rigs_dir(), "/etc/visionserver/data/rigs");
  EXPECT_EQ(config->profile(), config::ServerConfig::RUN_TIME);
  EXPECT_FALSE(config->plaintext());
  EXPECT_EQ(config->sessions().idle_minutes(), 30);
  EXPECT_EQ(config->limits().connections(), 1024);
}

TEST(Config, ThePageIsBesideTheApiUnlessItSaysOtherwise) {
  const auto page = [](const std::string& listen, const std::string& more = "") {
    return Parse("data_dir: \"d\" listen_address: \"" + listen + "\" " + more)->web_address();
  };
  EXPECT_EQ(page("0.0.0.0:50051"), "0.0.0.0:8443");
  EXPECT_EQ(page("[::1]:50051"), "[::1]:8443");
  EXPECT_EQ(page("localhost:0"), "localhost:0");
  EXPECT_EQ(page("127.0.0.1:50051", "web_address: \"127.0.0.1:443\""), "127.0.0.1:443");
  EXPECT_EQ(page("127.0.0.1:50051", "web_address: \"\""), "");
}

TEST(Config, TakesCommentsAndCameras) {
  const Result<config::ServerConfig> config = Parse(
      "# The cell at door 3.\n"
      "data_dir: \"/var/lib/vs\"  # absolute\n"
      "listen_address: \"[::]:50051\"\n"
      "camera { id: \"left\" uri: \"gev:21000001\" feature { name: \"Gain\" value: \"4\" } }\n"
      "camera { id: \"right\" uri: \"gev:21000002\" }\n");
  ASSERT_TRUE(config.has_value()) << config.error().ToString();
  EXPECT_EQ(config->data_dir(), "/var/lib/vs");
  ASSERT_EQ(config->camera_size(), 2);
  EXPECT_EQ(config->camera(0).feature(0).name(), "Gain");
}

TEST(Config, NamesTheLineOfAnUnknownField) {
  EXPECT_THAT(FaultsOf("data_dir: \"data\"\n\nlisten_adress: \"0.0.0.0:1\"\n"),
              ElementsAre(AllOf(HasSubstr("server.conf:3"), HasSubstr("listen_adress"))));
  EXPECT_THAT(FaultsOf(std::string(kMinimal) + "limits {\n  conections: 5\n}\n"),
              ElementsAre(AllOf(HasSubstr("server.conf:4"), HasSubstr("conections"))));
}

TEST(Config, NamesTheLineOfAWrongValue) {
  EXPECT_THAT(FaultsOf(std::string(kMinimal) + "plaintext: perhaps\n"),
              ElementsAre(HasSubstr("server.conf:3")));
  EXPECT_THAT(FaultsOf(std::string(kMinimal) + "profile: FAST\n\n# or not\nname: \"x\"\n"),
              ElementsAre(HasSubstr("server.conf:3")));
  EXPECT_THAT(FaultsOf("data_dir: \"data\"\ndata_dir: \"other\"\nlisten_address: \"[::]:1\"\n"),
              ElementsAre(HasSubstr("server.conf:2")));
}

TEST(Config, NamesEveryValueOutOfRangeAtOnce) {
  EXPECT_THAT(FaultsOf(std::string(kMinimal) + "limits {\n"
                                               "  connections: 0\n"
                                               "  handshake_ms: 60001\n"
                                               "}\n"
                                               "sessions { idle_minutes: -5 }\n"),
              ElementsAre("server.conf:4: connections is 0, it must be 1 to 10000",
                          "server.conf:5: handshake_ms is 60001, it must be 500 to 60000",
                          "server.conf:7: idle_minutes is -5, it must be 1 to 10080"));
}

TEST(Config, NamesWhatIsMissing) {
  EXPECT_THAT(FaultsOf(""), ElementsAre(HasSubstr("data_dir is missing"),
                                        HasSubstr("listen_address is missing")));
  EXPECT_THAT(FaultsOf("data_dir: \"\"\nlisten_address: \"[::]:1\"\n"),
              ElementsAre(HasSubstr("data_dir is missing")));
  EXPECT_THAT(FaultsOf(std::string(kMinimal) + "tls_key: \"k.pem\"\n"),
              ElementsAre(HasSubstr("tls_certificate and tls_key belong together")));
}

TEST(Config, ChecksCameras) {
  EXPECT_THAT(FaultsOf(std::string(kMinimal) +
                       "camera { id: \"left\" uri: \"gev:1\" }\n"
                       "camera { id: \"left\" uri: \"gev:2\" }\n"
                       "camera { id: \"Right one\" uri: \"gev:3\" }\n"
                       "camera { id: \"third\" }\n"
                       "camera { id: \"fourth\" uri: \"gev:4\" feature { name: \"Gain\" } }\n"),
              ElementsAre("server.conf:4: camera id \"left\" is used twice",
                          HasSubstr("server.conf:5: camera id \"Right one\""),
                          HasSubstr("server.conf:6: camera \"third\" needs a uri"),
                          HasSubstr("server.conf:7: a feature of camera \"fourth\"")));
}

TEST(Config, RefusesAnEmptyPictureRoot) {
  EXPECT_THAT(FaultsOf(std::string(kMinimal) + "picture_root: \"/a\"\npicture_root: \"\"\n"),
              ElementsAre(HasSubstr("server.conf:4: picture_root is empty")));
}

TEST(Config, RefusesGarbageWithALine) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    std::string text = kMinimal;
    // A flipped bit somewhere, as a worn-out disk does.
    text[random() % text.size()] ^= static_cast<char>(1U << (random() % 8));
    const Result<config::ServerConfig> config = Parse(text);
    if (config) {
      // Only a character inside a quoted value may change without being noticed.
      EXPECT_FALSE(config->data_dir().empty());
      EXPECT_FALSE(config->listen_address().empty());
    } else {
      EXPECT_THAT(config.error().ToString(), HasSubstr("server.conf"));
    }
  }
  EXPECT_THAT(FaultsOf(std::string("\x7f"
                                   "ELF\0\0\0",
                                   7)),
              Contains(HasSubstr("server.conf:1")));
  EXPECT_THAT(FaultsOf(std::string(kMinimal).substr(0, 30)), Contains(HasSubstr("server.conf:2")));
}

TEST(Config, SaysWhyAFileCannotBeRead) {
  const test::TempFolder folder;
  EXPECT_EQ(LoadConfig(folder / "none.conf").error().code(), StatusCode::kNotFound);
  EXPECT_THAT(LoadConfig(folder / "none.conf").error().message(), HasSubstr("No such file"));
  EXPECT_FALSE(LoadConfig(folder.path()).has_value());
  std::ofstream(folder / "large.conf") << std::string(2 << 20, '#');
  EXPECT_THAT(LoadConfig(folder / "large.conf").error().message(), HasSubstr("configuration file"));
}

TEST(Config, CountsRelativePathsFromTheFile) {
  const test::TempFolder folder;
  std::ofstream(folder / "server.conf")
      << kMinimal << "tls_certificate: \"c.pem\" tls_key: \"../k.pem\" rigs_dir: \"/srv/rigs\" "
      << "picture_root: \"../pictures\" picture_root: \"/srv/parts\"";
  const Result<config::ServerConfig> config = LoadConfig(folder / "server.conf");
  ASSERT_TRUE(config.has_value()) << config.error().ToString();
  EXPECT_EQ(config->data_dir(), folder / "data");
  EXPECT_EQ(config->tls_certificate(), folder / "c.pem");
  EXPECT_EQ(config->tls_key(), folder.path().parent_path() / "k.pem");
  EXPECT_EQ(config->rigs_dir(), "/srv/rigs");
  ASSERT_EQ(config->picture_root_size(), 2);
  EXPECT_EQ(config->picture_root(0), folder.path().parent_path() / "pictures");
  EXPECT_EQ(config->picture_root(1), "/srv/parts");
}

TEST(Config, DescriptionIsAConfigurationWithNothingLeftOpen) {
  const std::string text = Describe(*Parse(kMinimal));
  EXPECT_THAT(text, HasSubstr("plaintext: false"));
  EXPECT_THAT(text, HasSubstr("idle_minutes: 30"));
  EXPECT_THAT(text, HasSubstr("profile: RUN_TIME"));
  // Except for what has no default.
  const Result<config::ServerConfig> again = Parse(text);
  ASSERT_TRUE(again.has_value()) << again.error().ToString();
  EXPECT_EQ(again->sessions().idle_minutes(), 30);
}

}  // namespace
}  // namespace vs
