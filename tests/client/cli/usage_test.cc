// visionctl where no server is needed, or none is reached.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/client/certificates.h"
#include "tests/client/cli/visionctl.h"
#include "tests/client/fake_server.h"

namespace vs::test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Lt;
using ::testing::Ne;
using ::testing::StartsWith;

constexpr const char* kCommands[] = {"",
                                     "login",
                                     "logout",
                                     "whoami",
                                     "passwd",
                                     "sequences",
                                     "sequences list",
                                     "sequences show",
                                     "sequences validate",
                                     "sequences create",
                                     "sequences update",
                                     "sequences delete",
                                     "sequences start",
                                     "sequences stop",
                                     "sequences state",
                                     "sequences blocks",
                                     "get",
                                     "set",
                                     "depth",
                                     "streams",
                                     "streams list",
                                     "cameras",
                                     "cameras list",
                                     "cameras discover",
                                     "cameras features",
                                     "cameras get",
                                     "cameras set",
                                     "cameras trigger",
                                     "results",
                                     "results query",
                                     "results tail",
                                     "results file",
                                     "results export",
                                     "users",
                                     "users list",
                                     "users create",
                                     "users update",
                                     "users delete",
                                     "users reset-password",
                                     "users unlock",
                                     "users sessions",
                                     "users revoke-session",
                                     "keys",
                                     "keys list",
                                     "keys create",
                                     "keys revoke",
                                     "audit",
                                     "status"};

// Whether it is what a script and a person expect: the code, and one line that begins with the
// name.
void ExpectFailure(const FinishedProcess& done, int exit_code, const std::string& says) {
  EXPECT_EQ(exit_code, done.exit_code) << done.error_output;
  EXPECT_EQ("", done.output);
  EXPECT_THAT(done.error_output, StartsWith("visionctl: "));
  EXPECT_THAT(done.error_output, HasSubstr(says));
  EXPECT_THAT(done.error_output, EndsWith("\n"));
  EXPECT_EQ(1, std::count(done.error_output.begin(), done.error_output.end(), '\n'))
      << done.error_output;
}

TEST(VisionctlUsage, EveryCommandExplainsItself) {
  const Visionctl visionctl;
  for (const char* words : kCommands) {
    std::vector<std::string> arguments;
    std::istringstream stream(words);
    for (std::string word; stream >> word;) arguments.push_back(word);
    arguments.emplace_back("--help");
    const FinishedProcess done = visionctl(arguments);
    EXPECT_EQ(0, done.exit_code) << words;
    EXPECT_THAT(done.output, HasSubstr("Usage: visionctl")) << words;
    EXPECT_THAT(done.output, HasSubstr("xit codes")) << words;
  }
}

TEST(VisionctlUsage, WrongUsageEndsWithTwo) {
  const Visionctl visionctl;
  ExpectFailure(visionctl({}), 2, "--help");
  ExpectFailure(visionctl({"dance"}), 2, "--help");
  ExpectFailure(visionctl({"depth"}), 2, "SEQUENCE");
  ExpectFailure(visionctl({"depth", "stereo", "--frames", "-1"}), 2, "--frames");
  ExpectFailure(visionctl({"depth", "stereo", "--codec", "gif"}), 2, "gif");
  ExpectFailure(visionctl({"set", "stereo"}), 2, "VALUE");
  ExpectFailure(visionctl({"status", "--timeout", "0"}), 2, "--timeout");
}

TEST(VisionctlUsage, NamesWhatItDoesNotKnow) {
  const Visionctl visionctl;
  ExpectFailure(visionctl({"frob"}), 2, "visionctl has no command \"frob\"");
  ExpectFailure(visionctl({"cameras", "frob"}), 2, "visionctl cameras has no command \"frob\"");
  ExpectFailure(visionctl({"--frob"}), 2, "visionctl has no option \"--frob\"");
  ExpectFailure(visionctl({"login", "ana", "ben", "cleo"}), 2, "not expected");
  ExpectFailure(visionctl({"sequences", "create", "foo", "bar", "--file", "x"}), 2, "bar");
  ExpectFailure(visionctl({"sequences", "validate", "foo", "bar"}), 2, "bar");
  ExpectFailure(visionctl({"depth", "stereo", "--frames", "x"}), 2, "\"x\" is no whole number");
  ExpectFailure(visionctl({"depth", "stereo", "--window", "17"}), 2, "17 is not between 1 and 16");
  ExpectFailure(visionctl({"depth", "stereo", "--max-fps", "x"}), 2, "\"x\" is no number");
}

