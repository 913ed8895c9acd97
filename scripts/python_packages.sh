# The Python package in a virtual environment, from the library that is built already; only its bindings are compiled.
# Sourced by run.sh and test.sh, which set `repository`.

# install_python VENV [OPTION OF PIP...]: into an environment that has what building and running it need.
install_python() {
  "$1/bin/pip" install --quiet --disable-pip-version-check --no-build-isolation "$repository" \
    -C cmake.source-dir=python -C build-dir="$repository/build/python" \
    -C cmake.define.quadedge_DIR="$repository/build" "${@:2}" && touch "$1/quadedge.stamp"
}

# prepare_python VENV: creates the environment with what pages, `quadedge batch` and `python -m quadedge.matching` need,
# unless it has all that and is as new as the sources. Needs the network the first time.
prepare_python() {
  local sources=("$repository"/{python,pyproject.toml,build/quadedge}) stamp="$1/quadedge.stamp"
  [ -e "$stamp" ] && [ -z "$(find "${sources[@]}" -type f -newer "$stamp" ! -name '*.pyc')" ] && return 0
  echo "Installing the Python package into $1"
  { [ -x "$1/bin/pip" ] || python3 -m venv "$1"; } &&
    "$1/bin/python" -c 'import sys, tomllib; it = tomllib.load(open(sys.argv[1], "rb")); own = it["project"]
print(*it["build-system"]["requires"], *own["dependencies"], *own["optional-dependencies"]["batch"], sep="\n")' \
      "$repository/pyproject.toml" >"$1/requires.txt" &&
    "$1/bin/pip" install --quiet --disable-pip-version-check --requirement "$1/requires.txt" &&
    install_python "$1"
}
