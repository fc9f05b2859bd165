// SPDX-License-Identifier: BSD-3-Clause
#include "recorded_cameras.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <sys/eventfd.h>
#include <unistd.h>

namespace sources {
namespace {

int query_capability(const RecordedCamera& camera, v4l2_capability& capability) {
  camera.card.copy(reinterpret_cast<char*>(capability.card), sizeof(capability.card) - 1);
  camera.bus.copy(reinterpret_cast<char*>(capability.bus_info), sizeof(capability.bus_info) - 1);
  capability.device_caps = camera.capabilities;
  capability.capabilities = camera.capabilities | V4L2_CAP_DEVICE_CAPS;
  return 0;
}

int enumerate_formats(const RecordedCamera& camera, v4l2_fmtdesc& format) {
  if (format.index >= camera.formats.size()) return -EINVAL;
  format.pixelformat = camera.formats[format.index].fourcc;
  return 0;
}

int enumerate_sizes(const RecordedCamera& camera, v4l2_frmsizeenum& size) {
  for (const OfferedFormat& format : camera.formats) {
    if (format.fourcc != size.pixel_format || size.index >= format.sizes.size()) continue;
    size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    size.discrete.width = format.sizes[size.index][0];
    size.discrete.height = format.sizes[size.index][1];
    return 0;
  }
  return -EINVAL;
}

/// As drivers do: never refuses, but answers with what it has instead.
int set_format(RecordedCamera& camera, v4l2_pix_format& pix) {
  const auto same = [&pix](const OfferedFormat& f) { return f.fourcc == pix.pixelformat; };
  const auto found = std::find_if(camera.formats.begin(), camera.formats.end(), same);
  const OfferedFormat& format = found != camera.formats.end() ? *found : camera.formats.front();
  std::array<std::uint32_t, 2> size = format.sizes.front();
  for (const auto& offered : format.sizes) {
    if (offered[0] == pix.width && offered[1] == pix.height) size = offered;
  }
  pix.pixelformat = format.fourcc;
  camera.width = pix.width = size[0];
  camera.height = pix.height = size[1];
  pix.field = V4L2_FIELD_NONE;
  pix.bytesperline = 2 * pix.width + camera.padding_bytes;
  pix.sizeimage = pix.bytesperline * pix.height;
  return 0;
}

int request_buffers(RecordedCamera& camera, v4l2_requestbuffers& request) {
  request.count = std::min(request.count, camera.num_buffers);
  const std::size_t num_bytes = (2 * camera.width + camera.padding_bytes) * camera.height;
  camera.buffers.assign(request.count, std::vector<std::uint8_t>(num_bytes));
  camera.queued.clear();
  return 0;
}

int dequeue(RecordedCamera& camera, v4l2_buffer& buffer) {
  if (!camera.is_streaming) return -EINVAL;
  if (camera.waiting.empty() || camera.queued.empty()) return -EAGAIN;
  const RecordedFrame& frame = camera.waiting.front();
  buffer.index = camera.queued.front();
  camera.queued.erase(camera.queued.begin());
  std::vector<std::uint8_t>& bytes = camera.buffers[buffer.index];
  std::fill(bytes.begin(), bytes.end(), std::uint8_t{0xEE});
  for (std::size_t row = 0; row < camera.height; ++row) {
    std::memcpy(bytes.data() + row * (2 * camera.width + camera.padding_bytes),
                frame.counts.data() + row * camera.width, 2 * camera.width);
  }
  buffer.bytesused =
      static_cast<std::uint32_t>(bytes.size()) - static_cast<std::uint32_t>(frame.missing_bytes);
  buffer.flags = frame.flags;
  buffer.sequence = frame.sequence;
  buffer.timestamp.tv_sec = frame.monotonic_us / 1'000'000;
  buffer.timestamp.tv_usec = frame.monotonic_us % 1'000'000;
  camera.waiting.pop_front();
  return 0;
}

const char* name_of(unsigned long request) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      return "QUERYCAP";
    case VIDIOC_ENUM_FMT:
      return "ENUM_FMT";
    case VIDIOC_ENUM_FRAMESIZES:
      return "ENUM_FRAMESIZES";
    case VIDIOC_S_FMT:
      return "S_FMT";
    case VIDIOC_S_PARM:
      return "S_PARM";
    case VIDIOC_REQBUFS:
      return "REQBUFS";
    case VIDIOC_QUERYBUF:
      return "QUERYBUF";
    case VIDIOC_QBUF:
      return "QBUF";
    case VIDIOC_DQBUF:
      return "DQBUF";
    case VIDIOC_STREAMON:
      return "STREAMON";
    case VIDIOC_STREAMOFF:
      return "STREAMOFF";
    default:
      return "unknown";
  }
}

