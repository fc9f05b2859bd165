// SPDX-License-Identifier: BSD-3-Clause
#include "fake_iio.h"

#include <fstream>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace sources {

namespace fs = std::filesystem;

FakeIio::FakeIio(const fs::path& root, const std::string& device)
    : root_(root), folder_(root / "devices" / device), fifo_(root / "dev" / device) {
  fs::create_directories(folder_ / "scan_elements");
  fs::create_directories(folder_ / "buffer");
  fs::create_directories(folder_ / "trigger");
  fs::create_directories(root_ / "dev");
  set("name", "mpu6050");
  set("sampling_frequency", "50");
  set("current_timestamp_clock", "realtime");
  set("in_accel_scale", "0.000598");
  set("in_anglvel_scale", "0.001064724");
  set("buffer/enable", "0");
  set("buffer/length", "2");
  set("buffer/watermark", "1");
  set("trigger/current_trigger", "mpu6050-dev0");
  int index = 0;
  for (const char* channel : {"in_accel_x", "in_accel_y", "in_accel_z", "in_anglvel_x",
                              "in_anglvel_y", "in_anglvel_z", "in_timestamp", "in_temp"}) {
    const std::string element = std::string("scan_elements/") + channel;
    set(element + "_en", element.ends_with("temp") ? "1" : "0");
    set(element + "_index", std::to_string(index++));
    set(element + "_type", element.ends_with("timestamp") ? "le:s64/64>>0" : "le:s16/16>>0");
  }
  if (mkfifo(fifo_.c_str(), 0600) != 0) throw std::runtime_error("no FIFO " + fifo_.string());
  writer_ = open(fifo_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
}

FakeIio::~FakeIio() {
  unplug();
}

void FakeIio::set(const std::string& attribute, const std::string& value) const {
  std::ofstream(folder_ / attribute) << value << "\n";
}

std::string FakeIio::get(const std::string& attribute) const {
  std::ifstream stream(folder_ / attribute);
  std::string value;
  std::getline(stream, value);
  return value;
}

void FakeIio::remove(const std::string& attribute) const {
  fs::remove(folder_ / attribute);
}

void FakeIio::send(const std::array<std::int16_t, 6>& counts, std::int64_t stamp_ns) const {
  std::vector<std::uint8_t> record(24);  // 12 bytes, padded to 16 for the time stamp
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto word = static_cast<std::uint16_t>(counts[i]);
    record[2 * i] = static_cast<std::uint8_t>(word & 0xFF);
    record[2 * i + 1] = static_cast<std::uint8_t>(word >> 8);
  }
  for (std::size_t i = 0; i < 8; ++i)
    record[16 + i] = static_cast<std::uint8_t>((stamp_ns >> (8 * i)) & 0xFF);
  send(record);
}

void FakeIio::send(const std::vector<std::uint8_t>& bytes) const {
  if (write(writer_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("nobody reads the buffer");
}

void FakeIio::unplug() {
  if (writer_ < 0) return;
  close(writer_);
  writer_ = -1;
  fs::remove(fifo_);
  fs::remove_all(folder_);
}

}  // namespace sources
