#!/bin/sh
# Measures QuadEdge on this machine's OpenCL device: driver, self-test, device tests, kernel variants, latency, equality
# with a CPU's results. Needs a driver, a C library, a shell and coreutils.
#   run.sh [RESULTS [MINUTES]]      default: ./results, 8 minutes
# RESULTS/page.md has all tables, rows.tsv the rows as they came, log.txt what the programs printed.
# DEVICE_KIT_DRIVER=FILE uses this OpenCL library instead of looking for one.
set -u

# The device tests, called by this script under a time limit. A test that crashes or takes too long ends the process;
# the next one goes on behind it.
if [ "${1:-}" = device-tests ]; then
  "$2/bin/quadedge_device_tests" '[device]' --list-test-names-only >"$3/left"
  [ -s "$3/left" ] || exit 1
  while [ -s "$3/left" ]; do
    sed 's/[][,"\\]/\\&/g' "$3/left" >"$3/escaped"  # Catch2 takes commas for separators even in quotes
    "$2/bin/quadedge_device_tests" --input-file "$3/escaped"
    cut -f 2- "$DEVICE_KIT_TEST_LOG" >"$3/begun"
    grep -vxF -f "$3/begun" "$3/left" >"$3/rest"
    [ "$(wc -l <"$3/rest")" -lt "$(wc -l <"$3/left")" ] || exit 1
    mv "$3/rest" "$3/left"
  done
  exit 0
fi

kit="$(cd "$(dirname "$0")" && pwd)"
results="${1:-results}"
total=$((${2:-8} * 60))
mkdir -p "$results" || exit 2
results="$(cd "$results" && pwd)"
rows="$results/rows.tsv" log="$results/log.txt" check="$kit/bin/device_check"
work="$(mktemp -d)" || exit 2
trap 'rm -rf "$work"' EXIT
: >"$rows"
: >"$log"
mkdir "$work/vendors" "$work/lib"
own_libraries="${LD_LIBRARY_PATH:-}" own_vendors="${OCL_ICD_VENDORS:-/etc/OpenCL/vendors}"
export OCL_ICD_VENDORS="$work/vendors" CUDA_VISIBLE_DEVICES="${CUDA_VISIBLE_DEVICES:-0}"
export DEVICE_KIT_DATA="$kit/data" DEVICE_KIT_PROGRAMS="$work/quadedge/programs" DEVICE_KIT_TEST_LOG="$work/tests.log"
export QUADEDGE_TEST_CACHE="$work" DEVICE_KIT_TEST_SECONDS=$((25 * total / 480))

# caches NAME: a folder for what drivers keep; nothing of the user's is read or changed.
caches() {
  mkdir -p "$work/$1"
  export HOME="$work/$1" XDG_CACHE_HOME="$work/$1" CUDA_CACHE_PATH="$work/$1" POCL_CACHE_DIR="$work/$1"
}
row() { "$check" row "$rows" "$@" >>"$log" 2>&1; }

# part SECONDS NAME COMMAND...: runs a command for at most SECONDS of 480, and notes what became of it.
part() {
  limit=$(($1 * total / 480)) name="$2"
  shift 2
  echo "== $name" >>"$log"
  start="$(date +%s)"
  timeout -s KILL "$limit" "$@" >>"$log" 2>&1  # Catch2 would report a test that gets SIGTERM as failed
  code=$?
  case $code in
    0) outcome='done' ;;
    124 | 137) outcome="TIMED OUT after $limit s" ;;
    *) outcome="FAILED with code $code: $(tail -n 1 "$log")" ;;
  esac
  seconds=$(($(date +%s) - start))
  echo "$name: $outcome, $seconds s"
  row parts "part=$name" "outcome=$outcome" "seconds=$seconds"
}

write_page() {
  "$check" page "$rows" "$results/page.md" "commit=$(cat "$kit/commit")" "date=$(date -u +%Y-%m-%d)" \
    "CPU results from=$(cat "$kit/recorded_on")" "C library=$(getconf GNU_LIBC_VERSION)" \
    "processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) threads" &&
    echo "$results/page.md"
}

# system_library NAME: the machine's own, or nothing.
system_library() { ldconfig -p 2>/dev/null | sed -n "s|.*[[:space:]]$1 (.*x86-64.*=> ||p" | head -n 1; }