template <class T>
T& as(void* argument) {
  return *static_cast<T*>(argument);
}

int answer(RecordedCamera& camera, unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      return query_capability(camera, as<v4l2_capability>(argument));
    case VIDIOC_ENUM_FMT:
      return enumerate_formats(camera, as<v4l2_fmtdesc>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return enumerate_sizes(camera, as<v4l2_frmsizeenum>(argument));
    case VIDIOC_S_FMT:
      return set_format(camera, as<v4l2_format>(argument).fmt.pix);
    case VIDIOC_S_PARM:
      return 0;
    case VIDIOC_REQBUFS:
      return request_buffers(camera, as<v4l2_requestbuffers>(argument));
    case VIDIOC_QUERYBUF: {
      auto& buffer = as<v4l2_buffer>(argument);
      if (buffer.index >= camera.buffers.size()) return -EINVAL;
      buffer.length = static_cast<std::uint32_t>(camera.buffers[buffer.index].size());
      buffer.m.offset = buffer.index;
      return 0;
    }
    case VIDIOC_QBUF:
      camera.queued.push_back(as<v4l2_buffer>(argument).index);
      return 0;
    case VIDIOC_DQBUF:
      return dequeue(camera, as<v4l2_buffer>(argument));
    case VIDIOC_STREAMON:
      camera.is_streaming = true;
      return 0;
    case VIDIOC_STREAMOFF:
      camera.is_streaming = false;
      camera.queued.clear();
      return 0;
    default:
      return -ENOTTY;
  }
}

}  // namespace

RecordedCameras::RecordedCameras() = default;

RecordedCameras::~RecordedCameras() {
  for (auto& [path, camera] : cameras_) {
    if (camera.fd >= 0) ::close(camera.fd);
  }
}

void RecordedCameras::move(const std::string& from, const std::string& to) {
  auto node = cameras_.extract(from);
  node.key() = to;
  cameras_.insert(std::move(node));
}

std::vector<std::string> RecordedCameras::nodes() {
  std::vector<std::string> paths;
  for (const auto& [path, camera] : cameras_) {
    if (camera.is_plugged_in) paths.push_back(path);
  }
  return paths;
}

int RecordedCameras::open(const std::string& path) {
  const auto found = cameras_.find(path);
  if (found == cameras_.end() || !found->second.is_plugged_in) return -ENOENT;
  found->second.fd = eventfd(0, EFD_CLOEXEC);
  ++num_open_;
  return found->second.fd;
}

void RecordedCameras::close(int fd) {
  RecordedCamera* camera = find(fd);
  if (camera == nullptr) return;
  ::close(fd);
  camera->fd = -1;
  --num_open_;
}

int RecordedCameras::control(int fd, unsigned long request, void* argument) {
  RecordedCamera* camera = find(fd);
  if (camera == nullptr) return -EBADF;
  if (camera->keeps_calls) camera->calls.emplace_back(name_of(request));
  if (!camera->is_plugged_in) return -ENODEV;
  const auto failure = camera->failures.find(request);
  if (failure != camera->failures.end()) return -failure->second;
  return answer(*camera, request, argument);
}

void* RecordedCameras::map(int fd, std::size_t num_bytes, std::int64_t offset) {
  RecordedCamera* camera = find(fd);
  if (camera == nullptr || camera->buffers[offset].size() != num_bytes) return nullptr;
  ++num_mapped_;
  return camera->buffers[offset].data();
}

void RecordedCameras::unmap(void* /*address*/, std::size_t /*num_bytes*/) {
  --num_mapped_;
}

bool RecordedCameras::is_broken(int fd) {
  const RecordedCamera* camera = find(fd);
  return camera == nullptr || camera->is_broken || !camera->is_plugged_in;
}

RecordedCamera* RecordedCameras::find(int fd) {
  for (auto& [path, camera] : cameras_) {
    if (camera.fd == fd) return &camera;
  }
  return nullptr;
}

}  // namespace sources
