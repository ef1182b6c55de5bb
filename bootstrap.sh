#!/usr/bin/env bash
# Sets the project up on Debian 12 and runs it. Asks no questions; may be repeated at any time.
#
#   ./bootstrap.sh demo     install the packages, build, run the demonstration campaign, print its table
#   ./bootstrap.sh package  install the packages, build, make a .tar.gz for any Linux and a .deb
#   ./bootstrap.sh test     install the packages, build, run all tests except the slow ones
#   ./bootstrap.sh sanitize run the tests of contract/ and runner/, and the reader of sphere files, with sanitizers
#   ./bootstrap.sh tidy     run clang-tidy on the whole source; with --programs leave out the tests
#   ./bootstrap.sh lint     check the format of C++ and Python, then run clang-tidy
#   ./bootstrap.sh clang    build with clang and libc++, run the unit tests
#   ./bootstrap.sh arm64    build for 64-bit ARM, run the unit tests of contract/ and engine/ by an emulator
#   ./bootstrap.sh deps     install the packages only
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

to_build=(
  g++ cmake ninja-build pkg-config git
  nlohmann-json3-dev libcli11-dev libfmt-dev libspdlog-dev                 # both programs
  librandom123-dev libsodium-dev libsqlite3-dev zlib1g-dev libboost-dev libeigen3-dev
)
to_package=(help2man python3)  # manual pages; the wheel
to_test=(
  libgtest-dev python3 python3-jsonschema sqlite3 libfaketime
  groff-base systemd                                                      # check manual pages and the unit
  lammps openmpi-bin                                                      # another engine, also with MPI
  slurm-wlm munge                                                         # a batch system
  chromium                                                                # opens the page of a report
  python3-numpy python3-scipy python3-matplotlib                          # numbers and figures of the studies
  python3-xgboost python3-sklearn                                         # maps between local quantities
  python3-pandas python3-xarray python3-pip python3-setuptools python3-wheel  # the Python package
  python3-nbclient python3-nbformat python3-ipykernel                     # notebooks
  python3-gsd python3-pil ffmpeg                                          # read trajectories, pictures and films
  clang                                                                   # compiles the program of cards
  clang-format black flake8                                               # the format of the sources
)
to_lint=(clang-tidy)
to_clang=(clang-16 libc++-16-dev libc++abi-16-dev libomp-16-dev googletest python3)
to_arm64=(
  g++-aarch64-linux-gnu qemu-user python3
  lib{fmt,spdlog,sqlite3,sodium,gtest}-dev:arm64 zlib1g-dev:arm64 libgomp1:arm64
)

say() { printf '\n== %s\n' "$*"; }

