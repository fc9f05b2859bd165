// SPDX-License-Identifier: BSD-3-Clause
#include "ladder_service/service.h"

int main(int argc, char** argv) {
  return runtime::run_service(argc, argv, ladder_service::description());
}
