// SPDX-License-Identifier: BSD-3-Clause
#include "can/kernel_frame.h"

#include <algorithm>

#include "base/check.h"

namespace can {

::can_frame to_kernel(const CanFrame& frame) {
  CHECK(frame.dlc <= kMaxDataBytes && !frame.fd, "only classic frames are sent");
  ::can_frame kernel{};
  kernel.can_id = frame.id & (frame.extended || frame.error ? CAN_EFF_MASK : CAN_SFF_MASK);
  if (frame.extended) kernel.can_id |= CAN_EFF_FLAG;
  if (frame.remote) kernel.can_id |= CAN_RTR_FLAG;
  if (frame.error) kernel.can_id |= CAN_ERR_FLAG;
  kernel.can_dlc = frame.dlc;
  if (!frame.remote) std::copy_n(frame.data.begin(), frame.dlc, kernel.data);
  return kernel;
}

CanFrame from_kernel(const ::can_frame& kernel) {
  CanFrame frame;
  frame.extended = (kernel.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (kernel.can_id & CAN_RTR_FLAG) != 0;
  frame.error = (kernel.can_id & CAN_ERR_FLAG) != 0;
  frame.id = kernel.can_id & (frame.extended || frame.error ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.fd = kernel.can_dlc > kMaxDataBytes;
  frame.dlc = std::min<std::uint8_t>(kernel.can_dlc, kMaxDataBytes);
  if (!frame.remote) std::copy_n(kernel.data, frame.dlc, frame.data.begin());
  return frame;
}

}  // namespace can
