#include "server/sequences/sequence_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "server/storage/atomic_file.h"
#include "tests/engine/core/test_blocks.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using ::testing::HasSubstr;

class FixedClock final : public Clock {
 public:
  int64_t MonotonicNs() const override { return 1; }
  int64_t UtcNs() const override { return 1'700'000'000'000'000'000; }
};

SequenceSpec Spec(const std::string& id) {
  SequenceSpec spec;
  spec.id = id;
  spec.description = "Measures the \"gap\".";
  spec.blocks = {{"camera", "StereoCamera", {{"rate", 29.97}, {"name", std::string("left")}}}};
  return spec;
}

class SequenceStoreTest : public ::testing::Test {
 protected:
  std::unique_ptr<SequenceStore> Open() {
    auto store = SequenceStore::Open(folder_ / "sequences", clock_);
    EXPECT_TRUE(store.has_value()) << store.error().ToString();
    return store.has_value() ? std::move(*store) : nullptr;
  }
  std::filesystem::path File(const std::string& name) const { return folder_ / "sequences" / name; }
  static Status Describe(StoredSequence* stored, const std::string& text) {
    stored->spec.description = text;
    return Status();
  }

  test::TempFolder folder_;
  FixedClock clock_;
};

TEST_F(SequenceStoreTest, WhatWasStoredIsThereAfterARestart) {
  const StoredSequence made = Open()->Create(Spec("gap"), true, "anna").value();
  EXPECT_EQ(1u, made.revision);
  auto store = Open();
  const StoredSequence stored = store->Get("gap").value();
  EXPECT_EQ(Spec("gap"), stored.spec);
  EXPECT_TRUE(stored.autostart);
  EXPECT_EQ(1u, stored.revision);
  EXPECT_EQ("anna", stored.updated_by);
  EXPECT_EQ(1'700'000'000'000'000'000, stored.created_ns);
  EXPECT_EQ(made.etag, stored.etag);
  EXPECT_EQ(1u, store->List().size());
}

TEST_F(SequenceStoreTest, TheFileIsCanonicalJsonThatPeopleCanRead) {
  (void)Open()->Create(Spec("gap"), false, "anna");
  EXPECT_EQ(R"({
  "autostart": false,
  "created_ns": 1700000000000000000,
  "revision": 1,
  "sequence": {
    "blocks": [
      {
        "id": "camera",
        "params": {
          "name": "left",
          "rate": 29.97
        },
        "type": "StereoCamera",
        "x": 0.0,
        "y": 0.0
      }
    ],
    "connections": [],
    "description": "Measures the \"gap\".",
    "id": "gap",
    "max_frames_in_flight": 2,
    "priority": 0
  },
  "updated_by": "anna",
  "updated_ns": 1700000000000000000
}
)",
            ReadFile(File("gap.json"), 10'000).value());
}

TEST_F(SequenceStoreTest, EachChangeIsANewRevisionWithANewEtag) {
  auto store = Open();
  const StoredSequence first = store->Create(Spec("gap"), false, "anna").value();
  const StoredSequence second =
      store->Update("gap", first.etag, "ben", [](auto* s) { return Describe(s, "two"); }).value();
  EXPECT_EQ(2u, second.revision);
  EXPECT_EQ("ben", second.updated_by);
  EXPECT_NE(first.etag, second.etag);
  EXPECT_EQ("two", store->Get("gap").value().spec.description);
}

TEST_F(SequenceStoreTest, WhatMeansTheSameHasTheSameEtag) {
  auto store = Open();
  SequenceSpec spec = ChainSpec("gap", {"step"});
  spec.blocks.push_back({"limits", "TestLimits", {{"low", 5.0}}});
  const std::string etag = store->Create(spec, false, "anna").value().etag;
  ASSERT_TRUE(store->Delete("gap", etag).ok());
  SequenceSpec wordy = spec;
  wordy.blocks[1].params["offset"] = int64_t{0};
  wordy.blocks[2].params = {{"low", int64_t{5}}, {"high", 10.0}};
  const StoredSequence stored = store->Create(wordy, false, "anna").value();
  EXPECT_EQ(etag, stored.etag);
  EXPECT_EQ(spec, stored.spec);
  EXPECT_EQ(stored.etag, Open()->Get("gap").value().etag);
}

TEST_F(SequenceStoreTest, OfTwoEditorsOfOneRevisionOneIsTurnedAway) {
  auto store = Open();
  const std::string etag = store->Create(Spec("gap"), false, "anna").value().etag;
  ASSERT_TRUE(
      store->Update("gap", etag, "ben", [](auto* s) { return Describe(s, "ben's"); }).has_value());
  const auto late =
      store->Update("gap", etag, "anna", [](auto* s) { return Describe(s, "anna's"); });
  ASSERT_FALSE(late.has_value());
  EXPECT_EQ(StatusCode::kAborted, late.error().code());
  EXPECT_THAT(late.error().message(), HasSubstr("changed by ben"));
  EXPECT_EQ("ben's", store->Get("gap").value().spec.description);
  EXPECT_EQ(StatusCode::kAborted, store->Delete("gap", etag).code());
}

