#!/usr/bin/env bash
# Tests with Intel's OpenCL for CPUs, a second implementation beside PoCL: runs the C++ tests of kernels, pipeline and
# recorded data on it, then the same frames on both, and compares their poses (compare_poses.py). Recorded data is found
# through QUADEDGE_DATA. Built kernels stay in BUILD/other_runtime for the next call.
#   run_other_runtime.sh BUILD
set -euo pipefail
build="$(realpath "$1")"
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
venv="$build/venv" kept="$build/other_runtime"
. "$here/intel_runtime.sh"
install_intel_runtime "$venv"

# Nothing is installed in the system: one folder has only this runtime, another the installed ones too. The program's
# TBB (Debian's) is older than the runtime needs, and the one loaded first serves both.
rm -rf "$kept"/{alone,both}
mkdir -p "$kept"/{alone,both,lib}
echo "$venv/lib/libintelocl.so" | tee "$kept/alone/intel.icd" >"$kept/both/intel.icd"
find -L "${OCL_ICD_VENDORS:-/etc/OpenCL/vendors}" -name '*.icd' -exec cp {} "$kept/both" ';'  # a folder or a file
ln -sf "$venv/lib/libtbb.so.12" "$kept/lib"
export LD_LIBRARY_PATH="$kept/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
export XDG_CACHE_HOME="$kept/cache" OCL_ICD_VENDORS="$kept/both"
devices="$("$build/quadedge" devices)"
for device in 'Intel(R) OpenCL' 'Portable Computing Language'; do
  grep -qF "$device" <<<"$devices" || {
    echo -e "--all-runtimes: no $device device among\n$devices" >&2
    exit 1
  }
done

start=$SECONDS
OCL_ICD_VENDORS="$kept/alone" QUADEDGE_TEST_CACHE="$XDG_CACHE_HOME" \
  "$build/tests/quadedge_tests" "[device]~[cli],[real],[selftest]~[cli],[opencl]"
echo "Tests on Intel's runtime: $((SECONDS - start)) s"

# both NAME ARGUMENT...: runs `quadedge ARGUMENT...` on both runtimes and compares the poses.
both() {
  local name=$1
  shift
  "$build/quadedge" "$@" --device portable --quiet --force -o "$kept/$name-one" >/dev/null
  "$build/quadedge" "$@" --device "intel(r) opencl" --quiet --force -o "$kept/$name-other" >/dev/null
  echo -n "$name: "
  "$venv/bin/python" "$here/compare_poses.py" "$kept/$name-one" "$kept/$name-other"
}
both room demo --frames 12
data="${QUADEDGE_DATA:-/nowhere}"
while read -r sequence frames; do
  if [ -d "$data/$sequence" ]; then
    both "$(basename "$sequence")" run "$data/$sequence" --frames ":$frames" </dev/null
  else
    echo "SKIPPED: no $sequence below QUADEDGE_DATA"
  fi
done <<'END'
kitti_odometry/sequences/01 12
kitti_odometry/sequences/06 12
euroc_v1_01_easy_at_rest 12
euroc_mh_01_easy 12
karlsruhe_quad 2
END
