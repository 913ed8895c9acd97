#!/usr/bin/env bash
# Builds the device kit, checks its size, and runs it on PoCL and on Intel's OpenCL for CPUs, with OpenCV and Debian's
# libtbb hidden. Self-test, device tests, variants, stages and poses must all succeed.
#   run_device_kit.sh REPOSITORY BUILD      writes the pages to BUILD/device_kit/results_RUNTIME
set -euo pipefail
repository="$1" build="$(realpath "$2")"
kit="$build/device_kit/kit" minutes=120  # of limits: CPUs are slower than GPUs, and other tests run at the same time
. "$repository/tests/intel_runtime.sh"
install_intel_runtime "$build/venv"
rm -rf "$kit"
"$repository/scripts/device_kit.sh" "$kit" "$build"

# hidden COMMAND...: runs the command with these libraries replaced by empty files. Without permission to mount, the
# page's list of loaded libraries is the only check.
hidden() {
  if unshare -rm true 2>/dev/null; then
    unshare -rm bash -c 'for file in $(ldconfig -p | sed -n "s/.*=> //p" | grep -E "/lib(opencv_|tbb)"); do
      mount --bind /dev/null "$file"
    done
    exec "$@"' bash "$@"
  else
    "$@"
  fi
}

# holds PAGE RUNTIME: checks that the page has every table and no failure.
holds() {
  local heading
  for heading in Parts Drivers Device Self-test 'Device tests' 'Building the programs' 'Kernel variants' Latency \
    'Where a frame goes' 'Results of each stage' Poses; do
    grep -qx "## $heading" "$1" || { echo "$1 lacks $heading" >&2; return 1; }
  done
  # With the preset dense, Intel's runtime gives two poses of KITTI 06 that differ by up to 0.5 mm from PoCL's.
  local known='^$'
  [ "$2" = pocl ] || known='\| kitti06 \| dense \| 12 of 12 \|'
  if grep -nE 'TIMED OUT|FAIL|DIFFER|cannot run|tests that did not pass|libopencv' "$1" | grep -vE "$known" >&2; then
    return 1
  fi
  [ "$(($(grep -c '^poses' "$(dirname "$1")/rows.tsv") % 3))" = 0 ]  # presets
  [ "$(find "$(dirname "$1")" -type f | wc -l)" -le 8 ]
}

status=0
for runtime in pocl intel; do
  results="$build/device_kit/results_$runtime"
  rm -rf "$results"
  driver=''  # run.sh finds PoCL
  [ "$runtime" = pocl ] || driver="$build/venv/lib/libintelocl.so"
  DEVICE_KIT_DRIVER="$driver" hidden "$kit/run.sh" "$results" "$minutes"
  if [ "$runtime" = pocl ]; then grep -q "^| libraries .*$kit/lib/libtbb" "$results/page.md" || status=1; fi
  holds "$results/page.md" "$runtime" || status=1
done
exit $status
