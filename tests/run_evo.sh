#!/usr/bin/env bash
# Tracks rendered sequences, alone and in a batch, and compares the errors that QuadEdge reports with evo's.
#   run_evo.sh QUADEDGE PYTHON_WITH_EVO COMPARE_SCRIPT
set -euo pipefail
quadedge="$1" python="$2" compare="$3"
if [ ! -x "$python" ]; then
  echo "$python is missing; scripts/test.sh creates the virtual environment with evo"
  exit 1
fi
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
"$quadedge" synth "$folder/room" --frames 8 --size 480x300 --quiet
"$quadedge" run "$folder/room" -o "$folder/run" --quiet >/dev/null
truth="$folder/room/groundtruth.txt"
compare() { echo "evo against $3"; "$python" "$compare" "$@"; }
# The errors in `run`'s report, and those of `evaluate trajectory`, also from a later frame on.
compare "$folder/run/trajectory.txt" "$truth" "$folder/run/report.json"
# t_rel and r_rel over sub-paths: a recording that is long enough for several starts.
"$quadedge" synth "$folder/long" --frames 40 --size 160x100 --quiet
"$quadedge" run "$folder/long" -o "$folder/long_run" --quiet >/dev/null
"$quadedge" evaluate trajectory "$folder/long_run/trajectory.txt" "$folder/long" --lengths 0.1,0.25 \
  --json "$folder/long.json" | grep "^0.25 "
compare "$folder/long_run/trajectory.txt" "$folder/long/groundtruth.txt" "$folder/long.json"
for from in 0 3; do
  "$quadedge" evaluate trajectory "$folder/run/trajectory.txt" "$truth" --from-frame $from \
    --json "$folder/from$from.json" >/dev/null
  compare "$folder/run/trajectory.txt" "$truth" "$folder/from$from.json" --from-frame $from
done
# The errors of each segment by itself.
sed '6i # segment 1: an unknown motion' "$folder/run/trajectory.txt" >"$folder/segments.txt"
"$quadedge" evaluate trajectory "$folder/segments.txt" "$truth" --json "$folder/segments.json" >/dev/null
for segment in 0 1; do compare "$folder/segments.txt" "$truth" "$folder/segments.json" --segment $segment; done
# A recording whose halves show two scenes, so that the motion between them is unknown: evo reads a file per segment.
"$quadedge" synth "$folder/facade" --scene facade --frames 8 --size 480x300 --quiet
for side in rgb rgb2; do
  cp -r "$folder/room/$side" "$folder/cut_$side"
  for image in $(ls "$folder/room/$side" | tail -n 4); do cp "$folder/facade/$side/$image" "$folder/cut_$side/"; done
done
"$quadedge" check "$folder/room" --write-calibration "$folder/rig.yaml" --quiet >/dev/null
"$quadedge" run --left "$folder/cut_rgb" --right "$folder/cut_rgb2" --fps 20 --calibration "$folder/rig.yaml" \
  -o "$folder/cut" --min-tracked 0 --quiet >/dev/null
for segment in 0 1; do
  file="$folder/cut/trajectory_segment_$segment.txt"
  "$quadedge" evaluate trajectory "$file" "$file" --json "$folder/same.json" --force >/dev/null
  compare "$file" "$file" "$folder/same.json"
done
for file in trajectory.txt trajectory_kitti.txt; do
  "$quadedge" evaluate trajectory "$folder/cut/$file" "$folder/cut/$file" 2>&1 >/dev/null |
    grep "the motions between its 2 segments are unknown"
done
# The errors of each sequence in a batch summary; the ground truth is the run's copy.
"$quadedge" synth "$folder/batch/cables" --scene cables --frames 6 --size 320x200 --quiet
"$quadedge" synth "$folder/batch/facade" --scene facade --path handheld --frames 6 --size 320x200 --quiet
mv "$folder/room" "$folder/batch/room"
QUADEDGE_PYTHON="$python" "$quadedge" batch "$folder/batch" -o "$folder/out" --quiet >/dev/null
for name in room cables facade; do
  compare "$folder/out/sequences/$name/trajectory.txt" "$folder/out/sequences/$name/groundtruth.txt" \
    "$folder/out/summary.json" --sequence $name
done
