#!/usr/bin/env bash
# Installs the wheel where only Python is available, and uses it like a new user: in a root created by debootstrap if
# permitted, else in a virtual environment, where no library of Debian's OpenCV may be loaded.
#   run_wheel.sh WHEEL_FOLDER WORK [SUITE MIRROR]
# Other systems need PYTHON, one of the version that they have: "jammy http://archive.ubuntu.com/ubuntu" (Ubuntu 22.04)
# 3.10, trixie (Debian 13) 3.13. Of several wheels in WHEEL_FOLDER, pip takes the one for it.
# EMULATE=arm64: a wheel of run_arm64.sh, in a root for ARM64 with PoCL.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
work="$(realpath -m "$2")" suite="${3:-bookworm}" mirror="${4:-http://deb.debian.org/debian}"
emulate="${EMULATE:-}" root="$work/$suite${EMULATE:+-$EMULATE}"
rm -rf "$work/wheels"
mkdir -p "$work/wheels"

pip_download=("${PYTHON:-python3}" -m pip download --quiet --disable-pip-version-check --dest "$work/wheels")
extra='[cpu]'
if [ -n "$emulate" ]; then
  pip_download+=(--only-binary=:all:) extra=
  for version in 2014 _2_17 _2_28 _2_35; do pip_download+=(--platform "manylinux${version}_aarch64"); done
fi
"${pip_download[@]}" --no-deps --no-index --find-links "$1" quadedge
wheel="$(ls "$work"/wheels/quadedge-*-manylinux_2_35_*.whl)" limit=$((15 * 1000 * 1000))
[ "$(stat -c %s "$wheel")" -le $limit ] || { echo "$wheel: more than $limit bytes" >&2; exit 1; }

# The files that pip would download; the root has no network.
"${pip_download[@]}" "$wheel$extra"
cp "$here/wheel_user.sh" "$here/wheel_user.py" "$work/wheels"

make_root() {
  local options=(--variant=minbase) components=main packages=python3,python3-venv
  [[ "$mirror" != *ubuntu* ]] || { options+=(--no-check-gpg) components+=,universe; }  # Debian has no keys of others
  [ -z "$emulate" ] || { options+=(--foreign --arch="$emulate") packages+=,pocl-opencl-icd,ocl-icd-libopencl1; }
  rm -rf "$root"
  debootstrap "${options[@]}" --components="$components" --include="$packages" "$suite" "$root" "$mirror" || return 1
  [ -n "$emulate" ] || return 0
  container=lxc "$here/emulate_arm64.sh" chroot "$root" /debootstrap/debootstrap --second-stage || return 1
  rm -r "$root/usr/share/doc"  # its links lead nowhere; lint_links.py reads all pages of a folder
  mv "$root/etc/OpenCL/vendors" "$root/etc/OpenCL/later"  # see wheel_user.sh
}
may_make_roots() { [ "$(id -u)" -eq 0 ] && command -v debootstrap >/dev/null && unshare --mount true 2>/dev/null; }
if may_make_roots; then
  [ -e "$root/complete" ] || { make_root >"$work/debootstrap.log" && touch "$root/complete"; } ||
    { tail -n 5 "$work/debootstrap.log" >&2; exit 1; }
  rm -rf "$root/user" && mkdir -p "$root/user"
  # Mounts end with this shell, because they are in its namespace.
  ${emulate:+"$here/emulate_arm64.sh"} unshare --mount bash -ec '
    mkdir -p "$1/wheels"
    mount --bind "$2" "$1/wheels"
    for folder in dev sys proc; do mount --rbind "/$folder" "$1/$folder"; done
    exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/user TERM=dumb \
      chroot "$1" bash -e /wheels/wheel_user.sh /wheels /user' \
    bash "$root" "$work/wheels"
else
  rm -rf "$work/user" && mkdir -p "$work/user"
  env OCL_ICD_VENDORS="$work/user" HOME="$work/user" bash -e "$here/wheel_user.sh" "$work/wheels" "$work/user"
fi
