#!/usr/bin/env bash
# Installs the library, builds a project that knows only the installed copy, and runs it.
#   run_consumer.sh BUILD_FOLDER CONSUMER_SOURCE
set -euo pipefail
build="$1" source="$2"
rm -rf "$build/prefix" "$build/consumer"
cmake --install "$build" --prefix "$build/prefix" >/dev/null
cmake -S "$source" -B "$build/consumer" -G Ninja -DCMAKE_PREFIX_PATH="$build/prefix" -DCMAKE_BUILD_TYPE=Release
cmake --build "$build/consumer"
"$build/consumer/consumer"
"$build/prefix/bin/quadedge" --version