TEST_F(SequenceStoreTest, NoUpdateIsLostAmongManyWriters) {
  auto store = Open();
  (void)store->Create(Spec("gap"), false, "anna");
  std::atomic<int> accepted = 0;
  std::vector<std::thread> writers;
  writers.reserve(4);
  for (int i = 0; i < 4; ++i) {
    writers.emplace_back([&] {
      for (int n = 0; n < 25;) {
        const std::string etag = store->Get("gap").value().etag;
        const auto stored = store->Update("gap", etag, "w", [](StoredSequence* s) {
          s->spec.description += ".";
          return Status();
        });
        if (!stored.has_value()) continue;
        ++accepted;
        ++n;
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(100, accepted);
  const StoredSequence stored = Open()->Get("gap").value();
  EXPECT_EQ(101u, stored.revision);
  EXPECT_EQ(Spec("gap").description.size() + 100, stored.spec.description.size());
}

TEST_F(SequenceStoreTest, AChangeThatFailsStoresNothing) {
  auto store = Open();
  (void)store->Create(Spec("gap"), false, "anna");
  const auto updated = store->Update("gap", "", "ben", [](auto* s) {
    s->spec.description = "half";
    return InvalidArgument("no");
  });
  EXPECT_EQ("no", updated.error().message());
  EXPECT_EQ(1u, store->Get("gap").value().revision);
  EXPECT_EQ(Spec("gap"), store->Get("gap").value().spec);
}

TEST_F(SequenceStoreTest, WhenTheDiskRefusesTheOldRevisionStays) {
  auto store = Open();
  (void)store->Create(Spec("gap"), false, "anna");
  std::filesystem::create_directory(File("gap.json.new"));
  const auto updated =
      store->Update("gap", "", "ben", [](auto* s) { return Describe(s, "never"); });
  ASSERT_FALSE(updated.has_value());
  EXPECT_EQ(Spec("gap"), store->Get("gap").value().spec);
  EXPECT_EQ(Spec("gap"), Open()->Get("gap").value().spec);
}

TEST_F(SequenceStoreTest, BadIdsAndTakenIdsAreRefused) {
  auto store = Open();
  for (const char* id : {"", "Gap", "1gap", "../gap", "a b", "a.b"}) {
    EXPECT_EQ(StatusCode::kInvalidArgument, store->Create(Spec(id), false, "a").error().code())
        << id;
  }
  (void)store->Create(Spec("gap"), false, "anna");
  EXPECT_EQ(StatusCode::kAlreadyExists, store->Create(Spec("gap"), false, "b").error().code());
}

TEST_F(SequenceStoreTest, AMissingSequenceIsToldWithThoseThatThereAre) {
  auto store = Open();
  (void)store->Create(Spec("gap"), false, "anna");
  (void)store->Create(Spec("weld"), false, "anna");
  const Status missing = store->Get("gab").error();
  EXPECT_EQ(StatusCode::kNotFound, missing.code());
  EXPECT_THAT(missing.message(), HasSubstr("gap, weld"));
}

TEST_F(SequenceStoreTest, ADeletedSequenceStaysDeleted) {
  auto store = Open();
  (void)store->Create(Spec("gap"), false, "anna");
  ASSERT_TRUE(store->Delete("gap", "").ok());
  EXPECT_EQ(StatusCode::kNotFound, store->Delete("gap", "").code());
  EXPECT_TRUE(Open()->List().empty());
}

TEST_F(SequenceStoreTest, AFileWrittenByHandIsAccepted) {
  std::filesystem::create_directories(folder_ / "sequences");
  std::ofstream(File("gap.json")) << R"({"id": "gap", "blocks": [{"id": "a", "type": "B"}]})";
  std::ofstream(File("weld.json")) << R"({"autostart": true, "sequence": {"id": "weld"}})";
  auto store = Open();
  EXPECT_EQ("B", store->Get("gap").value().spec.blocks.at(0).type);
  EXPECT_FALSE(store->Get("gap").value().autostart);
  EXPECT_TRUE(store->Get("weld").value().autostart);
  EXPECT_EQ(1u, store->Get("weld").value().revision);
}

TEST_F(SequenceStoreTest, AFileThatCannotBeUnderstoodIsPutAsideAndTheOthersLoad) {
  (void)Open()->Create(Spec("good"), false, "anna");
  std::ofstream(File("cut.json")) << R"({"sequence": {"id": "cut")";
  std::ofstream(File("empty.json")) << "";
  std::ofstream(File("other.json")) << R"({"sequence": {"id": "name"}})";
  std::ofstream(File("extra.json")) << R"({"sequence": {"id": "extra"}, "revisoin": 3})";
  std::ofstream(File("zero.json")) << R"({"sequence": {"id": "zero"}, "revision": 0})";
  auto store = Open();
  ASSERT_EQ(1u, store->List().size());
  EXPECT_EQ("good", store->List()[0].spec.id);
  for (const char* name : {"cut", "empty", "other", "extra", "zero"}) {
    EXPECT_TRUE(std::filesystem::exists(File(std::string(name) + ".json.damaged-1"))) << name;
    EXPECT_FALSE(std::filesystem::exists(File(std::string(name) + ".json"))) << name;
  }
}

}  // namespace
}  // namespace vs
