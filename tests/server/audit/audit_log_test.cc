#include "server/audit/audit_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "engine/base/str.h"
#include "tests/support/fake_clock.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

using std::chrono::hours;
using test::WaitUntil;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kLogin = "/visionserver.v1.SessionService/Login";
constexpr const char* kStart = "/visionserver.v1.SequenceService/StartSequence";
constexpr int64_t kNsPerDay = int64_t{24} * 3600 * 1'000'000'000;

Call CallOf(const std::string& user, const std::string& method, const std::string& subject) {
  Call call{.method = method, .address = "10.0.0.7", .subject = subject};
  if (!user.empty()) call.caller = {.kind = Caller::Kind::kUser, .name = user};
  return call;
}

class AuditLogTest : public ::testing::Test {
 protected:
  AuditLogTest() { Open({}); }

  void Open(AuditLimits limits) {
    log_.reset();
    log_ = *AuditLog::Open({.file = folder_ / "audit.db",
                            .limits = limits,
                            .is_user = [](const std::string& name) { return name == "maria"; },
                            .on_state = [this](const Status& status) { failing_ = !status.ok(); }},
                           clock_);
  }
  std::vector<AuditEntry> List(const AuditFilter& filter = {}) {
    return log_->store().List(filter, std::nullopt, 10'000)->entries;
  }
  std::vector<std::string> Subjects(const AuditFilter& filter = {}) {
    std::vector<std::string> subjects;
    for (const AuditEntry& entry : List(filter)) subjects.push_back(entry.subject);
    return subjects;
  }
  // Nobody else writes the file until this COMMITs.
  Database LockFile() {
    Database other = *Database::Open(folder_ / "audit.db", Database::Access::kReadWrite);
    other.SetBusyTimeout(std::chrono::minutes(1));  // the log may be at its first trim
    EXPECT_TRUE(other.Execute("BEGIN EXCLUSIVE").ok());
    return other;
  }
  bool WaitForEntries(size_t count) {
    return WaitUntil([&] { return List().size() == count; });
  }

  test::TempFolder folder_;
  test::FakeClock clock_;
  std::atomic<bool> failing_ = false;
  std::unique_ptr<AuditLog> log_;
};

TEST_F(AuditLogTest, RecordsWhatThePolicySaysChangesSomething) {
  EXPECT_TRUE(log_->Records(kLogin));
  EXPECT_TRUE(log_->Records(kStart));
  EXPECT_FALSE(log_->Records("/visionserver.v1.SequenceService/ListSequences"));
  EXPECT_FALSE(log_->Records("/no/such"));
}

TEST_F(AuditLogTest, KeepsWhoDidWhatFromWhereAndHowItEnded) {
  log_->Record(CallOf("maria", kStart, "stereo_depth"), Status());
  log_->Record(CallOf("ben", kStart, "other"), NotFound("there is no sequence other"));
  ASSERT_TRUE(WaitForEntries(2));
  const std::vector<AuditEntry> entries = List();
  EXPECT_EQ(entries[1].number, 1u);
  EXPECT_EQ(entries[1].time_utc_ns, clock_.UtcNs());
  EXPECT_EQ(entries[1].user, "maria");
  EXPECT_EQ(entries[1].address, "10.0.0.7");
  EXPECT_EQ(entries[1].method, kStart);
  EXPECT_EQ(entries[1].subject, "stereo_depth");
  EXPECT_TRUE(entries[1].ok);
  EXPECT_EQ(entries[1].message, "");
  EXPECT_FALSE(entries[0].ok);
  EXPECT_EQ(entries[0].message, "there is no sequence other");
}

TEST_F(AuditLogTest, OfALoginKeepsTheNameOnlyIfThereIsSuchAUser) {
  log_->Record(CallOf("", kLogin, "maria"), Unauthenticated("wrong"));
  log_->Record(CallOf("", kLogin, "my secret password"), Unauthenticated("wrong"));
  ASSERT_TRUE(WaitForEntries(2));
  EXPECT_EQ(List()[1].user, "maria");
  EXPECT_EQ(List()[0].user, "");
  EXPECT_THAT(Subjects(), ElementsAre("", ""));
}

TEST_F(AuditLogTest, FindsByUserMethodAndTime) {
  log_->Record(CallOf("maria", kStart, "one"), Status());
  ASSERT_TRUE(WaitForEntries(1));
  clock_.Advance(hours(1));
  const int64_t noon_ns = clock_.UtcNs();
  log_->Record(CallOf("ben", kStart, "two"), Status());
  log_->Record(CallOf("maria", "/visionserver.v1.UserService/DeleteUser", "three"), Status());
  ASSERT_TRUE(WaitForEntries(3));
  EXPECT_THAT(Subjects({.user = "MARIA"}), ElementsAre("three", "one"));
  EXPECT_THAT(Subjects({.user = "mari"}), ElementsAre());
  EXPECT_THAT(Subjects({.method = "startseq"}), ElementsAre("two", "one"));
  EXPECT_THAT(Subjects({.user = "maria", .method = "UserService"}), ElementsAre("three"));
  EXPECT_THAT(Subjects({.from_ns = noon_ns}), ElementsAre("three", "two"));
  EXPECT_THAT(Subjects({.until_ns = noon_ns}), ElementsAre("one"));

  const auto first = log_->store().List({}, std::nullopt, 2);
  EXPECT_TRUE(first->more);
  const auto second = log_->store().List({}, first->entries.back().number, 2);
  EXPECT_FALSE(second->more);
  ASSERT_EQ(second->entries.size(), 1u);
  EXPECT_EQ(second->entries[0].subject, "one");
}

TEST_F(AuditLogTest, SurvivesARestart) {
  for (int i = 0; i < 300; ++i) log_->Record(CallOf("maria", kStart, Str("s", i)), Status());
  Open({});  // what waited was written at the end
  EXPECT_EQ(List().size(), 300u);
  EXPECT_EQ(List()[0].subject, "s299");
}

TEST_F(AuditLogTest, KeepsNoMoreThanItsLimits) {
  for (int i = 0; i < 30; ++i) {
    log_->Record(CallOf("maria", kStart, Str("s", i)), Status());
    log_->Record(CallOf("", kLogin, "x"), Unauthenticated("wrong"));
  }
  Open({.keep_entries = 20});
  // 20 of those who are known, and 2 of strangers, who cannot push the others out.
  ASSERT_TRUE(WaitForEntries(22));
  EXPECT_EQ(Subjects({.user = "maria"}).size(), 20u);
  EXPECT_EQ(Subjects({.user = "maria"}).back(), "s10");
  clock_.Advance(hours(49));
  log_->Record(CallOf("maria", kStart, "new"), Status());
  Open({.keep_ns = 2 * kNsPerDay});
  ASSERT_TRUE(WaitForEntries(1));
  EXPECT_THAT(Subjects(), ElementsAre("new"));
  // A number is never used again.
  EXPECT_EQ(List()[0].number, 61u);
}

TEST_F(AuditLogTest, LosesNothingWhileTheFileCannotBeWritten) {
  Database other = LockFile();
  log_->Record(CallOf("maria", kStart, "one"), Status());
  EXPECT_TRUE(WaitUntil([&] { return failing_.load(); }));
  log_->Record(CallOf("maria", kStart, "two"), Status());
  ASSERT_TRUE(other.Execute("COMMIT").ok());
  EXPECT_TRUE(WaitUntil([&] { return !failing_; }));
  ASSERT_TRUE(WaitForEntries(2));
  EXPECT_THAT(Subjects(), ElementsAre("two", "one"));
}

TEST_F(AuditLogTest, CountsWhatItHadNoRoomFor) {
  Database other = LockFile();
  constexpr size_t kMore = 10;
  for (size_t i = 0; i < AuditLog::kMaxWaiting / 2 + kMore; ++i) {
    log_->Record(CallOf("", kLogin, "x"), Unauthenticated("wrong"));
  }
  log_->Record(CallOf("maria", kStart, "there is room for her"), Status());
  ASSERT_TRUE(other.Execute("COMMIT").ok());
  ASSERT_TRUE(WaitUntil([&] { return Subjects({.user = "maria"}).size() == 1; }));
  std::string told;
  for (const AuditEntry& entry : List()) {
    if (entry.method.empty()) told += entry.message;
  }
  EXPECT_THAT(told, HasSubstr("10 entries are missing here"));
}

}  // namespace
}  // namespace vs
