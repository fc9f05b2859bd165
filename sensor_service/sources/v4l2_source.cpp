// SPDX-License-Identifier: BSD-3-Clause
#include "sources/v4l2_source.h"

#include "sources/arrived_frames.h"
#include "sources/device_time.h"

namespace sources {

V4l2Source::V4l2Source(const SourceParams& params, ReadySet& ready, VideoCalls& calls)
    : ready_(ready) {
  heads_.reserve(params.heads.size());
  for (int index = 0; index < tof::kNumHeads; ++index) {
    const std::string& device = params.heads[index].device;
    if (device.empty()) continue;
    Head& head = heads_.emplace_back();
    head.device = device;
    head.camera = std::make_unique<V4l2Camera>(calls, params.v4l2, params.camera.frames_per_s);
    head.depth_mm.resize(static_cast<std::size_t>(params.v4l2.width_px) *
                         static_cast<std::size_t>(params.v4l2.height_px));
    head.frame = frame_of_head(params, index);
    head.frame.width_px = params.v4l2.width_px;
    head.frame.height_px = params.v4l2.height_px;
    head.frame.depth_mm = head.depth_mm;
    head.frame.seq = -1;
  }
}

void V4l2Source::poll(const base::Now& now, FrameSink& sink) {
  ArrivedFrames arrived;
  for (Head& head : heads_) {
    if (!head.camera->is_open() && head.reopening.is_due(now.monotonic_us)) open(head, now, sink);
    if (take(head, now, sink)) arrived.add(head.frame);
  }
  arrived.hand_to(sink);
}

void V4l2Source::open(Head& head, const base::Now& now, FrameSink& sink) {
  const std::string problem = head.camera->open(head.device);
  if (problem.empty()) {
    ready_.add(head.camera->fd());
    head.is_first = true;
    head.last_frame_us = now.monotonic_us;
  } else if (head.reopening.failed(now.monotonic_us, problem)) {
    sink.on_device(false, name_of_head(head.frame.head, head.device) + problem);
  }
}

bool V4l2Source::take(Head& head, const base::Now& now, FrameSink& sink) {
  const std::uint32_t last_sequence = head.stamp.sequence;
  switch (head.camera->take(head.depth_mm, head.stamp)) {
    case TakeResult::kLost:
      lose(head, head.camera->problem(), now, sink);
      return false;
    case TakeResult::kNothing:
      if (head.camera->is_open() && now.monotonic_us - head.last_frame_us > kSilenceUs) {
        head.camera->close();
        lose(head, "has sent nothing for 3 s", now, sink);
      }
      return false;
    case TakeResult::kFrame:
      break;
  }
  if (head.is_first) {
    head.is_first = false;
    head.reopening.succeeded();
    ++head.frame.seq;
    sink.on_device(true, name_of_head(head.frame.head, head.device) + "delivers");
  } else {
    // The device's own number counts what was lost; one that stands still or restarts counts one.
    const std::uint32_t step = head.stamp.sequence - last_sequence;
    head.frame.seq += step >= 1 && step <= 10'000 ? step : 1;
  }
  head.last_frame_us = now.monotonic_us;
  head.frame.utime_us =
      head.stamp.monotonic_us ? utime_of_monotonic_us(*head.stamp.monotonic_us, now) : now.utime_us;
  return true;
}

void V4l2Source::lose(Head& head, const std::string& problem, const base::Now& now,
                      FrameSink& sink) {
  if (head.reopening.failed(now.monotonic_us, problem))
    sink.on_device(false, name_of_head(head.frame.head, head.device) + problem);
}

}  // namespace sources
