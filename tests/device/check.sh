#!/usr/bin/env bash
# Checks the programs beside this script on the card of this machine, in six minutes at most. Prints the card, the
# program, and tables: the variants of the card's program, steps beside the processor's, and speed. Exits with 1 if
# anything was wrong.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit

# The driver need not compile again what it compiled for another run; here it shall.
export CUDA_CACHE_DISABLE=1
failures=0
step() {
  local limit=$1
  shift
  timeout --kill-after=5 "$limit" "$@"
  local code=$?
  [ $code -eq 0 ] && return
  echo "FAILED with $code: $*"
  failures=1
}

step 20 nvidia-smi --query-gpu=name,driver_version,memory.total,clocks.max.sm --format=csv,noheader
step 20 ./peclet-engine --version
step 320 ./card_check 1
exit $failures
