#!/usr/bin/env bash
# build_before.sh [COMMIT [DIR]]
#
# Builds the peclet-engine of COMMIT from a clone in DIR (by default build/before-COMMIT) and prints its path.
# The default COMMIT, 950c12b, is the last that treats one pair after the other. For `peer.py --before`.
set -euo pipefail
repository=$(git -C "$(dirname "${BASH_SOURCE[0]}")" rev-parse --show-toplevel)
wanted=${1:-950c12b}
commit=$(git -C "$repository" rev-parse --verify "$wanted^{commit}")
clone=${2:-$repository/build/before-$wanted}

[ -e "$clone" ] || git clone --quiet --shared --no-checkout "$repository" "$clone"
git -C "$clone" checkout --quiet --detach "$commit"
cd "$clone"
cmake --preset release -DBUILD_TESTING=OFF >&2
cmake --build --preset release --target peclet-engine >&2
echo "$PWD/build/release/bin/peclet-engine"
