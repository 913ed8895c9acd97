#!/usr/bin/env bash
# Installs missing packages, builds, and runs the built-in sequence, or the recorded sequence in PATH.
#   scripts/run.sh [PATH [OPTION...]]
set -euo pipefail
repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
. "$repository/scripts/packages.sh"
. "$repository/scripts/python_packages.sh"

[ -x "$repository/build/quadedge" ] || cat <<'END'
On Debian 12, this installs the packages that are missing (apt-get, with sudo if you are not root: 0.35 GB beside a
compiler, 1.4 GB on an empty machine), builds build/quadedge (five to ten minutes on two cores), then the bindings of
the Python package (80 MB from PyPI, into build/venv), and tracks a recording. Later calls build what has changed.
END
install_missing $build_packages $python_packages
cmake -S "$repository" -B "$repository/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADEDGE_UNITY=ON
cmake --build "$repository/build" --target quadedge_program
prepare_python "$repository/build/venv" || echo "There will be no pages, batches or evaluations of matches." >&2

if [ $# -eq 0 ]; then
  "$repository/build/quadedge" demo --output quadedge_demo --force
  "$repository/build/quadedge" report quadedge_demo || [ $? -eq 2 ]  # 2: no Python, which it has said
  exit
fi
exec "$repository/build/quadedge" run "$@"