TEST(VisionctlUsage, ASequenceThatIsAFileIsAskedAbout) {
  const Visionctl visionctl;
  const std::string file = visionctl.home() / "s.json";
  std::ofstream(file) << "{}";
  ExpectFailure(visionctl({"sequences", "create", file}), 6, "did you mean --file " + file + "?");
  ExpectFailure(visionctl({"sequences", "validate", file}), 6, "did you mean --file " + file);
}

TEST(VisionctlUsage, ASequenceIsNotTypedByHand) {
  // script(1) gives the command a terminal.
  const FinishedProcess done =
      Visionctl().Shell("script -qec 'visionctl sequences create' /dev/null");
  EXPECT_EQ(6, done.exit_code);
  EXPECT_THAT(done.output, HasSubstr("--file"));
}

TEST(VisionctlUsage, EveryExampleIsUnderstood) {
  Visionctl visionctl;
  visionctl.environment()["VISIONSERVER_ADDRESS"] = FakeServer().Address();  // gone by now
  int tried = 0;
  for (const char* words : kCommands) {
    for (const std::string& example : visionctl.Examples(words)) {
      const FinishedProcess done = visionctl.Shell(example);
      EXPECT_THAT(done.exit_code, AllOf(Ne(0), Ne(2), Lt(100))) << example << done.error_output;
      ++tried;
    }
  }
  EXPECT_GE(tried, 20);
}

TEST(VisionctlUsage, NoServerEndsWithThree) {
  const std::string nobody = [] {
    const FakeServer server;
    return server.Address();
  }();
  const Visionctl visionctl;
  ExpectFailure(visionctl({"status", "--server", nobody}), 3, "nothing listens on " + nobody);
  ExpectFailure(visionctl({"status", "--server", nobody, "--plaintext"}), 3, nobody);
  ExpectFailure(visionctl({"status", "--server", "no-such-host.invalid"}), 3, "not known");
}

TEST(VisionctlUsage, AServerThatIsNotKnownEndsWithThree) {
  const TempFolder folder;
  const CertificatePair own =
      MakeCertificate(folder.path(), "server", "DNS:localhost,IP:127.0.0.1");
  const CertificatePair other = MakeCertificate(folder.path(), "other", "DNS:localhost");
  const FakeServer server(&own);
  const Visionctl visionctl;
  const std::string address = server.Address();
  ExpectFailure(visionctl({"status", "--server", address}), 3, FingerprintOf(own.certificate));
  ExpectFailure(visionctl({"status", "--server", address, "--ca", other.certificate}), 3,
                "is not trusted");
  ExpectFailure(
      visionctl({"status", "--server", address, "--fingerprint", FingerprintOf(other.certificate)}),
      3, "has the fingerprint " + FingerprintOf(own.certificate));
}

TEST(VisionctlUsage, OptionsThatMakeNoSenseEndWithSix) {
  const Visionctl visionctl;
  ExpectFailure(visionctl({"status", "--server", "cell:port"}), 6, "HOST:PORT");
  ExpectFailure(visionctl({"status", "--fingerprint", "AB"}), 6, "64 hexadecimal digits");
  ExpectFailure(visionctl({"status", "--ca", "/no/such/file"}), 6, "/no/such/file");
  ExpectFailure(visionctl({"status", "--server", "192.0.2.1", "--plaintext"}), 6, "TLS");
  ExpectFailure(visionctl({"set", "stereo", "match.p2", "1", "match.p1"}), 6, "match.p1");
}

TEST(VisionctlUsage, ErrorsAreJsonWhenAskedFor) {
  const std::vector<std::vector<std::string>> no_sense = {
      {"frob", "--json"}, {"--json", "depth", "s", "--frames", "x"}};
  for (const std::vector<std::string>& wrong : no_sense) {
    const FinishedProcess usage = Visionctl()(wrong);
    EXPECT_EQ(2, usage.exit_code);
    EXPECT_THAT(usage.error_output, StartsWith("{\"code\":\"INVALID_ARGUMENT\""));
    EXPECT_THAT(usage.error_output, HasSubstr("\"reason\":\"USAGE\""));
  }
  const FinishedProcess done = Visionctl()({"status", "--server", "cell:port", "--json"});
  EXPECT_EQ(6, done.exit_code);
  EXPECT_THAT(done.error_output, StartsWith("{\"code\":\"INVALID_ARGUMENT\""));
}

}  // namespace
}  // namespace vs::test
