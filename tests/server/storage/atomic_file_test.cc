#include "server/storage/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>

#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using ::testing::HasSubstr;

TEST(AtomicFile, WhatWasWrittenIsReadBack) {
  test::TempFolder folder;
  const std::string text("two\nlines\0and a zero", 20);
  ASSERT_TRUE(WriteFileAtomically(folder / "a.json", "old").ok());
  ASSERT_TRUE(WriteFileAtomically(folder / "a.json", text).ok());
  EXPECT_EQ(text, ReadFile(folder / "a.json", 100).value());
  EXPECT_EQ(StatusCode::kResourceExhausted, ReadFile(folder / "a.json", 19).error().code());
  EXPECT_EQ(1, std::distance(std::filesystem::directory_iterator(folder.path()), {}));
}

TEST(AtomicFile, AFailedWriteLeavesTheOldFile) {
  test::TempFolder folder;
  ASSERT_TRUE(WriteFileAtomically(folder / "a.json", "old").ok());
  // The draft cannot be made where a folder of its name is.
  std::filesystem::create_directory(folder / "a.json.new");
  const Status status = WriteFileAtomically(folder / "a.json", "new");
  EXPECT_EQ(StatusCode::kFailedPrecondition, status.code());
  EXPECT_THAT(status.message(), HasSubstr("a.json.new"));
  EXPECT_EQ("old", ReadFile(folder / "a.json", 100).value());
}

TEST(AtomicFile, MissingFilesAreNamed) {
  test::TempFolder folder;
  EXPECT_EQ(StatusCode::kNotFound, ReadFile(folder / "none", 100).error().code());
  EXPECT_EQ(StatusCode::kNotFound, RemoveFile(folder / "none").code());
  EXPECT_EQ(StatusCode::kNotFound, WriteFileAtomically(folder / "none" / "a", "x").code());
}

TEST(AtomicFile, DamagedFilesArePutAsideUnderFreshNames) {
  test::TempFolder folder;
  for (const char* text : {"first", "second"}) {
    ASSERT_TRUE(WriteFileAtomically(folder / "a.json", text).ok());
    ASSERT_TRUE(PutAside(folder / "a.json").has_value());
  }
  EXPECT_EQ("first", ReadFile(folder / "a.json.damaged-1", 100).value());
  EXPECT_EQ("second", ReadFile(folder / "a.json.damaged-2", 100).value());
  EXPECT_FALSE(std::filesystem::exists(folder / "a.json"));
}

}  // namespace
}  // namespace vs
