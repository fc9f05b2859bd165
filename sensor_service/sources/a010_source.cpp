// SPDX-License-Identifier: BSD-3-Clause
#include "sources/a010_source.h"

#include <algorithm>

#include "sources/arrived_frames.h"
#include "sources/device_time.h"

namespace sources {
namespace {

constexpr int kNumNumbers = 4096;  // a unit's image numbers before they begin anew

}  // namespace

A010Source::A010Source(const SourceParams& params, ReadySet& ready) : ready_(ready) {
  heads_.reserve(params.heads.size());
  for (int index = 0; index < tof::kNumHeads; ++index) {
    if (params.heads[index].device.empty()) continue;
    Head& head = heads_.emplace_back();
    head.device = params.heads[index].device;
    head.unit = std::make_unique<A010Head>(params.a010, params.camera.frames_per_s);
    head.frame = frame_of_head(params, index);
    head.frame.width_px = head.frame.height_px = head.unit->side_px();
    head.frame.depth_mm = head.unit->depth_mm();
    head.frame.seq = -1;
  }
}

void A010Source::poll(const base::Now& now, FrameSink& sink) {
  ArrivedFrames arrived;
  for (Head& head : heads_) {
    work(head, now, sink);
    if (take(head, now, sink)) arrived.add(head.frame);
  }
  arrived.hand_to(sink);
}

void A010Source::work(Head& head, const base::Now& now, FrameSink& sink) {
  std::string problem;
  if (head.unit->is_open()) {
    problem = head.unit->work(now.monotonic_us);
  } else if (head.reopening.is_due(now.monotonic_us)) {
    head.is_first = true;
    problem = head.unit->open(head.device, now.monotonic_us);
    if (problem.empty()) ready_.add(head.unit->fd());
  }
  if (!problem.empty() && head.reopening.failed(now.monotonic_us, problem))
    sink.on_device(false, name_of_head(head.frame.head, head.device) + problem);
}

bool A010Source::take(Head& head, const base::Now& now, FrameSink& sink) {
  const int last_number = head.stamp.number;
  if (!head.unit->take(head.stamp)) return false;
  if (head.is_first) {
    head.is_first = false;
    head.reopening.succeeded();
    ++head.frame.seq;
    sink.on_device(true, name_of_head(head.frame.head, head.device) + "delivers, sensor at " +
                             std::to_string(head.stamp.sensor_temperature) + ", driver at " +
                             std::to_string(head.stamp.driver_temperature));
  } else {
    // The unit's own number counts what was lost; one that stands still counts as one.
    const int step = (head.stamp.number - last_number + kNumNumbers) % kNumNumbers;
    head.frame.seq += std::max(step, 1);
  }
  head.frame.utime_us = utime_of_monotonic_us(head.stamp.begun_us, now);
  return true;
}

}  // namespace sources
