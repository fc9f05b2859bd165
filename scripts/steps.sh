# SPDX-License-Identifier: BSD-3-Clause
# For the other scripts (source it): say what is done, stop with the fix, build a preset.

set -euo pipefail
called_from=$PWD
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$repository"

# A path as the user meant it, from the folder he stands in.
from_caller() { (cd "$called_from" && realpath -m -- "$1"); }

started=$(date +%s)
step() { printf '\n==> [%4ds] %s\n' $(($(date +%s) - started)) "$*"; }
fail() {
  printf '\nFAILED: %s\n' "$*" >&2
  exit 1
}

# build PRESET [TARGET...]: configures once, builds with all cores; progress comes from ninja itself.
build() {
  local preset=$1
  shift
  mkdir -p build/logs
  cmake --preset "$preset" >"build/logs/configure-$preset.log" 2>&1 || {
    tail -20 "build/logs/configure-$preset.log" >&2
    fail "cmake could not configure '$preset'; run ./scripts/setup and look at build/logs/configure-$preset.log"
  }
  cmake --build "build/$preset" ${1+--target "$@"} || fail "building '$preset' failed; the first error above names the file"
}
