#!/bin/sh
# Measures QuadEdge on this machine's OpenCL device: self-test, equality of all kernel variants, latency, equality with
# a CPU's poses. Needs an OpenCL driver, a C library, a shell and coreutils.
#   run.sh [DEVICE [RESULTS [MINUTES]]]      default: auto (a GPU where there is one), ./results, 8 minutes
# DEVICE: as for --device of quadedge. RESULTS/page.md has everything; log.txt what the programs printed.
# DEVICE_KIT_DRIVER=FILE uses this OpenCL driver instead of those of the machine.
set -u
kit="$(cd "$(dirname "$0")" && pwd)"
results="${2:-results}"
total=$((${3:-8} * 60)) frames="$(cat "$kit/frames")"
mkdir -p "$results" || exit 2
results="$(cd "$results" && pwd)"
work="$(mktemp -d)" || exit 2
trap 'rm -rf "$work"' EXIT
[ -z "${DEVICE_KIT_DRIVER:-}" ] || DEVICE_KIT_DRIVER="$(realpath "$DEVICE_KIT_DRIVER")"
cd "$kit" || exit 2
mkdir "$work/lib" "$work/vendors" "$work/parts"
log="$results/log.txt" page="$results/page.md"
: >"$log"
own_libraries="${LD_LIBRARY_PATH:-}" own_vendors="${OCL_ICD_VENDORS:-/etc/OpenCL/vendors}"
export QUADEDGE_DEVICE="${1:-auto}" CUDA_VISIBLE_DEVICES="${CUDA_VISIBLE_DEVICES:-0}"
# What drivers and the program keep goes here; nothing of the user's is read or changed.
export HOME="$work" XDG_CACHE_HOME="$work" XDG_CONFIG_HOME="$work" CUDA_CACHE_PATH="$work" POCL_CACHE_DIR="$work"
quadedge() { "$kit/quadedge/bin/quadedge" "$@"; }

# part SECONDS NAME COMMAND...: runs a command of quadedge for at most SECONDS of 480, and notes what became of it.
part() {
  limit=$(($1 * total / 480)) name="$2"
  shift 2
  start="$(date +%s)"
  timeout -s KILL "$limit" "$kit/quadedge/bin/quadedge" "$@" >"$work/out" 2>&1
  code=$?
  case $code in
    0) outcome='done' ;;
    124 | 137) outcome="TIMED OUT after $limit s" ;;
    *) outcome="FAILED with code $code: $(tail -n 1 "$work/out")" ;;
  esac
  { echo "== $name" && cat "$work/out"; } >>"$log"
  echo "$name: $outcome"
  echo "| $name | $outcome | $(($(date +%s) - start)) |" >>"$work/parts/table"
  return $code
}

# system_library NAME: the machine's own, or nothing.
system_library() { ldconfig -p 2>/dev/null | sed -n "s|.*[[:space:]]$1 (.*x86-64.*=> ||p" | head -n 1; }

# use_libraries [FOLDER]: a driver may need newer libraries than the kit has, and the kit newer ones than the machine.
# Those beside an unpacked driver come first; else the newer of both, and the machine's if they are the same version.
use_libraries() {
  for file in "$kit"/lib/*.so.?; do
    name="$(basename "$file")"
    [ "$name" != libOpenCL.so.1 ] || continue
    newest="${1:-/nowhere}/$name"
    [ -s "$newest" ] || newest="$(for library in "$file" "$(system_library "$name")"; do
      [ ! -s "$library" ] || readlink -f "$library" | sed 's|\(.*/\)\(.*\)|\2 \1\2|'
    done | sort -s -V -k 1,1 | tail -n 1 | cut -d ' ' -f 2)"
    ln -sf "$newest" "$work/lib/$name"
  done
  export LD_LIBRARY_PATH="$work/lib:${1:+$1:}$own_libraries"
}

