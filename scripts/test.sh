#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests. Recorded data is found through QUADEDGE_DATA; tests that need it
# say so and pass where it is not set.
#   scripts/test.sh [--all-runtimes] [CTEST OPTION...]      for example: scripts/test.sh -R edges
# --all-runtimes first installs Intel's OpenCL for CPUs from PyPI into the virtual environment and runs the tests of
# kernels, pipeline and recorded data on it as well (tests/run_other_runtime.sh).
set -euo pipefail
all_runtimes=false
if [ "${1:-}" = --all-runtimes ]; then
  all_runtimes=true
  shift
fi
repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
. "$repository/scripts/packages.sh"

install_missing $build_packages $python_packages $wheel_packages $test_packages
cmake -S "$repository" -B "$repository/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADEDGE_TESTS=ON \
  -DQUADEDGE_UNITY=ON -DQUADEDGE_WARNINGS_AS_ERRORS=ON
cmake --build "$repository/build"

# One virtual environment with evo, the reference for trajectory errors, Snakemake and pandas; made anew when the list
# changes.
venv="$repository/build/venv" requirements="$repository/tests/requirements.txt"
if ! cmp -s "$requirements" "$venv/requirements.txt"; then
  echo "Installing the Python packages of $requirements into $venv"
  python3 -m venv --clear "$venv"
  "$venv/bin/pip" install --quiet --disable-pip-version-check --requirement "$requirements"
  cp "$requirements" "$venv/requirements.txt"
fi

# The Python package, from the library that is built already; only its bindings are compiled.
"$venv/bin/pip" install --quiet --disable-pip-version-check --no-build-isolation "$repository" \
  -C cmake.source-dir=python -C build-dir="$repository/build/python" -C cmake.define.quadedge_DIR="$repository/build" \
  -C cmake.define.QUADEDGE_WARNINGS_AS_ERRORS=ON

if $all_runtimes; then "$repository/tests/run_other_runtime.sh" "$repository/build"; fi

# Tests side by side: many of them, such as the simulator and everything on the plain C++ reference, use one processor.
exec ctest --test-dir "$repository/build" --output-on-failure --parallel "$(nproc)" "$@"
