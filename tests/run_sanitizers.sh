#!/usr/bin/env bash
# Builds libraries and program with AddressSanitizer and UndefinedBehaviorSanitizer and runs the tests of small scenes:
# not those of OpenCL devices (drivers are not checked; the self-test runs every stage's host code), those of the OpenCV
# baseline in bench/, of recordings, and those that would render, search or learn for minutes when instrumented, or
# repeat others for statistics ([long]).
#   run_sanitizers.sh REPOSITORY BUILD_FOLDER    (with the tests built)
set -euo pipefail
repository="$1" build="$2/sanitize"
cmake -S "$repository" -B "$build" -G Ninja -DQUADEDGE_SANITIZE=ON -DCMAKE_BUILD_TYPE=Debug \
  -DQUADEDGE_TESTS=ON -DQUADEDGE_UNITY=ON -DQUADEDGE_WARNINGS_AS_ERRORS=ON \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1" -DQUADEDGE_TEST_OBJECTS="$2/tests/CMakeFiles/quadedge_tests.dir"
cmake --build "$build" --target quadedge_tests
printf 'leak:libpocl\nleak:libLLVM\nleak:libOpenCL\n' >"$build/leaks_of_drivers"
export ASAN_OPTIONS=detect_leaks=1:abort_on_error=0:exitcode=99 UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$build/leaks_of_drivers"
export QUADEDGE_TEST_PROGRAM="$build/quadedge"
exec "$build/tests/quadedge_tests" "~[.]~[device]~[baseline]~[long]~[real]~[synthetic]~disturbances*" \
  "~shared lens: focal*" "~drive calibration: wrong*" "~drive calibration: a *" "~drive calibration: of *" \
  "~calibrate: *" "~image delay: images of*" "~rig monitor: n*" "~rig monitor: small*" \
  ",a synthetic sequence has the same bytes*"
