#!/usr/bin/env bash
# Builds QuadEdge for ARM64 on an x86-64 machine with Debian 12 and runs it under emulation (QEMU), on PoCL for ARM64:
# the tests of all kernels and of the poses, then the same frames as on x86-64, and compares their poses
# (compare_poses.py). Makes the wheel and uses it in a bare root. Needs the rights of root and, for the wheel, Linux 6.7
# (emulate_arm64.sh), but neither containers nor a change of the machine's settings.
#   run_arm64.sh BUILD
# BUILD: what scripts/run.sh has built of the same commit. Root, build and built kernels stay in BUILD/arm64* for the
# next call; the wheel is in BUILD/arm64-wheel.
set -euo pipefail
build="$(realpath "$1")"
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
root="$build/arm64-root" arm="$build/arm64" kept="$build/arm64-run"
. "$here/../scripts/packages.sh"
install_missing mmdebstrap debootstrap qemu-user-static g++-aarch64-linux-gnu

# Packages are unpacked, not configured: what configures them are ARM64 programs, which this machine starts only if QEMU
# is registered with its kernel.
packages="${build_packages/build-essential cmake ninja-build/} catch2 libopencv-imgcodecs-dev libopencv-calib3d-dev
  libpython3-dev"
if [ "$(cat "$root/packages" 2>/dev/null)" != "$packages" ]; then
  rm -rf "$root"
  mmdebstrap --quiet --variant=extract --architectures=arm64 --include="$(echo $packages)" bookworm "$root"
  rm -r "$root/usr/share/doc"  # its links lead nowhere; lint_links.py reads all pages of a folder
  libraries="$root/usr/lib/aarch64-linux-gnu"
  find "$libraries" -type l -lname '/*' | while read -r link; do  # they shall lead into this root
    ln -sfnr "$root$(readlink "$link")" "$link"
  done
  ln -s blas/libblas.so.3 lapack/liblapack.so.3 "$libraries"  # as update-alternatives does
  echo "$packages" >"$root/packages"
fi

start=$SECONDS
export ARM64_ROOT="$root" CMAKE_TOOLCHAIN_FILE="$here/arm64.cmake"
cmake -S "$here/.." -B "$arm" -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADEDGE_TESTS=ON -DQUADEDGE_UNITY=ON \
  >"$build/arm64.log" || { cat "$build/arm64.log" >&2; exit 1; }
cmake --build "$arm" --target quadedge_program quadedge_tests
echo "Built in $((SECONDS - start)) s"

# QEMU opens files of the root in place of this machine's, but asks this machine whether a file exists, and starts this
# machine's programs. So PoCL is named with its full path, beside which it finds its built-in functions, and the linker
# that it starts is the one for ARM64 of this machine.
mkdir -p "$kept"/{bin,vendors}
echo "$root/usr/lib/aarch64-linux-gnu/$(cat "$root/etc/OpenCL/vendors/pocl.icd")" >"$kept/vendors/pocl.icd"
cat >"$kept/bin/aarch64-unknown-linux-gnu-ld" <<END
#!/usr/bin/env bash
exec aarch64-linux-gnu-ld --sysroot='$root' "\${@/#-L/-L$root}"
END
chmod +x "$kept/bin/aarch64-unknown-linux-gnu-ld"
emulated() {  # on the processor of a Raspberry Pi 5
  env PATH="$kept/bin:$PATH" OCL_ICD_VENDORS="$kept/vendors" XDG_CACHE_HOME="$kept/cache" \
    QUADEDGE_TEST_CACHE="$kept/cache" qemu-aarch64-static -L "$root" -cpu cortex-a76 "$@"
}
emulated "$arm/quadedge" devices

# The tests that are small enough for a simulator (run_oclgrind.sh): every kernel against its reference, and two frames.
# And the poses' tests without a device. No test that starts the program: this machine does not start ARM64 programs.
# Left out: a kernel for GPUs, which fails there (doc/install.md).
start=$SECONDS
emulated "$arm/tests/quadedge_tests" "[oclgrind]~\"sift: every device*\",[pose]~[device]~[cli]~[real]"
echo "Tests on ARM64: $((SECONDS - start)) s"

# both NAME ARGUMENT...: runs `quadedge ARGUMENT...` on both processors and compares the poses.
both() {
  local name=$1
  shift
  "$build/quadedge" "$@" --quiet --force -o "$kept/$name-x86" >/dev/null
  emulated "$arm/quadedge" "$@" --quiet --force -o "$kept/$name-arm" >/dev/null
  echo -n "$name: "
  python3 "$here/compare_poses.py" "$kept/$name-x86" "$kept/$name-arm"
}
both room demo --size 320x166 --frames 6 --device portable
both reference demo --size 320x166 --frames 3 --device reference

# The wheel. Its stub is that of a wheel for this machine.
start=$SECONDS
env -u ARM64_ROOT -u CMAKE_TOOLCHAIN_FILE "$here/../scripts/build_wheel.sh" "$build/wheel/built" "$build/wheel" "$build"
QUADEDGE_STUB="$(ls "$build"/wheel/cp3*-linux_x86_64/_quadedge.pyi | head -n 1)" \
  "$here/../scripts/build_wheel.sh" "$build/arm64-wheel" "$arm/wheel" "$arm"
EMULATE=arm64 "$here/run_wheel.sh" "$build/arm64-wheel" "$build/wheel_test"
echo "Wheel: $((SECONDS - start)) s"
