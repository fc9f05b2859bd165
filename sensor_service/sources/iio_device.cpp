// SPDX-License-Identifier: BSD-3-Clause
#include "sources/iio_device.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

#include "sources/sysfs.h"

namespace sources {
namespace {

constexpr std::array<std::string_view, 7> kChannelNames{
    "in_accel_x",   "in_accel_y",   "in_accel_z",  "in_anglvel_x",
    "in_anglvel_y", "in_anglvel_z", "in_timestamp"};
constexpr std::size_t kTimestamp = 6;
constexpr std::size_t kBufferBytes = 16'384;      // more than a second at 200 Hz
constexpr std::string_view kBufferLength = "64";  // records the kernel keeps: 320 ms at 200 Hz

std::string channel_name(std::size_t channel) {
  return std::string(kChannelNames[channel]);
}

/// Folder in sysfs whose attribute `name` says so: devices "iio:device*" or "trigger*"; "" = none.
std::string folder_named(const std::string& root, std::string_view prefix,
                         std::string_view wanted) {
  for (const std::string& name : names_in(root)) {
    std::string folder = root;
    folder.append("/").append(name);
    if (name.starts_with(prefix) && read_attribute(folder + "/name") == wanted) return folder;
  }
  return "";
}

}  // namespace

IioDevice::IioDevice(const ImuParams& params) : params_(params), bytes_(kBufferBytes) {}

IioDevice::~IioDevice() {
  close();
}

std::string IioDevice::open() {
  close();
  std::string problem = find();
  if (problem.empty()) problem = choose_channels();
  if (!problem.empty()) return problem;
  lay_out();
  set_rate_and_trigger();
  return start();
}

void IioDevice::close() {
  if (fd_ < 0) return;
  ::close(fd_);
  fd_ = -1;
  write_attribute(folder_ + "/buffer/enable", "0");
}

std::string IioDevice::find() {
  constexpr std::string_view kByName = "name:";
  const bool is_name = params_.device.starts_with(kByName);
  folder_ = is_name
                ? folder_named(params_.sysfs, "iio:device", params_.device.substr(kByName.size()))
                : params_.sysfs + "/" + params_.device;
  if (folder_.empty() || names_in(folder_).empty()) return "is not among " + params_.sysfs;
  special_ = params_.dev + folder_.substr(folder_.rfind('/'));
  return "";
}

/// Only what is needed enters the records; the buffer must be off meanwhile.
std::string IioDevice::choose_channels() {
  write_attribute(folder_ + "/buffer/enable", "0");
  const std::string elements = folder_ + "/scan_elements";
  const std::vector<std::string> names = names_in(elements);
  if (names.empty()) return "has no scan_elements: it cannot be read through a buffer";
  for (const std::string& name : names) {
    std::string element = elements;
    if (name.ends_with("_en")) write_attribute(element.append("/").append(name), "0");
  }
  for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
    const std::string problem = read_channel(channel);
    if (!problem.empty()) return problem;
  }
  return "";
}

std::string IioDevice::read_channel(std::size_t channel) {
  const std::string name = channel_name(channel);
  const std::string element = folder_ + "/scan_elements/" + name;
  if (!write_attribute(element + "_en", "1")) return "has no channel " + name;
  const auto index = read_number(element + "_index");
  const auto type = parse_iio_type(read_attribute(element + "_type").value_or(""));
  if (!index || !type) return "does not say how " + name + " lies in its records";
  channels_[channel] = {.type = *type, .index = static_cast<int>(*index)};
  if (channel == kTimestamp) return "";
  channels_[channel].scale = shared_number(channel, "scale", 0.0);
  channels_[channel].offset = shared_number(channel, "offset", 0.0);
  return channels_[channel].scale > 0.0 ? "" : "has no scale for " + name;
}

/// "in_accel_x_scale", else "in_accel_scale" for all axes.
double IioDevice::shared_number(std::size_t channel, const std::string& what,
                                double otherwise) const {
  const std::string own = folder_ + "/" + channel_name(channel);
  const std::string shared = own.substr(0, own.size() - 2);
  if (const auto value = read_number(own + "_" + what)) return *value;
  return read_number(shared + "_" + what).value_or(otherwise);
}

