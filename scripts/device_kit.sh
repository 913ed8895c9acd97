#!/usr/bin/env bash
# Builds a folder that measures QuadEdge on a machine with an OpenCL driver, a C library and a shell, but without
# network, OpenCV or Python. OUT/run.sh runs everything there (doc/performance.md, "Measure a GPU").
#   scripts/device_kit.sh OUT [BUILD]      BUILD: folder of the builds; default: build
# The frames of KITTI 06 and of EuRoC's flight go into OUT where QUADEDGE_DATA has them: keep to their licences.
set -euo pipefail
if [ $# -lt 1 ] || [ $# -gt 2 ]; then
  sed -n '2,6s/^# //p' "$0" >&2
  exit 2
fi
repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
build="$(realpath -m "${2:-$repository/build}")"
core="$build/device_kit" limit_mb=60
if [ -e "$1" ] && [ -n "$(ls -A "$1")" ]; then
  echo "device_kit: $1 is not empty" >&2
  exit 2
fi
mkdir -p "$1"/{bin,lib,data}
out="$(realpath "$1")"

options=(-G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADEDGE_UNITY=ON)
[ -f "$build/CMakeCache.txt" ] || cmake -S "$repository" -B "$build" "${options[@]}"
cmake --build "$build" --target kit_frames
cmake -S "$repository" -B "$core" "${options[@]}" -DQUADEDGE_CORE_ONLY=ON
cmake --build "$core" --target device_check quadedge_device_tests
for program in device_check quadedge_device_tests; do
  strip -o "$out/bin/$program" "$core/bench/device_kit/$program"
done

# Under the names that carry the versions: run.sh takes whatever is newer, these or the machine's own.
for library in libOpenCL.so.1 libtbb.so.12 libstdc++.so.6 libgcc_s.so.1; do
  file="$(ldd "$out/bin/device_check" | awk -v name="$library" '$1 == name { print $3 }')"
  [ -n "$file" ] || file="$(ldd "$(ldd "$out/bin/device_check" | awk '/libtbb/ { print $3 }')" |
    awk -v name="$library" '$1 == name { print $3 }')"
  real="$(realpath "$file")"
  cp "$real" "$out/lib/"
  [ "$(basename "$real")" = "$library" ] || ln -s "$(basename "$real")" "$out/lib/$library"
done

export DEVICE_KIT_DATA="$out/data" DEVICE_KIT_DEVICE=cpu
frames="$build/bench/device_kit/kit_frames"
"$frames" presets "$out/data/presets"
while read -r name path; do
  if [ "$path" != - ] && [ ! -d "${QUADEDGE_DATA:-/nowhere}/$path" ]; then
    echo "device_kit: without $name: QUADEDGE_DATA has no $path" >&2
    continue
  fi
  mkdir "$out/data/$name"
  if [ "$path" = - ]; then "$frames" "$name" "$out/data/$name"; else
    "$frames" "$name" "$out/data/$name" "$QUADEDGE_DATA/$path"
  fi
  "$out/bin/device_check" record /dev/null "$name"
done <<'END'
room -
kitti06 kitti_odometry/sequences/06
flight euroc_mh_01_easy
END

git -C "$repository" describe --always --dirty=+ --abbrev=12 --exclude='*' >"$out/commit" 2>/dev/null ||
  echo unknown >"$out/commit"
"$out/bin/device_check" name /dev/null >"$out/recorded_on"
cp "$repository/scripts/device_kit_run.sh" "$out/run.sh"
cp "$repository/LICENSE" "$out/"
size_mb="$(du -sm --apparent-size "$out" | cut -f 1)"
echo "$out: $size_mb MiB; needs the C library $(objdump -T "$out"/bin/* "$out"/lib/* 2>/dev/null |
  grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -1)"
if [ "$size_mb" -gt "$limit_mb" ]; then
  echo "device_kit: more than $limit_mb MiB" >&2
  exit 1
fi
