#include "server/http/grpc_web.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vs {
namespace {

using std::chrono::nanoseconds;
using std::string_literals::operator""s;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string RefusalOf(const std::string& body) { return MessageOf(body).error().message(); }

TEST(GrpcWeb, KnowsItsContentType) {
  EXPECT_TRUE(IsGrpcWebType("application/grpc-web+proto"));
  EXPECT_TRUE(IsGrpcWebType("application/grpc-web"));
  EXPECT_TRUE(IsGrpcWebType("application/grpc-web+proto; charset=utf-8"));
  EXPECT_FALSE(IsGrpcWebType("application/grpc-web-text"));
  EXPECT_FALSE(IsGrpcWebType("application/grpc-web-text+proto"));
  EXPECT_FALSE(IsGrpcWebType("application/grpc"));
  EXPECT_FALSE(IsGrpcWebType("application/json"));
  EXPECT_FALSE(IsGrpcWebType(""));
}

TEST(GrpcWeb, TakesTheOneMessageOfARequest) {
  EXPECT_EQ(MessageOf("\0\0\0\0\0"s).value(), "");
  EXPECT_EQ(MessageOf("\0\0\0\0\5hello"s).value(), "hello");
  EXPECT_EQ(MessageOf("\0\0\1\0\0"s + std::string(65536, 'x')).value(), std::string(65536, 'x'));
}

TEST(GrpcWeb, RefusesWhatIsNotOneMessage) {
  EXPECT_THAT(RefusalOf(""), HasSubstr("has 0 bytes"));
  EXPECT_THAT(RefusalOf("\0\0\0\0"s), HasSubstr("has 4 bytes"));
  EXPECT_THAT(RefusalOf("\0\0\0\0\6hello"s), HasSubstr("announces 6 bytes and 5 follow"));
  EXPECT_THAT(RefusalOf("\0\0\0\0\4hello"s), HasSubstr("announces 4 bytes and 5 follow"));
  EXPECT_THAT(RefusalOf("\0\xff\xff\xff\xffhello"s), HasSubstr("announces 4294967295 bytes"));
  // Two messages.
  EXPECT_THAT(RefusalOf("\0\0\0\0\1a\0\0\0\0\1b"s), HasSubstr("send one frame"));
  // Trailers, and a flag that nobody knows.
  EXPECT_THAT(RefusalOf("\x80\0\0\0\0"s), HasSubstr("flags 128"));
  EXPECT_THAT(RefusalOf("\2\0\0\0\0"s), HasSubstr("flags 2"));
  EXPECT_EQ(MessageOf("\1\0\0\0\5hello"s).error().code(), StatusCode::kUnimplemented);
}

TEST(GrpcWeb, WritesTheLengthOfAMessageFourBytesLong) {
  EXPECT_EQ(MessagePrefix(0), "\0\0\0\0\0"s);
  EXPECT_EQ(MessagePrefix(0x01020304), "\0\1\2\3\4"s);
}

TEST(GrpcWeb, EndsAnAnswerWithItsStatus) {
  EXPECT_EQ(TrailerFrame(Status()), "\x80\0\0\0\x10grpc-status: 0\r\n"s);
  const std::string trailers = TrailerFrame(NotFound("100 % \xc3\xa4\r\nx: y"));
  EXPECT_THAT(trailers.substr(5), StartsWith("grpc-status: 5\r\n"
                                             "grpc-message: 100 %25 %C3%A4%0D%0Ax: y\r\n"
                                             "grpc-status-details-bin: CAUS"));
  // The length in the prefix is that of what follows.
  ASSERT_LT(trailers.size(), 5U + 65536U);
  EXPECT_EQ(trailers.substr(0, 3), "\x80\0\0"s);
  EXPECT_EQ(
      static_cast<unsigned char>(trailers[3]) * 256U + static_cast<unsigned char>(trailers[4]),
      trailers.size() - 5);
}

TEST(GrpcWeb, ReadsTimeouts) {
  EXPECT_FALSE(ParseTimeout("")->has_value());
  EXPECT_EQ(ParseTimeout("100m")->value(), nanoseconds(100'000'000));
  EXPECT_EQ(ParseTimeout("2H")->value(), nanoseconds(7'200'000'000'000));
  EXPECT_EQ(ParseTimeout("3M")->value(), nanoseconds(180'000'000'000));
  EXPECT_EQ(ParseTimeout("4S")->value(), nanoseconds(4'000'000'000));
  EXPECT_EQ(ParseTimeout("5u")->value(), nanoseconds(5'000));
  EXPECT_EQ(ParseTimeout("99999999n")->value(), nanoseconds(99'999'999));
  EXPECT_EQ(ParseTimeout("99999999H")->value(), nanoseconds(2'592'000'000'000'000));
}

TEST(GrpcWeb, RefusesWhatIsNoTimeout) {
  for (const char* wrong : {"100", "m", "-1S", "+1S", "1.5S", "1 S", "123456789n", "1s", "1S1"}) {
    const auto parsed = ParseTimeout(wrong);
    ASSERT_FALSE(parsed.has_value()) << wrong;
    EXPECT_THAT(parsed.error().message(), HasSubstr(wrong));
  }
}

}  // namespace
}  // namespace vs
