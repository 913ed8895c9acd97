#!/usr/bin/env bash
# Packs a folder of at most 60 MiB that measures QuadEdge on a machine with an OpenCL driver, a C library and a shell,
# but without network, OpenCV or Python: OUT/run.sh does everything there (doc/performance.md, "Measure a GPU").
#   scripts/device_kit.sh OUT WHEEL [DATA [FRAMES]]
# WHEEL: a wheel by scripts/build_wheel.sh, of which the kit takes the program and its libraries. DATA: folder of
# recorded data; FRAMES (default: 24) of KITTI 06 and of EuRoC's flight go into OUT: keep to their licences.
set -euo pipefail
if [ $# -lt 2 ] || [ $# -gt 4 ]; then
  sed -n '2,6s/^# //p' "$0" >&2
  exit 2
fi
repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
data="${3:-}" frames="${4:-24}" limit_mb=60
if [ -e "$1" ] && [ -n "$(ls -A "$1")" ]; then
  echo "device_kit: $1 is not empty" >&2
  exit 2
fi
mkdir -p "$1"/{lib,data}
out="$(realpath "$1")"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

python3 -m zipfile -e "$2" "$work/wheel"
mkdir "$out/quadedge"
cp -R "$work/wheel/quadedge/bin" "$out/quadedge/"
cp -R "$work/wheel/quadedge.libs" "$out/"
quadedge="$out/quadedge/bin/quadedge"
chmod +x "$quadedge"

# What the wheel expects of every machine with Python, and a loader, under the names that carry the versions: run.sh
# takes whatever is newer, these or the machine's own.
{
  ldd "$quadedge" "$out"/quadedge/bin/*.so | sed -n 's|.* => \(/[^ ]*\) .*|\1|p' | grep -v "^$out/" |
    grep -vE '/(libc|libm|libdl|librt|libpthread)\.so'
  ldconfig -p | sed -n 's|.*libOpenCL\.so\.1 .*x86-64.*=> ||p' | head -n 1
} | sort -u | while read -r file; do
  real="$(realpath "$file")" name="$(basename "$file")"
  cp "$real" "$out/lib/"
  [ "$(basename "$real")" = "$name" ] || ln -s "$(basename "$real")" "$out/lib/$name"
done

# copy_frames NAME TARGET: the first frames of a sequence, in its own layout.
copy_frames() {
  local camera image
  case "$1" in
    kitti06)
      mkdir -p "$2"/image_{0,1}
      cp "$data/$path/calib.txt" "$2/"
      head -n "$frames" "$data/$path/times.txt" >"$2/times.txt"
      for image in $(find "$data/$path/image_0" -name '*.png' -printf '%f\n' | sort | head -n "$frames"); do
        for camera in 0 1; do cp "$data/$path/image_$camera/$image" "$2/image_$camera/"; done
      done
      ;;
    flight)
      for camera in cam0 cam1; do
        mkdir -p "$2/mav0/$camera/data"
        cp "$data/$path/mav0/$camera/sensor.yaml" "$2/mav0/$camera/"
        head -n "$((frames + 1))" "$data/$path/mav0/$camera/data.csv" >"$2/mav0/$camera/data.csv"
        for image in $(sed '1d;s/.*,//;s/\r//' "$2/mav0/$camera/data.csv"); do
          cp "$data/$path/mav0/$camera/data/$image" "$2/mav0/$camera/data/"
        done
      done
      ;;
  esac
}

echo "$frames" >"$out/frames"
while read -r name path; do
  if [ "$name" != room ]; then
    if [ ! -d "${data:-/nowhere}/$path" ]; then
      echo "device_kit: without $name: no folder ${data:-DATA}/$path" >&2
      continue
    fi
    copy_frames "$name" "$out/data/$name"
  fi
  track=(run "$out/data/$name")
  [ "$name" != room ] || track=(demo --frames "$frames")
  "$quadedge" "${track[@]}" --device cpu --output "$work/$name" --quiet >"$work/log" || { cat "$work/log" >&2; exit 1; }
  cp "$work/$name/trajectory.txt" "$out/data/$name.txt"
done <<'END'
room -
kitti06 kitti_odometry/sequences/06
flight euroc_mh_01_easy
END
sed -n '/^  "device": {/,/}/s/.*"name": "\(.*\)",/\1/p' "$work/room/report.json" >"$out/recorded_on"
sed -n 's/^  "commit": "\(.*\)",/\1/p' "$work/room/report.json" >"$out/commit"
cp "$repository/scripts/device_kit_run.sh" "$out/run.sh"
cp "$repository/LICENSE" "$out/"
size_mb="$(du -sm --apparent-size "$out" | cut -f 1)"
echo "$out: $size_mb MiB; needs the C library $(find "$out" -type f \( -name 'quadedge' -o -name '*.so*' \) -print0 |
  xargs -0 objdump -T 2>/dev/null | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -n 1)"
if [ "$size_mb" -gt "$limit_mb" ]; then
  echo "device_kit: more than $limit_mb MiB" >&2
  exit 1
fi
