// SPDX-License-Identifier: BSD-3-Clause
#include "gng_service/service.h"

int main(int argc, char** argv) {
  return runtime::run_service(argc, argv, gng_service::description());
}
