#!/usr/bin/env bash
# Uses the wheel like a new user; run by run_wheel.sh on a machine without an OpenCL driver.
#   wheel_user.sh WHEELS FOLDER       WHEELS: the wheel and what it depends on; FOLDER: empty, for the environment
set -euo pipefail
wheels="$1"
cd "$2"
python3 -m venv environment
. environment/bin/activate
install() { pip install --quiet --no-compile --disable-pip-version-check --no-index --find-links "$wheels" "$@"; }
expect() { grep -qF -- "$1" "$2" || { echo "expected '$1' in:" >&2; cat "$2" >&2; exit 1; }; }

install quadedge
quadedge --version >version.txt
expect "quadedge 0.2.0" version.txt
python -m quadedge --version | cmp - version.txt
packages="$(python -c 'import sysconfig; print(sysconfig.get_path("platlib"))')"
for file in "$packages"/quadedge/_quadedge*.so "$packages"/quadedge/bin/*; do
  ldd "$file" >libraries.txt
  if grep -E 'not found|OpenCL|/usr/lib.*(opencv|avcodec|tbb|yaml|png|jpeg)' libraries.txt; then
    echo "$file: depends on what a bare machine does not have" >&2
    exit 1
  fi
done

# No driver: one sentence, and the reference works.
python "$wheels/wheel_user.py" auto >no_driver.txt 2>&1 && { echo "expected a DeviceError" >&2; exit 1; }
expect 'no OpenCL device was found: `pip install intel-opencl-rt intel-cmplr-lib-rt`' no_driver.txt
python "$wheels/wheel_user.py" reference >reference.txt
expect "tracked" reference.txt
code=0
quadedge demo --frames 2 --size 160x100 -o none >demo.txt 2>&1 || code=$?
[ $code -eq 4 ] || { echo "expected exit code 4, got $code" >&2; exit 1; }
expect 'no OpenCL device was found' demo.txt

# No ffmpeg: the message names what reads videos. QEMU does not tell posix_spawn() that a program is missing.
if ! command -v ffprobe >/dev/null && [ ! -d /etc/OpenCL/later ]; then
  touch video.mkv
  code=0
  quadedge run --video video.mkv --split left-right --calibration none.yaml -o none >video.txt 2>&1 || code=$?
  [ $code -eq 3 ] || { echo "expected exit code 3, got $code" >&2; exit 1; }
  expect 'needs the program ffprobe' video.txt
fi

install "$(ls "$wheels"/quadedge-*.whl)[cpu]"  # where it has nothing to install, run_wheel.sh has put a driver aside
[ ! -d /etc/OpenCL/later ] || export OCL_ICD_VENDORS=/etc/OpenCL/later
python "$wheels/wheel_user.py" auto >device.txt
expect "tracked" device.txt
quadedge devices
quadedge demo --frames 4 --size 320x200 -o results
quadedge report results
[ -s results/trajectory.txt ] && [ -s results/report.html ]
