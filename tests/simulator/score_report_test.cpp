// SPDX-License-Identifier: BSD-3-Clause
// Latency and quantiles, and scores as text and JSON.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/score/report.h"
#include "tests/simulator/score_cases.h"

namespace simulator {
namespace {

using ladder_msgs::truth_t;
using ::testing::HasSubstr;
using ::testing::Not;

// Latency joins depth and rungs by utime; rungs without their depth frame are left out.
TEST(Scorer, Latency) {
  Scorer scorer;
  for (std::int64_t i = 0; i < 1000; ++i) {
    scorer.depth_frame_received(i, 1000 * i);
    scorer.rungs_received(i, 1000 * i + (i == 999 ? 50'000 : 9'000));
  }
  scorer.rungs_received(-7, 0);
  EXPECT_EQ(scorer.result().latency_ms_p50, 9.0);
  EXPECT_EQ(scorer.result().latency_ms_p99, 9.0);
  EXPECT_FALSE(Scorer().result().latency_ms_p99);
}

// Quantiles by nearest rank.
TEST(Quantile, Table) {
  EXPECT_FALSE(quantile({}, 0.5));
  EXPECT_EQ(quantile({3.0}, 0.95), 3.0);
  EXPECT_EQ(quantile({2.0, 1.0}, 0.5), 1.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.95), 3.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.0), 1.0);
}

// Without truth the JSON has no key that needs it; with truth it has, and unmeasured is null.
TEST(Report, KeysFollowTheTruth) {
  Scorer recording;
  recording.add(report(perfect()));
  EXPECT_THAT(to_json(recording.result()), Not(HasSubstr("recall")));
  EXPECT_THAT(to_json(recording.result()), HasSubstr("\"ladders_confirmed\": 1"));
  const std::string json = to_json(score_of(truth(), report({})));
  EXPECT_THAT(json, HasSubstr("\"recall\": 0"));
  EXPECT_THAT(json, HasSubstr("\"precision\": null"));
  EXPECT_THAT(json, HasSubstr("\"latency_ms_p50\": null"));
  EXPECT_THAT(json, HasSubstr("\"messages_lost\": 0"));
}

// A long list of bars does not swallow the lines behind it.
TEST(Report, LongListsStayLines) {
  Score score;
  score.bars_m = std::vector<double>(100, 1.23456);
  EXPECT_THAT(to_text(score), HasSubstr("1.23456] m\nlatency"));
}

// Text from a message cannot break the JSON.
TEST(Report, QuotesAreEscaped) {
  truth_t named = truth();
  named.scene = "a\"b\\c\n";
  EXPECT_THAT(to_json(score_of(named, report({}))), HasSubstr(R"("scene": "a\"b\\c ")"));
}

}  // namespace
}  // namespace simulator
