#!/usr/bin/env bash
# Installs the wheel where only Python is available, and uses it like a new user: in a root created by debootstrap if
# permitted, else in a virtual environment, where no library of Debian's OpenCV may be loaded.
#   run_wheel.sh WHEEL_FOLDER WORK [SUITE MIRROR]
# A wheel for Ubuntu 22.04 is tried with jammy and http://archive.ubuntu.com/ubuntu, and PYTHON, a Python 3.10.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
work="$(realpath -m "$2")" suite="${3:-bookworm}" mirror="${4:-http://deb.debian.org/debian}"
root="$work/$suite"
rm -rf "$work/wheels"
mkdir -p "$work/wheels"
cp "$1"/quadedge-*-manylinux_2_35_*.whl "$work/wheels/"
wheel=("$work"/wheels/quadedge-*.whl)
[ ${#wheel[@]} -eq 1 ]
limit=$((15 * 1000 * 1000))
[ "$(stat -c %s "$wheel")" -le $limit ] || { echo "$wheel: more than $limit bytes" >&2; exit 1; }

# The files that pip would download; the root has no network.
"${PYTHON:-python3}" -m pip download --quiet --disable-pip-version-check --dest "$work/wheels" "$wheel[cpu]"
cp "$here/wheel_user.sh" "$here/wheel_user.py" "$work/wheels"

may_make_roots() { [ "$(id -u)" -eq 0 ] && command -v debootstrap >/dev/null && unshare --mount true 2>/dev/null; }
if may_make_roots; then
  [ -x "$root/usr/bin/python3" ] || { rm -rf "$root"
    components=main keys=()
    [ "$suite" = bookworm ] || components=main,universe keys=(--no-check-gpg)  # Debian has no keys of others
    debootstrap "${keys[@]}" --variant=minbase --components="$components" --include=python3,python3-venv \
      "$suite" "$root" "$mirror" >"$work/debootstrap.log" ||
      { tail -n 5 "$work/debootstrap.log" >&2; exit 1; }; }
  rm -rf "$root/user" && mkdir -p "$root/user"
  # Mounts end with this shell, because they are in its namespace.
  unshare --mount bash -ec '
    mkdir -p "$1/wheels"
    mount --bind "$2" "$1/wheels"
    mount --rbind /dev "$1/dev"
    mount --rbind /sys "$1/sys"
    mount -t proc proc "$1/proc"
    exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/user TERM=dumb \
      chroot "$1" bash -e /wheels/wheel_user.sh /wheels /user' \
    bash "$root" "$work/wheels"
else
  rm -rf "$work/user" && mkdir -p "$work/user"
  env OCL_ICD_VENDORS="$work/user" HOME="$work/user" bash -e "$here/wheel_user.sh" "$work/wheels" "$work/user"
fi
