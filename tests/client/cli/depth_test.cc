// Depth and results of a running sequence by visionctl on a whole server.
#include <csignal>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/client/cli/server_fixture.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

using nlohmann::json;
using ::testing::AnyOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class VisionctlDepth : public VisionctlTest {
 protected:
  VisionctlDepth() { StartSimulation(); }
};

TEST_F(VisionctlDepth, IsWrittenWithWhatBelongsToIt) {
  const TempFolder folder;
  const std::string out = folder / "new folder";
  for (const char* codec : {"rvl", "rvl+zstd", "raw"}) {
    EXPECT_THAT(Succeed({"depth", "sim", "--frames", "2", "--out", out, "--codec", codec}),
                HasSubstr("2 frames"));
  }
  EXPECT_GT(std::filesystem::file_size(out + "/frame_000002.png"), 1000U);
  std::ifstream file(out + "/frame_000002.json");
  const json frame = json::parse(file);
  EXPECT_EQ("sim/depth", frame.at("stream"));
  EXPECT_EQ(130, frame.at("width"));
  EXPECT_EQ(97, frame.at("height"));
  EXPECT_GT(frame.at("valid_share"), 0.5);
  EXPECT_GT(frame.at("latency_ms"), 0);
  EXPECT_GT(frame.at("geometry").at("focal_px"), 50);
  EXPECT_GT(frame.at("geometry").at("baseline_m"), 0.01);
  EXPECT_EQ(0, frame.at("clipped_pixels"));
  EXPECT_FALSE(frame.at("stages").empty());
}

TEST_F(VisionctlDepth, IsMeasured) {
  const json all = json::parse(Succeed({"depth", "sim", "--frames", "6", "--stats", "--json"}));
  EXPECT_EQ(6, all.at("frames"));
  EXPECT_GT(all.at("fps"), 0);
  EXPECT_GT(all.at("latency_p50_ms"), 0);
  EXPECT_LE(all.at("latency_p50_ms"), all.at("latency_p95_ms"));
  EXPECT_LE(all.at("latency_p95_ms"), all.at("latency_p99_ms"));
  EXPECT_GT(all.at("bytes"), 1000);
  EXPECT_EQ(0, all.at("reconnects"));
}

TEST_F(VisionctlDepth, IsReceivedUntilInterrupted) {
  const auto running = visionctl_.Start({"depth", "sim", "--frames", "0", "--stats"});
  ASSERT_TRUE(running->WaitForLine(" fps, latency p50 ")) << running->ErrorOutput();
  running->Signal(SIGINT);
  ASSERT_EQ(0, running->WaitForExit()) << running->ErrorOutput();
  EXPECT_THAT(running->Output(), ContainsRegex("all [0-9]+ frames: [0-9.]+ fps"));
}

TEST_F(VisionctlDepth, SaysWhyThereIsNone) {
  EXPECT_THAT(Fail(5, {"depth", "nothing"}), HasSubstr("nothing"));
  EXPECT_THAT(Fail(5, {"depth", "sim", "--stream", "missing"}),
              HasSubstr("sim has no stream \"missing\"; there are depth"));
  Succeed({"sequences", "stop", "sim"});
  EXPECT_THAT(Fail(8, {"depth", "sim"}), HasSubstr("visionctl sequences start sim"));
}

// The simulation makes one pair in fifty seconds: after the first there is time to wait for
// nothing.
TEST_F(VisionctlDepth, IsWaitedForNoLongerThanAsked) {
  std::string slow = SimulatedSequence("slow");
  slow.replace(slow.find("5.0"), 3, "0.001");
  Succeed({"sequences", "create", "--file", "-"}, slow);
  Succeed({"sequences", "start", "slow"});
  EXPECT_THAT(Fail(7, {"depth", "slow", "--frames", "5", "--timeout", "0.5"}),
              HasSubstr("no depth came within 0.5 s"));
  // With or without the first frame, whichever is quicker.
  EXPECT_THAT(visionctl_({"depth", "slow", "--duration", "0.5", "--timeout", "3600"}).exit_code,
              AnyOf(0, 7));
}

TEST_F(VisionctlDepth, IsReceivedForAsLongAsAsked) {
  const TempFolder folder;
  const auto running =
      visionctl_.Start({"depth", "sim", "--duration", "3600", "--out", folder.path()});
  EXPECT_TRUE(WaitUntil([&] { return std::filesystem::exists(folder / "frame_000002.png"); }));
  running->Signal(SIGINT);
  EXPECT_EQ(0, running->WaitForExit()) << running->ErrorOutput();
}

TEST_F(VisionctlDepth, IsListedAmongTheStreams) {
  Succeed({"depth", "sim"});
  EXPECT_THAT(Succeed({"streams", "list"}), ContainsRegex("sim/depth +disparity +130x97 +[1-9]"));
}

TEST_F(VisionctlDepth, LeavesResultsThatAreFollowedAskedForAndExported) {
  const std::string followed = Succeed({"results", "tail", "--after", "0", "--lines", "2"});
  EXPECT_THAT(followed, StartsWith("1  20"));
  EXPECT_THAT(followed, ContainsRegex("\n2  20.*  sim  pass  valid_percent=[0-9.]+\n"));
  const std::string line =
      Succeed({"results", "tail", "--lines", "1", "--sequence", "sim", "--json"});
  EXPECT_EQ("sim", json::parse(line).at("job_id"));

  EXPECT_THAT(Succeed({"results", "query",
                       // NOLINTNEXTLINE(bugprone-suspicious-missing-comma): one long statement.
                       "SELECT number, job_id FROM result WHERE job_id = ?1 ORDER BY number "
                       "LIMIT 1",
                       "--arg", "sim"}),
              ContainsRegex("number +job_id\n1 +sim\n"));
  EXPECT_THAT(Fail(6, {"results", "query", "DELETE FROM result"}), HasSubstr("only a SELECT"));
  EXPECT_THAT(Fail(6, {"results", "query", "SELECT nonsense FROM result"}), HasSubstr("nonsense"));

  const TempFolder folder;
  Succeed({"results", "export", "--sequence", "sim", "--out", folder / "r.csv"});
  std::ifstream file(folder / "r.csv");
  std::string heading;
  std::string first;
  ASSERT_TRUE(std::getline(file, heading) && std::getline(file, first));
  EXPECT_THAT(heading, HasSubstr("job_id"));
  EXPECT_THAT(first, HasSubstr("sim"));
  EXPECT_THAT(Fail(6, {"results", "export", "--from", "yesterday"}), HasSubstr("yesterday"));
  EXPECT_THAT(Fail(1, {"results", "export", "--out", "/no/such/folder/r.csv"}),
              HasSubstr("cannot write"));
}

TEST_F(VisionctlDepth, LeavesNoResultsOfASequenceThatIsNotThere) {
  EXPECT_THAT(Fail(5, {"results", "tail", "--sequence", "nope"}), HasSubstr("nope"));
}

TEST_F(VisionctlDepth, StopsFollowingResultsWhenInterrupted) {
  const auto running = visionctl_.Start({"results", "tail"});
  ASSERT_TRUE(running->WaitForLine("valid_percent=")) << running->ErrorOutput();
  running->Signal(SIGINT);
  EXPECT_EQ(0, running->WaitForExit()) << running->ErrorOutput();
}

}  // namespace
}  // namespace vs::test
