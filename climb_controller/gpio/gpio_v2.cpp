// SPDX-License-Identifier: BSD-3-Clause
// GpiodChip on libgpiod 2.x (Debian 13): one request and one descriptor for all lines.
#include <cerrno>

#include <gpiod.h>

#include "gpio/gpiod_chip.h"

namespace gpio {
namespace {

constexpr const char* kConsumer = "climb_controller";

gpiod_line_bias bias_of(Bias bias) {
  switch (bias) {
    case Bias::kDisabled:
      return GPIOD_LINE_BIAS_DISABLED;
    case Bias::kPullUp:
      return GPIOD_LINE_BIAS_PULL_UP;
    case Bias::kPullDown:
      return GPIOD_LINE_BIAS_PULL_DOWN;
    case Bias::kAsIs:
      break;
  }
  return GPIOD_LINE_BIAS_AS_IS;
}

std::string text_of(const char* text) {
  return text == nullptr ? "" : text;
}

/// libgpiod's objects, freed by their own functions.
template <auto kFree>
struct Freed {
  template <class Object>
  void operator()(Object* object) const {
    kFree(object);
  }
};
using Chip = std::unique_ptr<gpiod_chip, Freed<gpiod_chip_close>>;
using ChipInfo = std::unique_ptr<gpiod_chip_info, Freed<gpiod_chip_info_free>>;
using Info = std::unique_ptr<gpiod_line_info, Freed<gpiod_line_info_free>>;
using Settings = std::unique_ptr<gpiod_line_settings, Freed<gpiod_line_settings_free>>;
using LineConfig = std::unique_ptr<gpiod_line_config, Freed<gpiod_line_config_free>>;
using RequestConfig = std::unique_ptr<gpiod_request_config, Freed<gpiod_request_config_free>>;
using Request = std::unique_ptr<gpiod_line_request, Freed<gpiod_line_request_release>>;

/// Null, and errno says why.
LineConfig config_of(const InputRequests& inputs, bool with_edges) {
  LineConfig config(gpiod_line_config_new());
  const Settings settings(gpiod_line_settings_new());
  if (!config || !settings) return nullptr;
  gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_INPUT);
  gpiod_line_settings_set_edge_detection(settings.get(),
                                         with_edges ? GPIOD_LINE_EDGE_BOTH : GPIOD_LINE_EDGE_NONE);
  for (const InputRequest& input : inputs) {
    const auto offset = static_cast<unsigned>(input.offset);
    gpiod_line_settings_set_bias(settings.get(), bias_of(input.bias));
    if (gpiod_line_config_add_line_settings(config.get(), &offset, 1, settings.get()) != 0) {
      return nullptr;
    }
  }
  return config;
}

class ChipV2 : public GpiodChip {
 public:
  explicit ChipV2(Chip chip) : chip_(std::move(chip)), info_(gpiod_chip_get_info(chip_.get())) {}

  std::string label() const override {
    return info_ ? text_of(gpiod_chip_info_get_label(info_.get())) : "";
  }
  int num_lines() const override {
    return info_ ? static_cast<int>(gpiod_chip_info_get_num_lines(info_.get())) : 0;
  }

  LineInfo line(int offset) const override {
    const Info info(gpiod_chip_get_line_info(chip_.get(), static_cast<unsigned>(offset)));
    if (!info) return {};
    return {text_of(gpiod_line_info_get_name(info.get())), gpiod_line_info_is_used(info.get()),
            text_of(gpiod_line_info_get_consumer(info.get()))};
  }

  int request(const InputRequests& inputs, bool with_edges) override {
    const LineConfig lines = config_of(inputs, with_edges);
    const RequestConfig request(gpiod_request_config_new());
    if (!lines || !request) return errno;
    gpiod_request_config_set_consumer(request.get(), kConsumer);
    request_.reset(gpiod_chip_request_lines(chip_.get(), request.get(), lines.get()));
    if (!request_) return errno;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      offsets_[i] = static_cast<unsigned>(inputs[i].offset);
    }
    make_non_blocking(gpiod_line_request_get_fd(request_.get()));
    has_edges_ = with_edges;
    return 0;
  }

  bool read(Levels& levels) override {
    if (!request_) return false;
    if (has_edges_) discard_edges(gpiod_line_request_get_fd(request_.get()));
    std::array<gpiod_line_value, kNumLines> values{};
    const int result = gpiod_line_request_get_values_subset(request_.get(), offsets_.size(),
                                                            offsets_.data(), values.data());
    if (result != 0) return false;
    for (std::size_t i = 0; i < values.size(); ++i) {
      levels[i] = values[i] == GPIOD_LINE_VALUE_ACTIVE;
    }
    return true;
  }

  int wake_fd() const override {
    return request_ && has_edges_ ? gpiod_line_request_get_fd(request_.get()) : -1;
  }

 private:
  Chip chip_;
  ChipInfo info_;
  Request request_;
  std::array<unsigned, kNumLines> offsets_{};
  bool has_edges_ = false;
};

}  // namespace

std::unique_ptr<GpiodChip> SystemChips::open(const std::string& path, int& error) const {
  Chip chip(gpiod_chip_open(path.c_str()));
  error = chip ? 0 : errno;
  return chip ? std::make_unique<ChipV2>(std::move(chip)) : nullptr;
}

}  // namespace gpio
