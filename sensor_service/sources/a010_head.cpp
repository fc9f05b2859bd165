// SPDX-License-Identifier: BSD-3-Clause
#include "sources/a010_head.h"

#include <array>

namespace sources {
namespace {

constexpr std::int64_t kAnswerUs = 500'000;
constexpr int kMaxAttempts = 3;
constexpr int kReadsPerStep = 8;           // a line that never runs dry must not hold the work loop
constexpr std::uint32_t kOk = 0x4F4B0D0A;  // "OK\r\n"

/// The first silences the unit (images to its own display only) and may be answered amidst an
/// image; the second asks whether anybody is there; the last lets it send.
std::vector<std::string> commands_of(const A010Params& params, int frames_per_s) {
  return {"AT+DISP=1\r",
          "AT\r",
          "AT+BINN=" + std::to_string(params.binning) + "\r",
          "AT+UNIT=" + std::to_string(params.unit_mm) + "\r",
          "AT+FPS=" + std::to_string(frames_per_s) + "\r",
          "AT+ISP=1\r",
          params.over_usb ? "AT+DISP=2\r" : "AT+DISP=4\r"};
}

/// A unit that works already may refuse what it does anyway.
bool must_be_answered(const std::string& command) {
  return !command.starts_with("AT+DISP") && !command.starts_with("AT+ISP");
}

}  // namespace

A010Head::A010Head(const A010Params& params, int frames_per_s)
    : params_(params), commands_(commands_of(params, frames_per_s)) {
  depth_mm_.resize(static_cast<std::size_t>(side_px()) * static_cast<std::size_t>(side_px()));
}

std::string A010Head::open(const std::string& device, std::int64_t now_us) {
  std::string problem = line_.open(device, params_.baud);
  if (!problem.empty()) return problem;
  num_attempts_ = 0;
  has_image_ = false;
  send(0, now_us);
  return "";
}

void A010Head::send(int index, std::int64_t now_us) {
  if (index != command_) num_attempts_ = 0;
  command_ = index;
  ++num_attempts_;
  last_bytes_ = 0;
  sent_us_ = now_us;
  line_.write(commands_[index]);
  last_frame_us_ = now_us;
  parser_.reset();
}

std::string A010Head::work(std::int64_t now_us) {
  const bool is_talking = command_ + 1 < static_cast<int>(commands_.size());
  std::string problem = is_talking ? talk(now_us) : listen(now_us);
  if (problem.empty() && !line_.is_open()) problem = "is gone";
  if (!problem.empty()) line_.close();
  return problem;
}

std::string A010Head::talk(std::int64_t now_us) {
  const std::string& command = commands_[command_];
  if (read_answer()) {
    send(command_ + 1, now_us);
    return "";
  }
  if (now_us - sent_us_ < kAnswerUs) return "";
  if (!must_be_answered(command)) {
    send(command_ + 1, now_us);
  } else if (num_attempts_ < kMaxAttempts) {
    send(command_, now_us);
  } else {
    return "does not answer " + command.substr(0, command.size() - 1) +
           ": no MaixSense A010, or another speed";
  }
  return "";
}

bool A010Head::read_answer() {
  std::array<std::uint8_t, 4096> bytes;
  bool is_ok = false;
  for (int i = 0; i < kReadsPerStep; ++i) {
    const std::size_t num_bytes = line_.read(bytes);
    for (std::size_t at = 0; at < num_bytes; ++at) {
      last_bytes_ = (last_bytes_ << 8) | bytes[at];
      is_ok = is_ok || last_bytes_ == kOk;
    }
    if (num_bytes < bytes.size()) break;
  }
  return is_ok;
}

std::string A010Head::listen(std::int64_t now_us) {
  for (int i = 0; i < kReadsPerStep; ++i) {
    if (!parser_.has_begun()) begun_us_ = now_us;
    const std::size_t num_bytes = line_.read(parser_.room());
    if (num_bytes == 0) break;
    parser_.fill(num_bytes);
    A010Frame frame;
    while (parser_.next(frame)) {
      last_frame_us_ = now_us;
      if (frame.width_px == side_px()) keep(frame);  // not one that was begun before AT+BINN
      begun_us_ = now_us;
    }
  }
  if (static_cast<double>(now_us - last_frame_us_) > params_.silence_s * 1e6)
    return "has sent no image for " + std::to_string(static_cast<int>(params_.silence_s)) + " s";
  return "";
}

void A010Head::keep(const A010Frame& frame) {
  for (std::size_t i = 0; i < depth_mm_.size(); ++i)
    depth_mm_[i] = a010_depth_mm(frame.counts[i], params_.unit_mm);
  stamp_ = {.begun_us = begun_us_,
            .number = frame.number,
            .sensor_temperature = frame.sensor_temperature,
            .driver_temperature = frame.driver_temperature};
  has_image_ = true;
}

bool A010Head::take(A010Stamp& stamp) {
  if (!has_image_) return false;
  has_image_ = false;
  stamp = stamp_;
  return true;
}

}  // namespace sources
