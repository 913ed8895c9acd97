#!/usr/bin/env bash
# Installs everything, builds the examples against the installed copy, and runs them.
#   run_examples.sh BUILD_FOLDER EXAMPLES
set -euo pipefail
build="$(cd "$1" && pwd)" source="$2"
prefix="$build/prefix" work="$build/examples"
rm -rf "$prefix" "$work" && mkdir -p "$work/robot"
cmake --install "$build" --prefix "$prefix" >/dev/null
documents=share/doc/quadedge
for file in bin/quadedge include/quadedge/odometry.hpp share/quadedge/paper.toml share/man/man1/quadedge.1 \
  share/bash-completion/completions/quadedge include/quadedge/constants.inc "$documents"/{README,CHANGELOG}.md \
  "$documents"/{LICENSE,examples/CMakeLists.txt} "$documents"/doc/{accuracy,design,matching,method}.md; do
  [ -f "$prefix/$file" ] || { echo "not installed: $file" >&2; exit 1; }
done
python3 "$(dirname "${BASH_SOURCE[0]}")/lint_links.py" "$prefix/$documents"
# The targets of scripts/run.sh suffice to install.
ninja -C "$build" -t commands quadedge_program >"$build/program_commands"
grep -q manual_page.sh "$build/program_commands" || { echo "quadedge_program does not write quadedge.1" >&2; exit 1; }
cmake -S "$source" -B "$work" -G Ninja -DCMAKE_PREFIX_PATH="$prefix"
cmake --build "$work"  # then as part of another project: the targets have the same names
printf 'cmake_minimum_required(VERSION 3.22)\nproject(r CXX)\nadd_subdirectory(%s quadedge)\nadd_executable(robot %s)
target_link_libraries(robot quadedge::quadedge quadedge::quadedge_core)\n' "$source/.." "$source/03_own_images.cpp" \
  >"$work/robot/CMakeLists.txt"
cmake -S "$work/robot" -B "$work/robot/build" -G Ninja >/dev/null

quadedge="$prefix/bin/quadedge"
"$quadedge" synth "$work/room" --scene room --frames 3 --size 320x200 --quiet

"$work/01_track_recording" "$work/room" "$work/trajectory.txt"
[ "$(grep -vc '^#' "$work/trajectory.txt")" -eq 3 ]
"$quadedge" evaluate trajectory "$work/trajectory.txt" "$work/room"
status=0
"$work/01_track_recording" "$work/absent" "$work/trajectory.txt" 2>"$work/error" || status=$?
[ "$status" -eq 3 ] && grep "absent" "$work/error"

image="$(find "$work/room/rgb" -name '*.png' | sort | head -n 1)"
"$work/02_detect_edges" "$image" >"$work/edges.csv"
"$quadedge" edges "$image" --device reference --edges.threshold 4 --csv "$work/expected.csv" --quiet
edges="$(wc -l <"$work/edges.csv")"
[ "$edges" -gt 1000 ] && [ "$edges" -eq "$(wc -l <"$work/expected.csv")" ]

"$quadedge" check "$work/room" --kalibr "$work/camchain.yaml" --quiet
"$work/03_own_images" "$work/camchain.yaml" | tee "$work/frames.txt"
[ "$(grep -c '^tracked' "$work/frames.txt")" -eq 4 ] && [ "$(grep -c '^lost' "$work/frames.txt")" -eq 1 ]
