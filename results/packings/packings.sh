#!/usr/bin/env bash
# packings.sh [SEEDS [COUNT]]: counts the seeds, of the first SEEDS (20), that find a packing of COUNT spheres (1000) at
# each volume fraction.
set -euo pipefail
seeds=${1:-20} count=${2:-1000}
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
for phi in 0.60 0.62 0.63 0.64 0.65; do
  cat >"$folder/scene.json" <<JSON
{ "particles": { "count": $count, "density": 0.1,
    "species": [ { "radius": 1.0, "volume_share": 0.5 }, { "radius": 1.4, "volume_share": 0.5 } ] },
  "volume_fraction": $phi, "fluid": { "viscosity": 0.1 }, "flow": { "shear_rate": 0.05 },
  "contact": { "normal_stiffness": 1e4 },
  "duration": { "equilibration": { "time": 0 }, "production": { "time": 0.1 } } }
JSON
  packed=0
  for seed in $(seq 1 "$seeds"); do
    if peclet-engine run "$folder/scene.json" --seed "$seed" >"$folder/result" 2>"$folder/message"; then
      packed=$((packed + 1))
    elif ! grep -q '(packing)' "$folder/message"; then
      cat "$folder/message" >&2
      exit 1
    fi
  done
  echo "$phi: $packed of $seeds"
done
