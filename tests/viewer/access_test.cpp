// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using viewer::Access;
using viewer::judge;

constexpr const char* kToken = "0123456789abcdefXYZ_-";

// Without a token only names of this computer are served: any other name that leads here is a
// trick.
TEST(AccessTest, LocalNamesOnly) {
  for (const char* host : {"localhost", "localhost:8088", "127.0.0.1:8088", "[::1]:8088"}) {
    EXPECT_EQ(judge({.target = "/", .host = host}, ""), Access::kGranted) << host;
  }
  for (const char* host : {"", "evil.example:8088", "localhost.evil.example",
                           "127.0.0.1.evil.example", "localhostx", "[::1", "0.0.0.0:8088"}) {
    EXPECT_EQ(judge({.target = "/", .host = host}, ""), Access::kForeignSite) << host;
  }
}

// A page of another site cannot open the messages from the browser of a person who may, token or
// not.
TEST(AccessTest, ForeignPages) {
  const char* host = "127.0.0.1:8088";
  for (const char* origin : {"http://evil.example", "null", "http://127.0.0.1:9999",
                             "https://127.0.0.1:8088", "http://127.0.0.1:8088.evil.example"}) {
    EXPECT_EQ(judge({.target = "/messages", .host = host, .origin = origin}, ""),
              Access::kForeignSite)
        << origin;
    EXPECT_EQ(judge({"/messages?token=0123456789abcdefXYZ_-", host, origin, ""}, kToken),
              Access::kForeignSite)
        << origin;
  }
  EXPECT_EQ(judge({.target = "/messages", .host = host, .origin = "http://127.0.0.1:8088"}, ""),
            Access::kGranted);
}

// The token counts whole, as a query or as our cookie; parts, prefixes and other names do not.
TEST(AccessTest, Token) {
  const std::string token = kToken;
  const auto by_target = [&](const std::string& target) {
    return judge({.target = target, .host = "robot:8088"}, token);
  };
  const auto by_cookie = [&](const std::string& cookie) {
    return judge({.target = "/", .host = "robot:8088", .cookie = cookie}, token);
  };
  EXPECT_EQ(by_target("/?token=" + token), Access::kGranted);
  EXPECT_EQ(by_target("/?a=b&token=" + token + "&c=d"), Access::kGranted);
  EXPECT_EQ(by_cookie("ladder_token=" + token), Access::kGranted);
  EXPECT_EQ(by_cookie("other=1; ladder_token=" + token + "; more=2"), Access::kGranted);
  for (const std::string& target :
       {std::string("/"), std::string("/?token="), "/?xtoken=" + token, "/?token=" + token + "x",
        "/token=" + token, "/?token=" + token.substr(1)}) {
    EXPECT_EQ(by_target(target), Access::kNoToken) << target;
  }
  EXPECT_EQ(by_cookie("xladder_token=" + token), Access::kNoToken);
  EXPECT_EQ(by_cookie("ladder_token=;"), Access::kNoToken);
}

}  // namespace