# Every OpenCL driver of this machine, a file per line; containers often have one that nobody has registered.
find_drivers() {
  {
    cat "$own_vendors"/*.icd /usr/local/etc/OpenCL/vendors/*.icd 2>/dev/null
    for name in libnvidia-opencl.so.1 libamdocl64.so libigdrcl.so libintelocl.so libpocl.so.2 libRusticlOpenCL.so.1; do
      echo "$name"
      ls /usr/lib/x86_64-linux-gnu/intel-opencl/"$name" /opt/rocm*/lib/"$name" 2>/dev/null
    done
  } | while read -r library; do
    for file in "$library" "$(system_library "$library")" /usr/local/nvidia/lib64/"$library" \
      /usr/local/nvidia/lib/"$library" /usr/lib/x86_64-linux-gnu/"$library" /usr/lib64/"$library" \
      /usr/lib/wsl/lib/"$library"; do
      case "$file" in /*) if [ -e "$file" ]; then readlink -f "$file" && break; fi ;; esac
    done
  done | awk '!seen[$0]++'
}

# has_device TYPE: whether the program finds a device of this type (an extended regular expression).
has_device() { timeout -s KILL 30 "$kit/quadedge/bin/quadedge" devices 2>>"$log" | grep -qE "^[0-9]+ +($1) "; }

# use_driver FILE: this driver alone, through the kit's loader.
use_driver() {
  folder="$(dirname "$1")"
  if ldconfig -p 2>/dev/null | grep -qF "=> $folder/"; then use_libraries; else use_libraries "$folder"; fi
  ln -sf "$kit/lib/libOpenCL.so.1" "$work/lib/"
  echo "$1" >"$work/vendors/driver.icd"
  export OCL_ICD_VENDORS="$work/vendors"
}

# The machine's loader if it has a GPU; else the first driver with a GPU, or with any device.
use_libraries
chosen="the machine's loader" chosen_driver=''
if [ -n "${DEVICE_KIT_DRIVER:-}" ] || ! has_device gpu; then
  has_device '.*' || chosen=''
  [ -z "${DEVICE_KIT_DRIVER:-}" ] || chosen=''
  if [ -n "${DEVICE_KIT_DRIVER:-}" ]; then echo "$DEVICE_KIT_DRIVER"; else find_drivers; fi >"$work/drivers"
  while read -r library; do
    use_driver "$library"
    if has_device gpu; then chosen="$library" chosen_driver="$library" && break; fi
    if [ -z "$chosen" ] && has_device '.*'; then chosen="$library" chosen_driver="$library"; fi
  done <"$work/drivers"
  if [ -z "$chosen" ]; then
    echo "run.sh: no OpenCL device; drivers tried: $(tr '\n' ' ' <"$work/drivers")" | tee -a "$log" "$page" >&2
    exit 1
  fi
  if [ -n "$chosen_driver" ]; then use_driver "$chosen_driver"; else
    rm "$work/lib/libOpenCL.so.1"
    export OCL_ICD_VENDORS="$own_vendors"
    use_libraries
  fi
fi

# value FILE BLOCK KEY: a number of quadedge's JSON.
value() { sed -n "/^ *\"$2\": {/,/}/s/^ *\"$3\": \([^,]*\),*\$/\1/p" "$1" | head -n 1; }

# source_of NAME: its folder; none for the built-in room.
source_of() { [ "$1" = room ] || echo "data/$1"; }

sequences=room
for folder in data/*/; do [ ! -d "$folder" ] || sequences="$sequences $(basename "$folder")"; done
part 60 self-test demo --frames 2 --output "$work/first" --quiet
self_test=$?
part 180 'kernel variants' compare --quiet --json "$work/compare.json"
compared=$?
mv "$work/out" "$work/compare"
for sequence in $sequences; do
  track="run data/$sequence"
  [ "$sequence" != room ] || track="demo --frames $frames"
  part 15 "poses, $sequence" $track --output "$work/$sequence" --quiet
  equal=no
  cmp -s "data/$sequence.txt" "$work/$sequence/trajectory.txt" && equal=yes
  paste "data/$sequence.txt" "$work/$sequence/trajectory.txt" | awk -v name="$sequence" -v equal=$equal '
    function away(k) { return ($k - $(k + 8)) ^ 2 }
    $1 !~ /^#/ && NF == 16 { n++; d = sqrt(away(2) + away(3) + away(4)); if (d > m) m = d }
    $1 !~ /^#/ && NF != 16 { missing++ }
    END { printf "| %s | %d | %d | %s | %.3g |\n", name, n, missing, equal, m }' >>"$work/poses"
  for preset in fast default dense; do
    json="$work/$sequence-$preset.json"
    part 18 "latency, $sequence, $preset" bench $(source_of "$sequence") --preset $preset --warm-up 3 \
      --frames $((frames - 4)) --json "$json" --quiet || continue
    { echo "### $sequence, $preset" && echo '```' && cat "$work/out" && echo '```'; } >>"$work/details"
    printf '| %s | %s | %.2f | %.2f | %.2f | %.2f |\n' "$sequence" $preset "$(value "$json" latency_ms median)" \
      "$(value "$json" latency_ms p90)" "$(value "$json" latency_ms p99)" "$(value "$json" host wall_ms)" \
      >>"$work/latency"
  done
done

facts="$work/room-default.json"
{
  printf '# QuadEdge %s on %s\n\n' "$(cat "$kit/commit")" \
    "$(sed -n '/"device": {/,/}/s/.*"name": "\(.*\)",/\1/p' "$facts")"
  printf '%s; %s, %s threads; %s; driver from %s\n' "$(date -u +%Y-%m-%d)" \
    "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)" "$(nproc)" "$(getconf GNU_LIBC_VERSION)" \
    "$chosen"
  printf '\n## Latency\n\nMilliseconds per frame; host: while the device waits, measured with profiling.\n\n'
  printf '| sequence | preset | median | p90 | p99 | host |\n|---|---|---:|---:|---:|---:|\n'
  cat "$work/latency"
  printf '\n## Poses\n\nAgainst those that %s computed.\n\n' "$(cat "$kit/recorded_on")"
  printf '| sequence | poses | missing | equal bytes | largest difference [m] |\n|---|---:|---:|---|---:|\n'
  cat "$work/poses"
  printf '\n## Parts\n\n| part | outcome | s |\n|---|---|---:|\n'
  cat "$work/parts/table"
  printf '\n## Device\n\n```\n%s\n%s\n```\n' "$(quadedge devices)" "$(sed -n '/^  "device": {/,/^  }/p' "$facts")"
  printf '\n## Kernel variants\n\n```\n%s\n```\n\n## Details\n\n' "$(cat "$work/compare")"
  cat "$work/details"
} >"$page" 2>>"$log"
echo "$page"
[ $self_test -eq 0 ] && [ $compared -eq 0 ]
