// SPDX-License-Identifier: BSD-3-Clause
// What other programs rely on: fingerprints, bounds, channel names and numbers, causes of rejects.
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/channels.h"
#include "runtime/wire_guard.h"
#include "tests/lcmtypes/all_types.h"

namespace lcmtypes {
namespace {

std::string read_text(const std::string& path) {
  std::ifstream file(std::string(LADDER_SOURCE_DIR) + "/" + path);
  EXPECT_TRUE(file.good()) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The fingerprints that our generator computes are those of lcm-gen.
TEST(Fingerprints, AgreeWithLcmGen) {
  for_each_message_type([]<class Msg>(std::type_identity<Msg>) {
    const runtime::WireType& type = runtime::kWireTypeOf<Msg>;
    EXPECT_EQ(type.fingerprint, static_cast<std::uint64_t>(Msg::getHash())) << type.name;
    EXPECT_STREQ(type.name, Msg::getTypeName());
  });
}

// A released type is frozen: a change of any member shows here. (A new type: add its line.)
TEST(Fingerprints, ArePinned) {
  std::map<std::string, std::uint64_t> pinned, actual;
  std::istringstream lines(read_text("tests/lcmtypes/fingerprints.txt"));
  std::string name, fingerprint;
  while (lines >> name >> fingerprint) pinned[name] = std::stoull(fingerprint, nullptr, 16);
  for (const runtime::WireType* type : runtime::kWireTypes) actual[type->name] = type->fingerprint;
  EXPECT_EQ(actual, pinned);
}

// No two types can be taken for each other: names of structs are not part of a fingerprint.
TEST(Fingerprints, AreDistinct) {
  std::set<std::uint64_t> distinct;
  for (const runtime::WireType* type : runtime::kWireTypes) distinct.insert(type->fingerprint);
  EXPECT_EQ(distinct.size(), kNumTypes);
}

// Names start with LADDER_, have at most 63 characters and no regular-expression characters; names
// and numbers are unique; every type has a channel.
TEST(Channels, AreWellFormed) {
  std::set<std::string_view> names;
  std::set<std::int16_t> numbers;
  std::set<const runtime::WireType*> types;
  for (const runtime::ChannelInfo& channel : runtime::kChannels) {
    EXPECT_THAT(std::string(channel.name), ::testing::MatchesRegex("LADDER_[A-Z0-9_]+"));
    EXPECT_LE(channel.name.size(), 63U);
    EXPECT_EQ(runtime::find_channel(channel.name), &channel);
    names.insert(channel.name);
    numbers.insert(channel.number);
    types.insert(channel.type);
  }
  EXPECT_EQ(names.size(), runtime::kChannels.size());
  EXPECT_EQ(numbers.size(), runtime::kChannels.size());
  EXPECT_EQ(types.size(), kNumTypes);
  EXPECT_FALSE(numbers.contains(ladder_msgs::health_t::CHANNEL_UNKNOWN));
  EXPECT_EQ(runtime::find_channel("LADDER_TOF"), nullptr);
  EXPECT_EQ(runtime::find_channel(""), nullptr);
}

/// "3 145 878" of the fifth column of the README's row of this channel; "" without such a row.
std::string documented_bound(std::string_view channel) {
  std::istringstream lines(read_text("lcmtypes/README.md"));
  for (std::string line; std::getline(lines, line);) {
    if (line.find("| `" + std::string(channel) + "`") != 0) continue;
    std::istringstream cells(line);
    std::string cell;
    for (int column = 0; column <= 5; ++column) std::getline(cells, cell, '|');
    std::erase(cell, ' ');
    return cell;
  }
  return "";
}

// The bounds in lcmtypes/README.md are the generated ones.
TEST(Channels, BoundsAreDocumented) {
  for (const runtime::ChannelInfo& channel : runtime::kChannels) {
    const bool is_tof = channel.name.starts_with("LADDER_TOF_");
    EXPECT_EQ(documented_bound(is_tof ? "LADDER_TOF_0" : channel.name),
              std::to_string(channel.type->max_bytes))
        << channel.name;
  }
}

// Each cause of a reject has the counter of its name in health_t.
TEST(Rejects, MapOneToOneOnHealth) {
  std::set<std::string> causes, counters;
  for (int i = 1; i < runtime::kNumRejects; ++i) {
    causes.insert("rejected_" + std::string(runtime::name(static_cast<runtime::Reject>(i))));
  }
  for (const auto& field : runtime::kWireTypeOf<ladder_msgs::health_t>.fields) {
    if (std::string_view(field.name).starts_with("rejected_")) counters.insert(field.name);
  }
  EXPECT_EQ(causes, counters);
  EXPECT_EQ(causes.size(), static_cast<std::size_t>(runtime::kNumRejects - 1));
}

}  // namespace
}  // namespace lcmtypes
