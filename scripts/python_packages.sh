# The Python part of the package in a virtual environment, without building anything. Sourced by run.sh and test.sh,
# which set `repository`.

# see_sources VENV: its Python imports `quadedge` from python/, without the compiled module, which pages do not need.
see_sources() {
  local packages
  packages="$("$1/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')"
  echo "$repository/python" >"$packages/quadedge_sources.pth"
}

# install_for_pages VENV: creates the environment with the packages that pages need according to pyproject.toml, unless
# it has them. Fails without network.
install_for_pages() {
  "$1/bin/python" -c 'import quadedge.report' 2>/dev/null && return 0
  echo "Installing the Python packages for report pages into $1"
  python3 -m venv "$1" &&
    "$1/bin/python" -c 'import sys, tomllib
print("\n".join(tomllib.load(open(sys.argv[1], "rb"))["project"]["dependencies"]))' \
      "$repository/pyproject.toml" >"$1/pages.txt" &&
    "$1/bin/pip" install --quiet --disable-pip-version-check --requirement "$1/pages.txt" &&
    see_sources "$1"
}
