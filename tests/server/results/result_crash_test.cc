#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>
#include <thread>

#include "server/storage/sqlite.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

constexpr int kRounds = 20;

// The number in the last complete line "kept N".
int64_t LastKept(const std::string& output) {
  const size_t end = output.rfind('\n');
  if (end == std::string::npos) return 0;
  const size_t begin = output.rfind("kept ", end);
  return begin == std::string::npos ? 0 : std::atoll(output.c_str() + begin + 5);
}

TEST(ResultCrash, NothingThatWasAcknowledgedIsLostWhenTheProgramIsKilled) {
  test::TempFolder folder;
  const std::filesystem::path file = folder / "results.db";
  std::mt19937 random(1);
  std::uniform_int_distribution<int> delay_us(0, 60'000);
  int64_t rows_before = 0;
  for (int round = 0; round < kRounds; ++round) {
    auto program = test::ChildProcess::Start({VS_LOGGING_PROGRAM, file.string()});
    ASSERT_TRUE(program.has_value()) << program.error().ToString();
    ASSERT_TRUE((*program)->WaitForLine("kept ")) << (*program)->ErrorOutput();
    // Not to wait for anything: so that the blow falls at any point of a commit.
    std::this_thread::sleep_for(std::chrono::microseconds(delay_us(random)));
    (*program)->Kill();
    ASSERT_TRUE((*program)->WaitForExit());
    const int64_t acknowledged = LastKept((*program)->Output());
    ASSERT_GT(acknowledged, rows_before);

    auto database = Database::Open(file, Database::Access::kReadWrite);
    ASSERT_TRUE(database.has_value());
    auto check = database->Prepare("PRAGMA integrity_check");
    ASSERT_TRUE(check->Step().value());
    ASSERT_EQ("ok", check->Text(0)) << "round " << round;
    auto rows = database->Prepare("SELECT count(*), max(number) FROM result");
    ASSERT_TRUE(rows->Step().value());
    // Without gaps, so the count says that each single one is there.
    ASSERT_EQ(rows->Integer(0), rows->Integer(1)) << "round " << round;
    ASSERT_GE(rows->Integer(0), acknowledged) << "round " << round;
    rows_before = rows->Integer(0);
  }
  RecordProperty("rows", std::to_string(rows_before));
}

}  // namespace
}  // namespace vs
