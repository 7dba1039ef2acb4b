#include "engine/base/str.h"

#include <gtest/gtest.h>

namespace vs {
namespace {

TEST(Quoted, KeepsReadableText) {
  EXPECT_EQ(Quoted("match"), "\"match\"");
  EXPECT_EQ(Quoted("Prüfung 3 µm"), "\"Prüfung 3 µm\"");
  EXPECT_EQ(Quoted("\xF0\x9F\x99\x82"), "\"\xF0\x9F\x99\x82\"");
}

TEST(Quoted, EscapesWhatWouldForgeALineOrBreakAMessage) {
  EXPECT_EQ(Quoted("a\nb\x7f"), "\"a\\x0ab\\x7f\"");
  EXPECT_EQ(Quoted(std::string_view("\0", 1)), "\"\\x00\"");
  EXPECT_EQ(Quoted("\xff"), "\"\\xff\"");
  EXPECT_EQ(Quoted("\xc3"), "\"\\xc3\"") << "cut short";
  EXPECT_EQ(Quoted("\xc0\xaf"), "\"\\xc0\\xaf\"") << "an overlong slash";
  EXPECT_EQ(Quoted("\xed\xa0\x80"), "\"\\xed\\xa0\\x80\"") << "a surrogate";
  EXPECT_EQ(Quoted("\xf4\x90\x80\x80"), "\"\\xf4\\x90\\x80\\x80\"") << "beyond U+10FFFF";
}

TEST(Quoted, CutsLongTextBetweenCharacters) {
  std::string long_text;
  for (int i = 0; i < 100; ++i) long_text += "é";
  std::string sixty;
  for (int i = 0; i < 60; ++i) sixty += "é";
  EXPECT_EQ(Quoted(long_text), "\"" + sixty + "...\"");
}

}  // namespace
}  // namespace vs
