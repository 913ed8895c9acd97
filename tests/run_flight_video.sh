#!/usr/bin/env bash
# Checks that a recorded flight as one FFV1 video with both views gives the trajectory of its folders, byte for byte.
#   run_flight_video.sh PROGRAM
# Skipped (exit code 77) if QUADEDGE_DATA has no euroc_mh_01_easy.
set -euo pipefail
program=$1
flight=${QUADEDGE_DATA:-/nowhere}/euroc_mh_01_easy/mav0
[ -d "$flight" ] || exit 77
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
view() { echo "-framerate 20 -pattern_type glob -i $flight/$1/data/*.png"; }
set -f
ffmpeg -v error $(view cam0) $(view cam1) -filter_complex '[0][1]hstack' -pix_fmt gray -frames:v 40 -c:v ffv1 \
  "$folder/flight.mkv"
head -n 41 "$flight/cam0/data.csv" > "$folder/times.csv"
calibration=$flight/cam0/sensor.yaml,$flight/cam1/sensor.yaml
"$program" run "${flight%/mav0}" --frames :40 -o "$folder/folders" --quiet > "$folder/log"
"$program" run --video "$folder/flight.mkv" --split left-right --times "$folder/times.csv" \
  --calibration "$calibration" -o "$folder/video" --quiet >> "$folder/log"
cmp "$folder/folders/trajectory.txt" "$folder/video/trajectory.txt"
[ "$(wc -l < "$folder/video/trajectory_kitti.txt")" = 40 ]
