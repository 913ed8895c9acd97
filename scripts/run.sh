#!/usr/bin/env bash
# Installs what is missing, builds, and runs the built-in sequence, or the recorded sequence in PATH.
#   scripts/run.sh [PATH [OPTION...]]
set -euo pipefail
repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
. "$repository/scripts/packages.sh"

install_missing $build_packages
cmake -S "$repository" -B "$repository/build" -G Ninja -DCMAKE_BUILD_TYPE=Release
cmake --build "$repository/build" --target quadedge_program

if [ $# -eq 0 ]; then
  exec "$repository/build/quadedge" demo --output quadedge_demo --force
fi
exec "$repository/build/quadedge" run "$@"
