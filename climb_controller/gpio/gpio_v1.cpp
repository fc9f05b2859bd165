// SPDX-License-Identifier: BSD-3-Clause
// GpiodChip on libgpiod 1.5 and 1.6 (Debian 12): one handle and one descriptor per line, gathered
// in an epoll descriptor.
#include <cerrno>

#include <gpiod.h>
#include <sys/epoll.h>
#include <unistd.h>

#include "gpio/gpiod_chip.h"

namespace gpio {
namespace {

constexpr const char* kConsumer = "climb_controller";

int flags_of(Bias bias) {
  switch (bias) {
    case Bias::kDisabled:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
    case Bias::kPullUp:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
    case Bias::kPullDown:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
    case Bias::kAsIs:
      break;
  }
  return 0;
}

std::string text_of(const char* text) {
  return text == nullptr ? "" : text;
}

class ChipV1 : public GpiodChip {
 public:
  explicit ChipV1(gpiod_chip* chip) : chip_(chip) {}

  ~ChipV1() override {
    if (epoll_ >= 0) ::close(epoll_);
    gpiod_chip_close(chip_);  // gives the lines back
  }
  ChipV1(const ChipV1&) = delete;
  ChipV1& operator=(const ChipV1&) = delete;

  std::string label() const override { return text_of(gpiod_chip_label(chip_)); }
  int num_lines() const override { return static_cast<int>(gpiod_chip_num_lines(chip_)); }

  LineInfo line(int offset) const override {
    gpiod_line* line = gpiod_chip_get_line(chip_, static_cast<unsigned>(offset));
    if (line == nullptr) return {};
    return {text_of(gpiod_line_name(line)), gpiod_line_is_used(line),
            text_of(gpiod_line_consumer(line))};
  }

  int request(const InputRequests& inputs, bool with_edges) override {
    int error = 0;
    for (std::size_t i = 0; i < inputs.size() && error == 0; ++i) {
      error = request_line(i, inputs[i], with_edges);
    }
    if (error == 0 && with_edges) error = gather_edges();
    if (error != 0) release();
    has_edges_ = error == 0 && with_edges;
    return error;
  }

  bool read(Levels& levels) override {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (has_edges_) discard_edges(gpiod_line_event_get_fd(lines_[i]));
      const int level = gpiod_line_get_value(lines_[i]);
      if (level < 0) return false;
      levels[i] = level == 1;
    }
    return true;
  }

  int wake_fd() const override { return epoll_; }

 private:
  int request_line(std::size_t index, const InputRequest& input, bool with_edges) {
    gpiod_line* line = gpiod_chip_get_line(chip_, static_cast<unsigned>(input.offset));
    if (line == nullptr) return errno;
    const int flags = flags_of(input.bias);
    const int result = with_edges
                           ? gpiod_line_request_both_edges_events_flags(line, kConsumer, flags)
                           : gpiod_line_request_input_flags(line, kConsumer, flags);
    if (result != 0) return errno;
    lines_[index] = line;
    return 0;
  }

  int gather_edges() {
    epoll_ = ::epoll_create1(EPOLL_CLOEXEC);
    if (epoll_ < 0) return errno;
    for (gpiod_line* line : lines_) {
      const int fd = gpiod_line_event_get_fd(line);
      make_non_blocking(fd);
      epoll_event event{};
      event.events = EPOLLIN;
      if (::epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event) != 0) return errno;
    }
    return 0;
  }

  void release() {
    if (epoll_ >= 0) ::close(epoll_);
    epoll_ = -1;
    for (gpiod_line*& line : lines_) {
      if (line != nullptr) gpiod_line_release(line);
      line = nullptr;
    }
  }

  gpiod_chip* chip_;
  std::array<gpiod_line*, kNumLines> lines_{};
  int epoll_ = -1;
  bool has_edges_ = false;
};

}  // namespace

std::unique_ptr<GpiodChip> SystemChips::open(const std::string& path, int& error) const {
  gpiod_chip* chip = gpiod_chip_open(path.c_str());
  error = chip == nullptr ? errno : 0;
  return chip == nullptr ? nullptr : std::make_unique<ChipV1>(chip);
}

}  // namespace gpio
