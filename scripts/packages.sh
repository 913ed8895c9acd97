# Installs Debian packages that are missing. Sourced by run.sh, test.sh and the Dockerfile.

build_packages="build-essential cmake ninja-build pocl-opencl-icd ocl-icd-opencl-dev opencl-clhpp-headers opencl-headers
  libeigen3-dev libtbb-dev libopencv-features2d-dev libpng-dev libjpeg-dev libcli11-dev
  nlohmann-json3-dev libyaml-cpp-dev libtomlplusplus-dev libxxhash-dev"
python_packages="python3-dev python3-venv"  # for `pip install .`, besides those above
test_packages="catch2 libopencv-imgcodecs-dev libopencv-calib3d-dev curl ffmpeg file
  oclgrind clang debootstrap clang-format p7zip-full munge slurmctld slurmd slurm-client
  libfastrtps-dev fastddsgen default-jre-headless ros-sensor-msgs ros-nav-msgs ros-tf2-msgs ros-diagnostic-msgs"

# install_missing PACKAGE...: asks dpkg first: a machine with all packages needs neither network nor root.
install_missing() {
  local missing=() package root=()
  for package in "$@"; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
      missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "These Debian packages are missing; installing them needs root or sudo: ${missing[*]}" >&2
      return 1
    fi
    root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
}
