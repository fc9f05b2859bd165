// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/service.h"

int main(int argc, char** argv) {
  return runtime::run_service(argc, argv, climb_controller::description());
}
