#!/usr/bin/env bash
# pack.sh [FOLDER [PROGRAM...]]
#
# Builds programs that need nothing but a C library of 2022 or later, and packs them with check.sh into FOLDER
# (build/device/pack). A bare machine with a card runs FOLDER/check.sh. PROGRAM: further targets to take along.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

folder=${1:-build/device/pack}
programs=(peclet-engine card_check "${@:2}")
cmake --preset device >/dev/null
cmake --build --preset device --parallel 2 --target "${programs[@]}"

rm -rf "$folder"
mkdir -p "$folder"
cp tests/device/check.sh "$folder"
for program in "${programs[@]}"; do
  strip -o "$folder/$program" "build/device/bin/$program"
  # These come with the C library.
  if foreign=$(ldd "$folder/$program" | grep -vE 'linux-vdso|/ld-linux|lib(c|m|mvec|dl|pthread|rt)\.so'); then
    echo "pack.sh: $program needs other libraries:" "$foreign" >&2
    exit 1
  fi
done
du -sh "$folder"
