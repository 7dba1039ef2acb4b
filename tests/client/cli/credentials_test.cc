#include "client/cli/credentials.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/temp_folder.h"

namespace vs::cli {
namespace {

class CredentialsTest : public testing::Test {
 protected:
  CredentialsTest() { setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1); }
  ~CredentialsTest() override { unsetenv("XDG_CONFIG_HOME"); }

  static unsigned ModeOf(const std::filesystem::path& path) {
    struct stat facts {};
    ::stat(path.c_str(), &facts);
    return facts.st_mode & 0777;
  }

  test::TempFolder folder_;
};

TEST_F(CredentialsTest, AreEmptyBeforeTheFirstLogin) {
  const auto loaded = LoadCredentials();
  ASSERT_TRUE(loaded);
  EXPECT_EQ("", loaded->current);
  EXPECT_TRUE(loaded->servers.empty());
}

TEST_F(CredentialsTest, AreKeptForTheirOwnerOnly) {
  const ServerLogin login{.user = "ana", .token = "secret", .fingerprint = "AB:CD"};
  ASSERT_TRUE(SaveCredentials({.current = "cell-7:50051", .servers = {{"cell-7:50051", login}}}));
  EXPECT_EQ(folder_ / "visionserver/credentials.json", CredentialsFile());
  EXPECT_EQ(0600U, ModeOf(CredentialsFile()));
  EXPECT_EQ(0700U, ModeOf(CredentialsFile().parent_path()));
  const auto loaded = LoadCredentials();
  ASSERT_TRUE(loaded) << loaded.error().ToString();
  EXPECT_EQ("cell-7:50051", loaded->current);
  EXPECT_EQ(login, loaded->servers.at("cell-7:50051"));
}

TEST_F(CredentialsTest, AreNotUsedWhenOthersMayReadThem) {
  ASSERT_TRUE(SaveCredentials({.current = "a:1", .servers = {}}));
  ::chmod(CredentialsFile().c_str(), 0644);
  const auto loaded = LoadCredentials();
  ASSERT_FALSE(loaded);
  EXPECT_NE(std::string::npos, loaded.error().message.find("chmod 600"));
}

TEST_F(CredentialsTest, SayThatTheirFileIsDamaged) {
  for (const char* text : {"", "{", "[]", "{\"current\": 1, \"servers\": {}}",
                           "{\"current\": \"a\", \"servers\": {\"a\": {}}}"}) {
    ASSERT_TRUE(SaveCredentials({}));
    std::ofstream(CredentialsFile()) << text;
    const auto loaded = LoadCredentials();
    ASSERT_FALSE(loaded) << text;
    EXPECT_NE(std::string::npos, loaded.error().message.find("damaged")) << text;
  }
}

}  // namespace
}  // namespace vs::cli
