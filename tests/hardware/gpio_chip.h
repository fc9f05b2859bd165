// SPDX-License-Identifier: BSD-3-Clause
// A GPIO chip of the kernel (gpio-sim) that a test makes, pulls about, takes away and brings back.
// Needs root and configfs. The driver's pull is the level that a reader sees, and a requested bias
// sets that pull: a wire nobody has moved since the request reads as its bias says.
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace hardware {

inline bool write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text << std::flush;
  return static_cast<bool>(file);
}

inline std::string read_file(const std::string& path) {
  std::ifstream file(path);
  std::string text;
  file >> text;
  return text;
}

class SimulatedChip {
 public:
  /// `names` of its lines, in order; "" = none.
  SimulatedChip(const std::string& name, const std::string& label,
                const std::vector<std::string>& names)
      : folder_("/sys/kernel/config/gpio-sim/" + name), num_lines_(names.size()) {
    shell("mkdir " + folder_ + ' ' + bank());
    EXPECT_TRUE(write_file(bank() + "/num_lines", std::to_string(num_lines_)));
    EXPECT_TRUE(write_file(bank() + "/label", label));
    for (std::size_t i = 0; i < num_lines_; ++i) {
      if (names[i].empty()) continue;
      shell("mkdir " + line(i));
      EXPECT_TRUE(write_file(line(i) + "/name", names[i]));
    }
    create();
  }

  ~SimulatedChip() {
    write_file(folder_ + "/live", "0");
    for (std::size_t i = 0; i < num_lines_; ++i) ::rmdir(line(i).c_str());
    ::rmdir(bank().c_str());
    ::rmdir(folder_.c_str());
  }
  SimulatedChip(const SimulatedChip&) = delete;
  SimulatedChip& operator=(const SimulatedChip&) = delete;

  void create() {
    ASSERT_TRUE(write_file(folder_ + "/live", "1"));
    device_ = read_file(folder_ + "/dev_name");
    find_pulls();
  }
  void destroy() { ASSERT_TRUE(write_file(folder_ + "/live", "0")); }

  /// Takes the driver from the device, as a pulled plug does, and gives it back.
  void unbind() { ASSERT_TRUE(write_file(kDriver + "/unbind", device_)); }
  void bind() {
    ASSERT_TRUE(write_file(kDriver + "/bind", device_));
    find_pulls();
  }

  void set(int line, bool high) const {
    const std::string path = pulls_ + "/sim_gpio" + std::to_string(line) + "/pull";
    ASSERT_TRUE(write_file(path, high ? "pull-up" : "pull-down")) << path;
  }

 private:
  inline static const std::string kDriver = "/sys/bus/platform/drivers/gpio-sim";

  static void shell(const std::string& command) {
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
  }
  void find_pulls() {
    pulls_ = "/sys/devices/platform/" + device_ + '/' + read_file(bank() + "/chip_name");
  }
  std::string bank() const { return folder_ + "/bank"; }
  std::string line(std::size_t index) const { return bank() + "/line" + std::to_string(index); }

  std::string folder_;
  std::size_t num_lines_;
  std::string device_;  ///< "gpio-sim.0"
  std::string pulls_;   ///< the folder with sim_gpio0 and so on
};

}  // namespace hardware