# libraries_for DRIVER: chooses libraries and ICD file. A driver may need newer libraries than the kit contains, and the
# kit newer ones than the machine has. Libraries beside an unpacked driver come first; else the newer of the kit's and
# the machine's, and the machine's if both are the same version, because it fits the C library.
libraries_for() {
  folder="$(dirname "$1")"
  for name in libtbb.so.12 libstdc++.so.6 libgcc_s.so.1; do
    newest="$folder/$name"
    if [ ! -s "$newest" ] || ldconfig -p 2>/dev/null | grep -qF "=> $folder/"; then
      newest="$(for file in "$kit/lib/$name" "$(system_library "$name")"; do
        [ ! -s "$file" ] || readlink -f "$file" | sed 's|\(.*/\)\(.*\)|\2 \1\2|'
      done | sort -s -V -k 1,1 | tail -n 1 | cut -d ' ' -f 2)"
    fi
    ln -sf "$newest" "$work/lib/$name"
  done
  ln -sf "$kit/lib/libOpenCL.so.1" "$work/lib/libOpenCL.so.1"
  export LD_LIBRARY_PATH="$work/lib:$folder:$own_libraries"
  echo "$1" >"$work/vendors/driver.icd"
}

# Every OpenCL driver of this machine, a file per line.
find_drivers() {
  {
    cat "$own_vendors"/*.icd /usr/local/etc/OpenCL/vendors/*.icd 2>/dev/null
    for name in libnvidia-opencl.so.1 libamdocl64.so libigdrcl.so libintelocl.so libpocl.so.2 libRusticlOpenCL.so.1; do
      echo "$name"
      for file in /usr/lib/x86_64-linux-gnu/intel-opencl/"$name" /opt/rocm*/lib/"$name"; do
        [ ! -e "$file" ] || echo "$file"
      done
    done
  } | while read -r library; do
    case "$library" in
      /*) ;;
      *)
        for file in "$(system_library "$library")" /usr/local/nvidia/lib64/"$library" /usr/local/nvidia/lib/"$library" \
          /usr/lib/x86_64-linux-gnu/"$library" /usr/lib64/"$library" /usr/lib/wsl/lib/"$library"; do
          if [ -e "$file" ]; then library="$file" && break; fi
        done
        ;;
    esac
    [ ! -e "$library" ] || readlink -f "$library"
  done | awk '!seen[$0]++'
}

caches common
if [ -n "${DEVICE_KIT_DRIVER:-}" ]; then echo "$DEVICE_KIT_DRIVER"; else find_drivers; fi >"$work/drivers"
chosen=''
while read -r library; do
  libraries_for "$library"
  device="$(timeout -k 2 20 "$check" name "$rows" 2>>"$log" | tail -n 1)"
  row drivers "library=$library" "device=${device:-none}"
  case "$device" in
    gpu:*) chosen="$library" && break ;;
    ?*) chosen="${chosen:-$library}" ;;
  esac
done <"$work/drivers"
if [ -z "$chosen" ]; then
  echo "run.sh: no OpenCL device; drivers tried: $(tr '\n' ' ' <"$work/drivers")" | tee -a "$log" >&2
  write_page
  exit 1
fi
libraries_for "$chosen"

sequences=''
for folder in "$kit"/data/*/; do sequences="$sequences $(basename "$folder")"; done
part 10 device "$check" device "$rows"
part 40 'self-test, cold' "$check" self-test "$rows" cold
part 10 'self-test, kept programs' "$check" self-test "$rows" kept
caches cold
CUDA_CACHE_DISABLE=1 part 30 programs "$check" programs "$rows" room
caches common
for sequence in $sequences; do
  part 15 "results, $sequence" "$check" compare "$rows" "$sequence"
done
for sequence in $sequences; do
  for preset in fast default dense; do
    part 12 "latency, $sequence, $preset" "$check" bench "$rows" "$sequence" "$preset" 4
  done
done
variants_of=room  # the flight has lens distortion too
[ ! -d "$kit/data/flight" ] || variants_of=flight
part 80 'kernel variants' "$check" variants "$rows" "$variants_of"
part 135 'device tests' sh "$0" device-tests "$kit" "$work"
if [ -s "$DEVICE_KIT_TEST_LOG" ]; then
  awk -F '\t' '{ state[$2] = $1 == "started" ? "crashed or timed out" : $1 }
    END { for (name in state) print state[name] "\t" name }' "$DEVICE_KIT_TEST_LOG" | sort -k 2 >"$work/states"
  grep -v '^passed' "$work/states" | while IFS="$(printf '\t')" read -r state name; do
    row tests "test=$name" "outcome=$state"
  done
  row tests_total "passed=$(grep -c '^passed' "$work/states")" "not passed=$(grep -vc '^passed' "$work/states")" \
    "not reached=$(wc -l <"$work/left")"
fi
write_page
