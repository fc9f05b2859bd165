// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/token.h"

#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace {

constexpr const char* kToken = "0123456789abcdefXYZ_-";

// A token that could be guessed, or would break a header, is refused with the way to make one.
TEST(TokenTest, File) {
  const std::string path = "/tmp/ladder-token-" + std::to_string(getpid());
  const auto read = [&](const std::string& content) {
    std::ofstream(path) << content;
    return runtime::read_token(path);
  };
  EXPECT_EQ(read(std::string(kToken) + "\nsecond line"), kToken);
  for (const char* bad : {"", "short", "0123456789abcdef;evil", "0123456789abcdef\r", "\n"}) {
    EXPECT_THROW(read(bad), std::runtime_error) << bad;
  }
  unlink(path.c_str());
  EXPECT_THROW(runtime::read_token("/no/such/file"), std::runtime_error);
}

// Only the whole token is the token.
TEST(TokenTest, Same) {
  EXPECT_TRUE(runtime::is_same_token("abc", "abc"));
  for (const char* other : {"", "ab", "abcd", "abd", "ABC"}) {
    EXPECT_FALSE(runtime::is_same_token(other, "abc")) << other;
  }
}

}  // namespace
