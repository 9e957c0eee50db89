#!/usr/bin/env bash
# run.sh [everyday]: installs what is missing, builds, runs every test; with `everyday` the release build without the slow
# ones. At the end: the time of each stage, the twenty slowest tests, and an overall result.
set -uo pipefail
shopt -s nullglob
cd "$(dirname "$0")/.."
export OMP_WAIT_POLICY=passive
jobs=$(nproc)
results=build/test-results
rm -rf "$results" && mkdir -p "$results"
stages=() status=0

# stage NAME COMMAND...: runs it, notes its time; what cannot be installed or built ends the run, a failed test does not.
stage() {
  local name=$1 begun=$SECONDS said=ok
  shift
  "$@" || { said=FAILED; status=1; }
  stages+=("$(printf '%6d s  %-6s  %s' $((SECONDS - begun)) "$said" "$name")")
  [ "$said" = ok ]
}
must() { stage "$@" || finish; }
# A filter that matches nothing is an error: a test that is gone must not pass.
tests() {
  local preset=$1
  shift
  stage "tests, $preset" ctest --preset "$preset" -j "$jobs" --no-tests=error --output-junit "$PWD/$results/$preset.xml" "$@" || true
}
finish() {
  echo
  printf '%s\n' "stages" "${stages[@]}"
  tests/slowest.py "$results"/*.xml || status=1
  [ $status -eq 0 ] && echo "all passed" || echo "FAILED"
  exit $status
}
# Of debugging information line numbers are enough here: they stand in what the sanitizers say.
build() {
  local preset=$1
  shift
  cmake --preset "$preset" -DTALUS_TESTS=ON -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1" >/dev/null &&
    cmake --build --preset "$preset" "$@"
}

if [ "${1:-all}" = everyday ]; then
  must "packages" deploy/install-packages.sh build test
  must "build, release" build release
  tests release -LE slow
  finish
fi

# The release build is made file by file, which shows that each includes what it needs; the others join files (see their
# presets). The sanitized builds repeat only what they are good for.
must "packages" deploy/install-packages.sh build test tsan container
TALUS_CLANG=-$(printf '%s\n' /usr/bin/clang++-[0-9]* | sed 's/.*-//' | sort -n | tail -1)  # -16: as the presets want it
export TALUS_CLANG
must "build, release" build release
must "build, dev" build dev
must "build, tsan" build tsan --target test_simulation test_sph test_integrate talusd test_service
must "build, fuzz" build fuzz --target fuzz_request fuzz_case fuzz_records fuzz_json

# Where threads meet; talusd with the thread sanitizer, the runs that it starts need none.
threaded=(Determinism RightHandSide VectorisedFlow Integrator StoreTest 'service_Ours$' 'service_Load$' 'service_Crash$')
all_there() {
  local name
  for name in "${threaded[@]}"; do
    ctest --preset tsan -N -R "$name" | grep -q 'Total Tests: [1-9]' || { echo "run.sh: no test is named $name" >&2; return 1; }
  done
}
stage "every test named for tsan is there" all_there || true
TALUS=$PWD/build/release/bin/talus tests tsan -R "$(IFS='|'; echo "${threaded[*]}")"
tests fuzz
tests dev -LE 'slow|long'
tests release
finish
