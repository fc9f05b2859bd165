// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_service/service.h"

int main(int argc, char** argv) {
  return runtime::run_service(argc, argv, sensor_service::description());
}
