#!/usr/bin/env bash
# Installs missing packages, builds, and runs the tests. QUADEDGE_DATA names the folder of recorded data; without it,
# tests that need recorded data print a message and pass.
#   scripts/test.sh [--all] [--all-runtimes] [CTEST OPTION...]      example: scripts/test.sh -R edge_detection
# --all also builds the programs in bench/ and runs the slow tests: attacks, oclgrind, sanitizers, clang-tidy, tools in
# scripts/, packages, the wheel and the device kit, and treats compiler warnings as errors. Without it, what
# scripts/run.sh has built is not built again.
# --all-runtimes first installs Intel's OpenCL for CPUs from PyPI into the virtual environment and runs the tests of
# kernels, pipeline and recorded data on it as well (tests/run_other_runtime.sh).
set -euo pipefail
all_runtimes=false slow=(--label-exclude slow) strict=()
while :; do
  case "${1:-}" in
    --all) slow=() strict=(-DQUADEDGE_WARNINGS_AS_ERRORS=ON -DQUADEDGE_BENCHMARKS=ON) ;;
    --all-runtimes) all_runtimes=true ;;
    *) break ;;
  esac
  shift
done
repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
. "$repository/scripts/packages.sh"
. "$repository/scripts/python_packages.sh"

install_missing $build_packages $python_packages $test_packages
# One virtual environment with evo, the reference for trajectory errors, Snakemake and pandas; made anew when the list
# changes, beside the build.
venv="$repository/build/venv" requirements="$repository/tests/requirements.txt"
make_venv() {
  cmp -s "$requirements" "$venv/requirements.txt" && return
  echo "Installing the Python packages of $requirements into $venv"
  python3 -m venv --clear "$venv"
  "$venv/bin/pip" install --quiet --disable-pip-version-check --no-compile --requirement "$requirements"
  cp "$requirements" "$venv/requirements.txt"
}
(set -e; make_venv) &
cmake -S "$repository" -B "$repository/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADEDGE_TESTS=ON \
  -DQUADEDGE_UNITY=ON "${strict[@]}"
cmake --build "$repository/build"
wait %1

install_python "$venv" -C cmake.define.QUADEDGE_WARNINGS_AS_ERRORS=ON

if $all_runtimes; then "$repository/tests/run_other_runtime.sh" "$repository/build"; fi

# In parallel: many tests use one processor, such as the simulator and everything on the plain C++ reference.
exec ctest --test-dir "$repository/build" --output-on-failure --parallel "$(nproc)" "${slow[@]}" "$@"