deps() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  if [ ${#missing[@]} -eq 0 ]; then
    say "All $# Debian packages are installed."
    return
  fi
  local root=()
  if [ "$(id -u)" -ne 0 ]; then
    # sudo must work without a password, because there may be no terminal.
    command -v sudo >/dev/null && sudo -n true 2>/dev/null || {
      echo "bootstrap.sh: these packages are missing and need root or passwordless sudo: ${missing[*]}" >&2
      exit 1
    }
    root=(sudo -n)
  fi
  say "Installing Debian packages: ${missing[*]}"
  [[ "${missing[*]}" != *:arm64* ]] || "${root[@]}" dpkg --add-architecture arm64
  "${root[@]}" apt-get update -qq
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" \
    </dev/null >/dev/null
}

build() {
  local tests=$1
  shift
  say "Building the release programs into build/release"
  local options=(-DBUILD_TESTING="$tests")
  [ "$tests" = OFF ] || options+=(-DPECLET_EVERY_TEST=ON)  # the packages for all tests are installed
  cmake --preset release "${options[@]}" >/dev/null
  cmake --build --preset release "$@"
}

demo() {
  build OFF --target peclet peclet-engine
  # A campaign belongs to its engine, so that another build has another campaign.
  local folder
  folder=build/demo-$(sha256sum build/release/bin/peclet-engine | cut -c1-12).peclet
  say "Running results/demo/campaign.json into $folder (three Péclet numbers, ten seeds or more each; seconds)"
  echo "   Stop it with Ctrl-C and start it again: it continues."
  build/release/bin/peclet run results/demo/campaign.json --directory "$folder"
}

package() {
  say "Building programs that need no shared library into build/package"
  /usr/bin/python3 python/build_backend.py
  say "build/package has"
  (cd build/package && ls -lh peclet-*.tar.gz peclet_*.deb peclet-*.whl)
}

run_tests() {
  build ON
  say "Running every test but those that take a minute or more each (ctest --preset release -L slow)"
  ctest --preset release --parallel 2 -LE slow
}

# The tests of the engine are left out: with sanitizers its loops would take hours.
sanitize() {
  say "Building contract/ and runner/ with sanitizers into build/asan-ubsan"
  # Reports need line numbers only; full debug information takes 1.5 times as long to compile.
  cmake --preset asan-ubsan -DBUILD_TESTING=ON -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" \
    -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=10 >/dev/null
  cmake --build --preset asan-ubsan --target contract_tests runner_tests fuzz_spheres
  say "Running their tests"
  build/asan-ubsan/bin/contract_tests --gtest_brief=1
  build/asan-ubsan/bin/fuzz_spheres --runs 4000 --findings build/asan-ubsan tests/fuzz/corpus/spheres
  printf '%s\n' build/asan-ubsan/bin/runner_*_tests | xargs -P 2 -I TESTS env TESTS --gtest_brief=1
}

with_clang() {
  say "Building with clang and libc++ into build/clang"
  cmake --preset clang -DBUILD_TESTING=ON >/dev/null
  cmake --build --preset clang --target \
    contract_tests runner_tests engine_tests engine_bench_tests physics_tests fuzz_spheres fuzz_checkpoint
  say "Running the unit tests"
  ctest --preset clang --parallel 2 -L unit
}

# Whole simulations and threads are left out, because the emulator is slow, and the tests of runner/ and of scripts,
# because it starts no other programs.
for_arm64() {
  say "Building for 64-bit ARM into build/arm64"
  cmake --preset arm64 -DBUILD_TESTING=ON >/dev/null
  cmake --build --preset arm64 --target contract_tests \
    engine_{state,snapshots,pictures,flow,terms,scene,kernels,integrators,forces,observables}_tests
  say "Running the unit tests by qemu"
  ctest --preset arm64 --parallel 2 -L unit -E "Threads|SameBits|AgainstExplicit|Dumbbell|Measure"
}

tidy() {
  say "clang-tidy"
  # In its own folder, so that it may run beside a build. Generates sources first.
  cmake --preset release -B build/tidy -DBUILD_TESTING=ON >/dev/null
  cmake --build build/tidy --target provenance_facts
  /usr/bin/python3 tests/house/tidy.py build/tidy "$@"
}

lint() {
  build ON --target provenance_facts
  say "Format"
  ctest --preset release -L format
  tidy
}

case "${1:-}" in
  demo) deps "${to_build[@]}" && demo ;;
  package) deps "${to_build[@]}" "${to_package[@]}" && package ;;
  test) deps "${to_build[@]}" "${to_package[@]}" "${to_test[@]}" && run_tests ;;
  sanitize) deps "${to_build[@]}" "${to_test[@]}" && sanitize ;;
  tidy) deps "${to_build[@]}" "${to_test[@]}" "${to_lint[@]}" && tidy "${@:2}" ;;
  lint) deps "${to_build[@]}" "${to_test[@]}" "${to_lint[@]}" && lint ;;
  clang) deps "${to_build[@]}" "${to_clang[@]}" && with_clang ;;
  arm64) deps "${to_build[@]}" "${to_arm64[@]}" && for_arm64 ;;
  deps) deps "${to_build[@]}" "${to_package[@]}" "${to_test[@]}" "${to_lint[@]}" ;;
  *)
    sed -n '2,12s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
    exit 2
    ;;
esac
