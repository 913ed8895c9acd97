# shellcheck shell=bash
# Intel's OpenCL for CPUs from PyPI, a second implementation beside PoCL. Sourced by run_other_runtime.sh.

# install_intel_runtime VENV: installs it once per version of requirements_intel.txt.
install_intel_runtime() {
  local requirements
  requirements="$(dirname "${BASH_SOURCE[0]}")/requirements_intel.txt"
  cmp -s "$requirements" "$1/requirements_intel.txt" && return
  [ -x "$1/bin/pip" ] || python3 -m venv "$1"
  echo "Installing Intel's OpenCL runtime into $1"
  "$1/bin/pip" install --quiet --disable-pip-version-check --requirement "$requirements" || {
    echo "Intel's OpenCL runtime cannot be installed from PyPI, see above" >&2
    return 1
  }
  cp "$requirements" "$1/requirements_intel.txt"
}
