// SPDX-License-Identifier: BSD-3-Clause
#include "gpio/kernel_lines.h"

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

namespace gpio {
namespace {

std::string quoted(const std::string& text) {
  return '"' + text + '"';
}

struct Found {
  std::unique_ptr<GpiodChip> chip;
  std::string path;
  std::string error;  ///< "" = found

  std::string in_words() const { return "GPIO chip " + quoted(chip->label()) + " (" + path + ")"; }
};

Found failure(std::string error) {
  return {nullptr, "", std::move(error)};
}

Found find_chip(const std::string& label, const Chips& chips) {
  std::vector<Found> matches;
  std::string others;
  std::string closed;
  for (const std::string& path : chips.paths()) {
    int error = 0;
    std::unique_ptr<GpiodChip> chip = chips.open(path, error);
    if (!chip) {
      closed += "; " + path + " cannot be opened: " + std::strerror(error) +
                (error == EACCES ? " (add this user to the group that owns it)" : "");
    } else if (chip->label() == label) {
      matches.push_back({std::move(chip), path, ""});
    } else {
      others += (others.empty() ? "" : ", ") + quoted(chip->label()) + " (" + path + ")";
    }
  }
  if (matches.empty()) {
    return failure("no GPIO chip is labelled " + quoted(label) + "; there " +
                   (others.empty() ? "is no other" : "are " + others) + closed +
                   "; load the chip's driver, or correct gpio.chip (gpiodetect lists labels)");
  }
  if (matches.size() > 1) {
    return failure("two GPIO chips are labelled " + quoted(label) + ": " + matches[0].path +
                   " and " + matches[1].path + "; which one is meant cannot be told");
  }
  return std::move(matches.front());
}

/// The line's offset on the chip, or what is wrong.
struct Place {
  int offset = -1;
  std::string error;
};

Place find_line(const LineParams& wanted, const Found& found) {
  const int num_lines = found.chip->num_lines();
  if (wanted.name.empty()) {
    if (wanted.offset < num_lines) return {wanted.offset, ""};
    return {-1, found.in_words() + " has " + std::to_string(num_lines) + " lines, none at offset " +
                    std::to_string(wanted.offset) + " (gpioinfo lists them)"};
  }
  int offset = -1;
  for (int i = 0; i < num_lines; ++i) {
    if (found.chip->line(i).name != wanted.name) continue;
    if (offset >= 0) {
      return {-1, found.in_words() + " has two lines named " + wanted.name + ", at offsets " +
                      std::to_string(offset) + " and " + std::to_string(i) +
                      "; give the offset instead of the name"};
    }
    offset = i;
  }
  if (offset >= 0) return {offset, ""};
  return {-1, found.in_words() + " has no line named " + wanted.name +
                  " (gpioinfo lists them); correct the name, or give the offset"};
}

std::string same_line(const InputRequests& inputs, std::size_t count, const Found& found) {
  for (std::size_t i = 0; i < count; ++i) {
    if (inputs[i].offset != inputs[count].offset) continue;
    return "line " + std::to_string(inputs[i].offset) + " of " + found.in_words() +
           " is configured twice, once by name and once by offset";
  }
  return "";
}

std::string refusal(const InputRequests& inputs, const Found& found, int error) {
  for (const InputRequest& input : inputs) {
    const LineInfo line = found.chip->line(input.offset);
    if (error != EBUSY || !line.is_used) continue;
    return "line " + (line.name.empty() ? "" : line.name + " ") + "at offset " +
           std::to_string(input.offset) + " of " + found.in_words() + " is held by " +
           quoted(line.consumer) + "; end that program, or correct the configuration";
  }
  return found.in_words() + " does not give its lines as inputs: " + std::strerror(error);
}

}  // namespace

KernelLines::KernelLines(const LinesParams& params, const Chips& chips)
    : params_(params), chips_(chips) {}

std::string KernelLines::open() {
  chip_.reset();
  Found found = find_chip(params_.chip, chips_);
  if (!found.error.empty()) return found.error;
  InputRequests inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const LineParams& wanted = params_.line(static_cast<int>(i));
    Place place = find_line(wanted, found);
    if (!place.error.empty()) return place.error;
    inputs[i] = {place.offset, wanted.bias};
    if (std::string error = same_line(inputs, i, found); !error.empty()) return error;
  }
  int error = found.chip->request(inputs, true);
  // A chip without interrupts: nobody wakes us, but the levels are read in every cycle anyway.
  if (error != 0 && error != EBUSY) error = found.chip->request(inputs, false);
  if (error != 0) return refusal(inputs, found, error);
  chip_ = std::move(found.chip);
  path_ = found.path;
  return "";
}

ReadStatus KernelLines::read(Levels& levels) {
  if (chip_ && chip_->read(levels)) return ReadStatus::kDone;
  chip_.reset();
  is_lost_ = true;
  return ReadStatus::kLost;
}

std::string KernelLines::loss() const {
  if (!is_lost_) return "";
  return "GPIO chip " + quoted(params_.chip) + " (" + path_ + ") has gone";
}

}  // namespace gpio
