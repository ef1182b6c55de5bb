#!/usr/bin/env bash
# libfuzzer.sh spheres SECONDS [FOLDER]   fuzzes spheres_target.cpp with clang's libFuzzer
#
# Needs clang-14 and libclang-rt-14-dev. FOLDER (default build/fuzz/NAME) keeps the corpus for the next
# search; findings are left in build/fuzz. Put repaired ones into tests/fuzz/corpus/NAME: tests read them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
[ "${1-}" = spheres ] && [ $# -ge 2 ] || { sed -n '2,6s/^# \{0,1\}//p' "$0" >&2; exit 2; }
name=$1 seconds=$2 folder=${3:-build/fuzz/$1}
clang=${CLANG:-clang++-14}
declare -A sources=(
  [spheres]="engine/gsd engine/snapshots engine/pictures engine/state/threads.cpp engine/state/periodic_cell.cpp"
)
files=("tests/fuzz/${name}_target.cpp")
for source in contract ${sources[$name]}; do
  [ -d "$source" ] && files+=("$source"/*.cpp) || files+=("$source")
done
files=("${files[@]/contract\/provenance.cpp/}")  # which a build generates, and no target asks for
mkdir -p "$folder" build/fuzz
program=build/fuzz/libfuzzer_$name
"$clang" -std=c++20 -O1 -g1 -I. -Itests/fuzz -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all \
  "${files[@]}" -o "$program" -lsodium -lfmt -lz -lgomp
exec "$program" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=65536 -use_value_profile=1 \
  -artifact_prefix=build/fuzz/ "$folder" "tests/fuzz/corpus/$name"
