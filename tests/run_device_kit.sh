#!/usr/bin/env bash
# Packs the device kit, checks its size, and runs it on PoCL with OpenCV and Debian's libtbb hidden: the page has every
# table and no failure.
#   run_device_kit.sh REPOSITORY WHEEL_FOLDER WORK      writes the page to WORK/results
set -euo pipefail
repository="$1" wheel=("$2"/quadedge-*-manylinux_2_35_*.whl) work="$3"
frames=8 minutes=60  # of limits: a CPU is slower than a GPU, and other tests run at the same time
rm -rf "$work"
mkdir -p "$work"
"$repository/scripts/device_kit.sh" "$work/kit" "${wheel[0]}" "${QUADEDGE_DATA:-}" "$frames"

# Without permission to mount, the libraries stay visible.
if unshare -rm true 2>/dev/null; then
  unshare -rm bash -c 'for file in $(ldconfig -p | sed -n "s/.*=> //p" | grep -E "/lib(opencv_|tbb)"); do
    mount --bind /dev/null "$file"
  done
  exec "$@"' bash "$work/kit/run.sh" auto "$work/results" "$minutes"
else
  "$work/kit/run.sh" auto "$work/results" "$minutes"
fi

page="$work/results/page.md"
for heading in Latency Poses Parts Device 'Kernel variants' Details; do
  grep -qx "## $heading" "$page" || { echo "$page lacks $heading" >&2; exit 1; }
done
if grep -nE 'TIMED OUT|FAILED|REFUSED|CANNOT RUN' "$page" >&2; then exit 1; fi
grep -q 'self-test: passed' "$page"
sequences=1
[ -z "${QUADEDGE_DATA:-}" ] || sequences=3
[ "$(grep -cE '^\| [a-z0-9]+ \| (fast|default|dense)( \| [0-9]+\.[0-9]+){4} \|$' "$page")" -eq $((3 * sequences)) ]
[ "$(grep -cE "^\| [a-z0-9]+ \| $frames \| 0 \| yes \| 0 \|$" "$page")" -eq "$sequences" ]
