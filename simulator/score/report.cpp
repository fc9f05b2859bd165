// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/score/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace simulator {
namespace {

std::string number(double value) {
  if (!std::isfinite(value)) return "null";
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

std::string to_value(double value) {
  return number(value);
}
std::string to_value(int value) {
  return std::to_string(value);
}
std::string to_value(std::int64_t value) {
  return std::to_string(value);
}
std::string to_value(bool value) {
  return value ? "true" : "false";
}

std::string to_value(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + '"';
}

std::string to_value(const std::vector<double>& values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + number(value);
  return text + "]";
}

std::string to_value(const std::map<std::string, std::int64_t>& counts) {
  std::string text = "{";
  for (const auto& [name, count] : counts) {
    text += (text.size() > 1 ? ", " : "") + to_value(name) + ": " + std::to_string(count);
  }
  return text + "}";
}

template <class T>
std::string to_value(const std::optional<T>& value) {
  return value ? to_value(*value) : "null";
}

std::int64_t sum(const std::map<std::string, std::int64_t>& counts) {
  std::int64_t total = 0;
  for (const auto& [name, count] : counts) total += count;
  return total;
}

class Object {
 public:
  template <class T>
  void add(const char* key, const T& value) {
    text_ += text_.empty() ? "{\n  \"" : ",\n  \"";
    text_ += key;
    text_ += "\": " + to_value(value);
  }
  std::string text() const { return text_ + "\n}\n"; }

 private:
  std::string text_;
};

void add_truth_keys(Object& object, const Score& score) {
  object.add("scene", score.scene);
  object.add("rungs_true", score.rungs_true);
  object.add("rungs_wrong", score.rungs_wrong);
  object.add("recall", score.recall);
  object.add("precision", score.precision);
  object.add("recall_all_frames", score.recall_all_frames);
  object.add("precision_all_frames", score.precision_all_frames);
  object.add("false_ladders", score.false_ladders);
  object.add("axis_error_mm_p50", score.axis_error_mm_p50);
  object.add("axis_error_mm_p95", score.axis_error_mm_p95);
  object.add("depth_error_mm_p50", score.depth_error_mm_p50);
  object.add("angle_error_deg_p50", score.angle_error_deg_p50);
  object.add("angle_error_deg_p95", score.angle_error_deg_p95);
  object.add("end_error_mm_p50", score.end_error_mm_p50);
  object.add("end_error_mm_p95", score.end_error_mm_p95);
  object.add("axis_errors_mm", score.axis_errors_mm);
  object.add("depth_errors_mm", score.depth_errors_mm);
  object.add("angle_errors_deg", score.angle_errors_deg);
  object.add("end_errors_mm", score.end_errors_mm);
  object.add("frames_to_first_rung", score.frames_to_first_rung);
  object.add("frames_to_all_rungs", score.frames_to_all_rungs);
  object.add("radius_error_p50", score.radius_error_p50);
  object.add("radius_error_p95", score.radius_error_p95);
  object.add("radius_errors", score.radius_errors);
  object.add("grasps_offered", score.grasps_offered);
  object.add("unsafe_grasps", score.unsafe_grasps);
  object.add("identity_switches", score.identity_switches);
  object.add("rungs_removed", score.rungs_removed);
  object.add("removals_noticed_s", score.removals_noticed_s);
  object.add("nodes_on_ladder_share", score.nodes_on_ladder_share);
}

/// "name   value" for people; a dash for what was not measured.
template <class T>
std::string line(const char* name, const T& value, const char* unit = "") {
  std::string shown = to_value(value);
  if (shown == "null") shown = "-";
  constexpr std::size_t kColumn = 35;
  std::string text = name;
  text.resize(std::max(text.size(), kColumn), ' ');
  return text + shown + (*unit != '\0' ? " " : "") + unit + "\n";
}

}  // namespace

std::string to_json(const Score& score) {
  Object object;
  object.add("has_truth", score.has_truth);
  object.add("frames", score.frames);
  object.add("rungs_confirmed", score.rungs_confirmed);
  object.add("rungs_candidates", score.rungs_candidates);
  object.add("ladders_confirmed", score.ladders_confirmed);
  if (score.has_truth) add_truth_keys(object, score);
  object.add("nodes", score.nodes);
  object.add("edges", score.edges);
  object.add("faces", score.faces);
  object.add("nodes_unknown", score.nodes_unknown);
  object.add("nodes_safe_ground", score.nodes_safe_ground);
  object.add("nodes_wall", score.nodes_wall);
  object.add("nodes_obstacle", score.nodes_obstacle);
  object.add("floor_area_m2", score.floor_area_m2);
  object.add("wall_area_m2", score.wall_area_m2);
  object.add("bars_m", score.bars_m);
  object.add("latency_ms_p50", score.latency_ms_p50);
  object.add("latency_ms_p99", score.latency_ms_p99);
  object.add("compute_ms_p50", score.compute_ms_p50);
  object.add("compute_ms_p95", score.compute_ms_p95);
  object.add("compute_ms", score.compute_ms);
  object.add("messages", score.messages);
  object.add("messages_lost", sum(score.messages_lost));
  object.add("messages_lost_by_channel", score.messages_lost);
  return object.text();
}

std::string to_text(const Score& score) {
  std::string text = line("frames of LADDER_RUNGS", score.frames);
  if (score.has_truth) {
    text += line("scene", score.scene);
    text += line("true rungs in view (last frame)", score.rungs_true);
  } else {
    text += "no truth: a recording, or no simulator was heard\n";
  }
  text += line("confirmed rungs (last frame)", score.rungs_confirmed);
  text += line("candidates (last frame)", score.rungs_candidates);
  text += line("frames with a confirmed ladder", score.ladders_confirmed);
  if (score.has_truth) {
    text += line("recall", score.recall);
    text += line("precision", score.precision);
    text += line("false ladders (frames)", score.false_ladders);
    text += line("axis error p50", score.axis_error_mm_p50, "mm");
    text += line("axis error p95", score.axis_error_mm_p95, "mm");
    text += line("depth error p50 (+ = too far)", score.depth_error_mm_p50, "mm");
    text += line("angle error p50", score.angle_error_deg_p50, "deg");
    text += line("end error p50", score.end_error_mm_p50, "mm");
    text += line("radius error p50", score.radius_error_p50, "of the radius");
    text += line("offered grasps (all frames)", score.grasps_offered);
    text += line("unsafe ones among them", score.unsafe_grasps);
    text += line("identity switches", score.identity_switches);
    text += line("frames to the first rung", score.frames_to_first_rung);
    text += line("frames to all rungs", score.frames_to_all_rungs);
    text += line("share of nodes on the ladder", score.nodes_on_ladder_share);
  }
  text += line("nodes", score.nodes);
  text += line("floor", score.floor_area_m2, "m2");
  text += line("wall", score.wall_area_m2, "m2");
  text += line("bars above the floor", score.bars_m, "m");
  text += line("latency depth -> rungs p50", score.latency_ms_p50, "ms");
  text += line("latency depth -> rungs p99", score.latency_ms_p99, "ms");
  text += line("messages lost", sum(score.messages_lost));
  return text;
}

}  // namespace simulator
