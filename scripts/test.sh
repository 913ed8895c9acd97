#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests. Recorded data is found through QUADEDGE_DATA; tests that need it say so
# and pass where it is not set.
#   scripts/test.sh [CTEST OPTION...]      for example: scripts/test.sh -R edges
set -euo pipefail
repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
. "$repository/scripts/packages.sh"

install_missing $build_packages $test_packages
cmake -S "$repository" -B "$repository/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADEDGE_TESTS=ON
cmake --build "$repository/build"

# One virtual environment with evo, the reference for trajectory errors; made once.
venv="$repository/build/venv"
if ! "$venv/bin/python" -c 'import evo' 2>/dev/null; then
  echo "Installing evo into $venv"
  python3 -m venv "$venv"
  "$venv/bin/pip" install --quiet --disable-pip-version-check evo==1.38.1
fi

exec ctest --test-dir "$repository/build" --output-on-failure "$@"
