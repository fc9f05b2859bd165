// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/config.h"

#include <cstdio>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using runtime::Config;
using runtime::ConfigError;
using ::testing::HasSubstr;

std::string write_file(const std::string& name, const std::string& text) {
  const std::string path = ::testing::TempDir() + name;
  std::ofstream(path) << text;
  return path;
}

template <class Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

// Without a file every default stays.
TEST(Config, NothingGivenKeepsDefaults) {
  const Config config = Config::load({}, {});
  int value = 7;
  config.table("gng").table("growing").read("max_nodes", value, {1, 10});
  EXPECT_EQ(value, 7);
  EXPECT_EQ(config.resolved(), "gng.growing.max_nodes = 7\n");
}

// A later file wins over an earlier one, an override over both, key by key.
TEST(Config, LaterWins) {
  const std::string first = write_file("first.toml", "[gng]\na = 1\nb = 1\nc = 1\n");
  const std::string second = write_file("second.toml", "[gng]\nb = 2\nc = 2\n");
  const Config config = Config::load({first, second}, {"gng.c=3"});
  int a = 0, b = 0, c = 0;
  runtime::ConfigTable table = config.table("gng");
  table.read("a", a);
  table.read("b", b);
  table.read("c", c);
  EXPECT_EQ(a * 100 + b * 10 + c, 123);
}

// A missing file is an error that names it.
TEST(Config, MissingFile) {
  EXPECT_THAT(error_of([] { Config::load({"/no/such.toml"}, {}); }), HasSubstr("/no/such.toml"));
}

// A syntax error names file and line.
TEST(Config, SyntaxErrorNamesTheLine) {
  const std::string path = write_file("syntax.toml", "[gng]\na = 1\nb = = 2\n");
  EXPECT_THAT(error_of([&] { Config::load({path}, {}); }), HasSubstr(path + ":3"));
}

// A key that nobody reads is an error that names place, key and what is known there.
TEST(Config, UnreadKey) {
  const std::string path = write_file("unread.toml", "[gng]\nnodes = 1\nnodez = 2\n");
  const Config config = Config::load({path}, {});
  int nodes = 0;
  config.table("gng").read("nodes", nodes);
  const std::string error = error_of([&] { config.check_all_read({"gng"}, {"gng"}); });
  EXPECT_THAT(error, HasSubstr(path + ":3"));
  EXPECT_THAT(error, HasSubstr("gng.nodez"));
  EXPECT_THAT(error, HasSubstr("known there: nodes"));
}

// A mistyped table is found even though no service owns it; another service's table is left alone.
TEST(Config, UnknownTable) {
  const Config config = Config::load({}, {"gngg.a=1", "ladder.b=1"});
  EXPECT_THAT(error_of([&] {
                config.check_all_read({"gng"}, {"gng", "ladder"});
              }),
              HasSubstr("gngg"));
  EXPECT_EQ(error_of([&] {
              config.check_all_read({"gng"}, {"gng", "ladder", "gngg"});
            }),
            "no error");
}

// Out of range, wrong type, not finite, unknown choice, wrong array length: each is refused, none
// is bent into shape.
TEST(Config, WrongValues) {
  const Config config =
      Config::load({}, {"t.i=11", "t.f=1.5", "t.s='x'", "t.n=nan", "t.a=[1, 2]", "t.b=1"});
  runtime::ConfigTable table = config.table("t");
  int integer = 0;
  double number = 0.0;
  bool flag = false;
  std::array<double, 3> three{};
  EXPECT_THAT(error_of([&] {
                table.read("i", integer, {0, 10});
              }),
              HasSubstr("t.i = 11 is outside 0 .. 10"));
  EXPECT_THAT(error_of([&] { table.read("f", integer); }), HasSubstr("whole number"));
  EXPECT_THAT(error_of([&] { table.read("s", number); }), HasSubstr("must be a number"));
  EXPECT_THAT(error_of([&] { table.read("n", number); }), HasSubstr("finite"));
  EXPECT_THAT(error_of([&] { table.read("b", flag); }), HasSubstr("true or false"));
  EXPECT_THAT(error_of([&] { table.read("a", three); }), HasSubstr("needs 3 numbers"));
  EXPECT_THAT(error_of([&] {
                table.read("s", integer, {{"one", 1}, {"two", 2}});
              }),
              HasSubstr("one of one, two"));
}

// An override that is no assignment is refused with the form it should have.
TEST(Config, OverrideForm) {
  EXPECT_THAT(error_of([] { Config::load({}, {"gng.seed"}); }), HasSubstr("table.key=value"));
}

// A bare word in an override is a string, so that --set ladder.mode=paper needs no quotes.
TEST(Config, BareWordIsAString) {
  const Config config = Config::load({}, {"ladder.mode=paper"});
  std::string mode;
  config.table("ladder").read("mode", mode);
  EXPECT_EQ(mode, "paper");
}

// The hash depends on values alone: the same values from a file or from defaults give the same
// hash, another value another.
TEST(Config, HashFollowsValues) {
  const auto hash_with = [](const std::vector<std::string>& overrides) {
    const Config config = Config::load({}, overrides);
    float value = 0.1F;
    config.table("gng").read("eta", value);
    return config.hash();
  };
  EXPECT_EQ(hash_with({}), hash_with({"gng.eta=0.1"}));
  EXPECT_NE(hash_with({}), hash_with({"gng.eta=0.2"}));
}

// A violated relation between parameters names the table, and the place where a file or --set gave
// one of them.
TEST(Config, Require) {
  const Config defaults = Config::load({}, {});
  EXPECT_EQ(error_of([&] { defaults.table("gng").require(""); }), "no error");
  EXPECT_THAT(error_of([&] { defaults.table("gng").require("a must be below b"); }),
              HasSubstr("[gng]: a must be below b"));
  const std::string path = write_file("relation.toml", "[gng]\n\nb = 2\n");
  const Config given = Config::load({path}, {});
  EXPECT_THAT(error_of([&] { given.table("gng").require("a must be below b"); }),
              HasSubstr(path + ":3: gng.b"));
}

}  // namespace
