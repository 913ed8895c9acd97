#!/usr/bin/env bash
# Builds and inspects the Debian packages, unpacks the program's package into an empty root and runs it from there.
#   run_package.sh BUILD_FOLDER
set -euo pipefail
build="$(cd "$1" && pwd)"
work="$build/package"
rm -rf "$work"
cpack --config "$build/CPackConfig.cmake" -B "$work" >"$build/cpack.log" 2>&1 || { cat "$build/cpack.log"; exit 1; }

# expect PACKAGE FIELD PATTERN...: checks that every pattern occurs in the field of the control file.
expect() {
  local package="$1" field="$2" value pattern
  value="$(dpkg-deb --field "$package" "$field")"
  shift 2
  for pattern in "$@"; do
    grep -qE "$pattern" <<<"$value" || { echo "$package: $field is '$value', expected $pattern" >&2; exit 1; }
  done
}
# holds PACKAGE PATH...: checks that the package has the files.
holds() {
  local package="$1" content path
  content="$(dpkg-deb --contents "$package" | awk '{print $6}')"
  shift
  for path in "$@"; do
    grep -qxE "\./$path" <<<"$content" || { echo "$package: no $path in it" >&2; exit 1; }
  done
}

program=("$work"/quadedge_*.deb) development=("$work"/libquadedge-dev_*.deb)
[ ${#program[@]} -eq 1 ] && [ ${#development[@]} -eq 1 ]
version="$("$build/quadedge" --version | grep -oE '[0-9]+\.[0-9]+\.[0-9]+' | head -n 1)"
expect "$program" Package '^quadedge$'
expect "$program" Version "^${version//./\\.}$"
expect "$program" Architecture "^$(dpkg --print-architecture)$"
expect "$program" Maintainer '<.+@.+>'
expect "$program" Description 'stereo visual odometry'
expect "$program" Depends 'libc6 \(>= ' 'ocl-icd-libopencl1|libopencl1' libtbb12 libopencv-imgproc \
  libyaml-cpp libpng libjpeg
expect "$program" Recommends pocl-opencl-icd ffmpeg
if dpkg-deb --field "$program" Depends | grep -qe -dev -e imgcodecs -e libav; then
  echo "$program: depends on a development package, OpenCV's imgcodecs or FFmpeg's libraries" >&2
  exit 1
fi
holds "$program" usr/bin/quadedge usr/share/quadedge/paper.toml \
  usr/share/man/man1/quadedge.1 usr/share/bash-completion/completions/quadedge \
  usr/share/doc/quadedge/{LICENSE,README.md,CHANGELOG.md,doc/method.md,examples/01_track_recording.cpp}
expect "$development" Depends libeigen3-dev libtbb-dev ocl-icd-opencl-dev libopencv-features2d-dev libpng-dev \
  libyaml-cpp-dev libjpeg-dev
holds "$development" usr/include/quadedge/odometry.hpp 'usr/lib/.*libquadedge.a' 'usr/lib/.*libquadedge_core.a' \
  'usr/lib/.*cmake/quadedge/quadedgeConfig.cmake'

root="$work/root"
dpkg-deb --extract "$program" "$root"
cd "$work"  # so that no source file is found by a relative path
"$root/usr/bin/quadedge" --version
"$root/usr/bin/quadedge" demo --size 320x200 --frames 2 --config "$root/usr/share/quadedge/paper.toml" \
  --output "$work/demo" --quiet
[ -s "$work/demo/trajectory.txt" ]
du -h "$program" "$development"