void IioDevice::lay_out() {
  std::array<std::size_t, kNumChannels> order{};
  for (std::size_t i = 0; i < kNumChannels; ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
    return channels_[a].index != channels_[b].index ? channels_[a].index < channels_[b].index
                                                    : a < b;
  });
  std::array<IioType, kNumChannels> types{};
  std::array<std::size_t, kNumChannels> offsets{};
  for (std::size_t i = 0; i < kNumChannels; ++i) types[i] = channels_[order[i]].type;
  record_bytes_ = lay_out_record(types, offsets);
  for (std::size_t i = 0; i < kNumChannels; ++i) channels_[order[i]].at = offsets[i];
}

/// Devices differ in what they let one choose: what cannot be set is left as it is.
void IioDevice::set_rate_and_trigger() {
  const std::string rate = std::to_string(params_.samples_per_s);
  for (const char* file :
       {"/sampling_frequency", "/in_accel_sampling_frequency", "/in_anglvel_sampling_frequency"}) {
    write_attribute(folder_ + file, rate);
  }
  if (!params_.trigger.empty()) {
    const std::string trigger = folder_named(params_.sysfs, "trigger", params_.trigger);
    if (!trigger.empty()) write_attribute(trigger + "/sampling_frequency", rate);
    write_attribute(folder_ + "/trigger/current_trigger", params_.trigger);
  }
  samples_per_s_ = read_number(folder_ + "/sampling_frequency")
                       .value_or(read_number(folder_ + "/in_accel_sampling_frequency").value_or(0));
  write_attribute(folder_ + "/current_timestamp_clock", "monotonic");
  is_monotonic_ = read_attribute(folder_ + "/current_timestamp_clock") == "monotonic";
}

std::string IioDevice::start() {
  write_attribute(folder_ + "/buffer/length", kBufferLength);
  write_attribute(folder_ + "/buffer/watermark", "1");
  if (!write_attribute(folder_ + "/buffer/enable", "1"))
    return "does not start its buffer: it needs a trigger, or somebody else uses it";
  fd_ = ::open(special_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  num_bytes_ = 0;
  return fd_ >= 0 ? "" : special_ + " cannot be opened: " + std::strerror(errno);
}

std::size_t IioDevice::read(std::span<IioRecord> records) {
  if (fd_ < 0) return 0;
  const std::size_t wanted = std::min(records.size() * record_bytes_, bytes_.size());
  if (num_bytes_ < wanted) {
    const ssize_t size = ::read(fd_, bytes_.data() + num_bytes_, wanted - num_bytes_);
    if (size > 0) num_bytes_ += static_cast<std::size_t>(size);
    if (size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR)) {
      close();
      return 0;
    }
  }
  const std::size_t num_records = num_bytes_ / record_bytes_;
  for (std::size_t i = 0; i < num_records; ++i)
    decode({bytes_.data() + i * record_bytes_, record_bytes_}, records[i]);
  const std::size_t num_used = num_records * record_bytes_;
  std::copy(bytes_.begin() + num_used, bytes_.begin() + num_bytes_, bytes_.begin());
  num_bytes_ -= num_used;
  return num_records;
}

void IioDevice::decode(std::span<const std::uint8_t> bytes, IioRecord& record) const {
  std::array<double, kTimestamp> values{};
  for (std::size_t i = 0; i < kTimestamp; ++i) {
    const Channel& channel = channels_[i];
    const auto raw = static_cast<double>(decode_iio(channel.type, bytes.subspan(channel.at)));
    values[i] = (raw + channel.offset) * channel.scale;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    record.accelerometer_m_s2[axis] = values[axis];
    record.gyroscope_rad_s[axis] = values[3 + axis];
  }
  const Channel& stamp = channels_[kTimestamp];
  record.stamp_us = decode_iio(stamp.type, bytes.subspan(stamp.at)) / 1000;  // nanoseconds
}

}  // namespace sources
