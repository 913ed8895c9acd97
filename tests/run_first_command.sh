#!/usr/bin/env bash
# After scripts/run.sh alone, in a copy of the tracked files, `report`, `batch` and `python -m quadedge.matching` run.
#   run_first_command.sh REPOSITORY BUILD WORK
# Objects that BUILD has are taken from there instead of compiling them again.
set -euo pipefail
repository="$(realpath "$1")" built="$(realpath "$2")"
rm -rf "$3"
mkdir -p "$3/clone"
work="$(realpath "$3")" clone="$(realpath "$3")/clone"
git -C "$repository" ls-files -z | tar -C "$repository" --null --files-from=- -c | tar -C "$clone" -x

# As CMAKE_CXX_COMPILER_LAUNCHER: COMPILER OPTION...
cat >"$work/launcher" <<END
#!/usr/bin/env bash
for ((i = 1; i < \$#; ++i)); do
  next=\$((i + 1))
  case "\${!i}" in -o) object="\${!next}" ;; -MF) depends="\${!next}" ;; esac
done
found="$built/\${PWD#$clone/build}/\${object:-none}"
[ -f "\$found" ] && [ -n "\${depends:-}" ] || exec "\$@"
cp "\$found" "\$object"
echo "\$object:" >"\$depends"
END
chmod +x "$work/launcher"

export CMAKE_CXX_COMPILER_LAUNCHER="$work/launcher"
unset QUADEDGE_PYTHON PYTHONPATH
cd "$work"
"$built/quadedge" synth recordings/room --frames 3 --size 160x100 --quiet
"$clone/scripts/run.sh" recordings/room --device reference -o run
export PATH=/usr/bin:/bin
"$clone/build/quadedge" report run
"$clone/build/quadedge" batch recordings -o batch --device reference
"$clone/build/quadedge" report batch
"$clone/build/venv/bin/python" -m quadedge.matching room --frames 1 --size 160x100 --device reference \
  --html matching.html
for page in run/report.html batch/report.html matching.html; do
  [ -s $page ] || { echo "$page is missing" >&2; exit 1; }
done
