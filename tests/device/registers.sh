#!/usr/bin/env bash
# registers.sh [BUILD [ARCHITECTURE]]
#
# Prints registers, stack and spills of a thread, and shared memory, for each PTX that BUILD (build/release) has
# compiled, as ptxas of a CUDA toolkit finds them for ARCHITECTURE (sm_90).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

ptxas=$(PATH=$PATH:/usr/local/cuda/bin command -v ptxas) || {
  echo "registers.sh: there is no ptxas" >&2
  exit 1
}
printf '%7s %9s %7s %12s %11s %9s %9s\n' variant registers stack_B spill_stores spill_loads shared_B seconds
for ptx in $(printf '%s\n' "${1:-build/release}"/engine/card/*.ptx | sort -V); do
  start=$(date +%s.%N)
  "$ptxas" -v "-arch=${2:-sm_90}" -o /dev/null "$ptx" 2>&1 |
    awk -v variant="$(basename "$ptx" | cut -d. -f2)" -v start="$start" '
      function before(words) { return match($0, "[0-9]+ " words) ? substr($0, RSTART) + 0 : 0 }
      / bytes stack frame/ { stack += before("bytes stack"); stores += before("bytes spill stores")
                             loads += before("bytes spill loads") }
      /Used [0-9]+ registers/ { registers = before("registers"); shared = before("bytes smem") }
      /error|fatal/ { print > "/dev/stderr" }
      END { "date +%s.%N" | getline now
            printf "%7s %9d %7d %12d %11d %9d %9.1f\n", variant, registers, stack, stores, loads, shared, now - start }'
done
