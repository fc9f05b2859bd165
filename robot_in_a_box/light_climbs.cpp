// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/light_climbs.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>

#include "robot_in_a_box/fork_pool.h"

namespace robot_in_a_box {
namespace {

/// What a copy hands back, as bytes.
struct Outcome {
  LightEnd end{};
  int rungs_climbed = 0;
  std::int64_t duration_us = 0;
  std::uint64_t frame_hash = 0;
  std::int64_t num_targets = 0;
  std::int64_t num_violations = 0;
  std::array<char, 40> reason{};
  std::array<char, 200> first_violation{};
};

template <std::size_t kSize>
void put(const std::string& text, std::array<char, kSize>& into) {
  std::strncpy(into.data(), text.c_str(), kSize - 1);
}

std::string climb(const LightClimbParams& params) {
  ClimbBox box(light_box_params(params));
  const LightResult result = run_light_climb(params, box);
  Outcome outcome;
  outcome.end = result.end;
  outcome.rungs_climbed = result.rungs_climbed;
  outcome.duration_us = result.duration_us;
  outcome.frame_hash = box.frame_hash();
  outcome.num_targets = box.monitor().num_targets();
  outcome.num_violations = box.monitor().num_violations();
  put(result.reason, outcome.reason);
  const auto& violations = box.monitor().violations();
  if (!violations.empty()) put(describe(violations.front()), outcome.first_violation);
  return {reinterpret_cast<const char*>(&outcome), sizeof(outcome)};
}

void take(bool ended_well, const std::string& bytes, LightScore& score) {
  Outcome outcome;
  if (!ended_well || bytes.size() != sizeof(outcome)) {
    score.num_violations = 1;
    score.first_violation = "the program crashed";
    return;
  }
  std::memcpy(&outcome, bytes.data(), sizeof(outcome));
  score.end = outcome.end;
  score.reason = outcome.reason.data();
  score.rungs_climbed = outcome.rungs_climbed;
  score.seconds = 1e-6 * static_cast<double>(outcome.duration_us);
  score.frame_hash = outcome.frame_hash;
  score.num_targets = outcome.num_targets;
  score.num_violations = outcome.num_violations;
  score.first_violation = outcome.first_violation.data();
}

using Ends = std::map<std::string, int>;

Ends ends_of(const std::vector<LightScore>& scores) {
  Ends ends;
  for (const LightScore& score : scores) {
    const std::string why = score.reason.empty() ? "" : ": " + score.reason;
    ++ends[name(score.end) + why];
  }
  return ends;
}

}  // namespace

std::vector<LightScore> run_light_climbs(std::uint64_t first_seed, int num_climbs, int num_jobs,
                                         const LightClimbParams& base) {
  std::vector<LightScore> scores(static_cast<std::size_t>(num_climbs));
  ForkPool pool(num_jobs);
  for (std::size_t i = 0; i < scores.size(); ++i) {
    LightClimbParams params = base;
    params.seed = scores[i].seed = first_seed + i;
    pool.run([params] { return climb(params); },
             [&scores, i](bool ended_well, const std::string& bytes) {
               take(ended_well, bytes, scores[i]);
             });
  }
  pool.finish();
  return scores;
}

std::int64_t num_violated(const std::vector<LightScore>& scores) {
  return std::count_if(scores.begin(), scores.end(),
                       [](const LightScore& score) { return score.num_violations > 0; });
}

void print(const std::vector<LightScore>& scores) {
  int rungs = 0;
  std::int64_t targets = 0;
  double seconds = 0.0;
  for (const LightScore& score : scores) {
    rungs += score.rungs_climbed;
    targets += score.num_targets;
    seconds += score.seconds;
    if (score.num_violations == 0) continue;
    std::printf("seed %llu, frames %016llx: %s\n", static_cast<unsigned long long>(score.seed),
                static_cast<unsigned long long>(score.frame_hash), score.first_violation.c_str());
  }
  for (const auto& [words, number] : ends_of(scores))
    std::printf("%6d %s\n", number, words.c_str());
  std::printf(
      "light climbs: %zu, %d rungs, %.1f simulated hours, %lld targets checked, %lld with a "
      "violated invariant\n",
      scores.size(), rungs, seconds / 3600.0, static_cast<long long>(targets),
      static_cast<long long>(num_violated(scores)));
}

bool write_json(const std::vector<LightScore>& scores, const std::string& path) {
  std::ofstream out(path);
  out << "{\n  \"climbs\": " << scores.size() << ",\n  \"violated\": " << num_violated(scores)
      << ",\n  \"ends\": {";
  const char* separator = "";
  for (const auto& [words, number] : ends_of(scores)) {
    out << separator << "\"" << words << "\": " << number;
    separator = ", ";
  }
  out << "},\n  \"seeds\": [\n";
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const LightScore& score = scores[i];
    out << "    {\"seed\": " << score.seed << ", \"end\": \"" << name(score.end)
        << "\", \"reason\": \"" << score.reason << "\", \"rungs_climbed\": " << score.rungs_climbed
        << ", \"seconds\": " << score.seconds << ", \"violations\": " << score.num_violations
        << ", \"first_violation\": \"" << score.first_violation << "\"}"
        << (i + 1 < scores.size() ? ",\n" : "\n");
  }
  out << "  ]\n}\n";
  return static_cast<bool>(out.flush());
}

}  // namespace robot_in_a_box
