#!/usr/bin/env bash
# Installs missing packages, builds, and runs the built-in sequence, or the recorded sequence in PATH.
#   scripts/run.sh [PATH [OPTION...]]
set -euo pipefail
repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
. "$repository/scripts/packages.sh"
. "$repository/scripts/python_packages.sh"

install_missing $build_packages python3-venv
install_for_pages "$repository/build/venv" &
cmake -S "$repository" -B "$repository/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADEDGE_UNITY=ON
cmake --build "$repository/build" --target quadedge_program
wait %1 || echo "There will be no pages." >&2

if [ $# -eq 0 ]; then
  "$repository/build/quadedge" demo --output quadedge_demo --force
  "$repository/build/quadedge" report quadedge_demo || [ $? -eq 2 ]  # 2: no Python, which it has said
  exit
fi
exec "$repository/build/quadedge" run "$@"
