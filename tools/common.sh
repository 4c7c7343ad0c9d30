# shellcheck shell=bash
# What tools/test and tools/reproduce share; they source this file.

ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
readonly ROOT

# Compiled files are the same wherever the clone stands, so that a second clone does not compile everything again.
export CCACHE_BASEDIR="$ROOT" CCACHE_NOHASHDIR=1

# Programs that run an experiment, build/PRESET/experiments/NAME each; adding an experiment adds its name here.
# shellcheck disable=SC2034  # used by the scripts that source this file
readonly EXPERIMENTS=(
  box_on_incline closed_forms disc_rolling ellipsoid_rolling euler_disc rattleback solver_comparison sphere_on_spheres
  sphere_spin spheres_in_box tippe_top
)

# fail CODE MESSAGE...: a message for a person on stderr, then exit CODE.
fail() {
  local code=$1
  shift
  printf '%s: %s\n' "tools/$(basename "$0")" "$*" >&2
  exit "$code"
}

# heading TEXT: a line that is easily found in a long log.
heading() {
  printf '\n=== %s\n' "$*"
}

# positive_integer FIELD VALUE: prints VALUE, or fails with what is allowed.
positive_integer() {
  [[ $2 =~ ^[1-9][0-9]{0,5}$ ]] || fail 2 "$1: got '$2', allowed: a positive integer"
  echo "$2"
}

# configure_and_build PRESET JOBS [TARGET...]: everything if no target is named.
configure_and_build() {
  local preset=$1 jobs=$2
  shift 2
  cd "$ROOT" || return
  cmake --preset "$preset"
  cmake --build --preset "$preset" --parallel "$jobs" ${1:+--target "$@"}
}

# program NAME: the path of a built program of the release preset, NAME relative to the build tree.
program() {
  local path=$ROOT/build/release/$1
  [[ -x $path ]] || fail 2 "$path is not built; run: tools/test --only release"
  echo "$path"
}

# run_experiment NAME ARGUMENT...: runs it. A case that failed (exit code 1) is a row of its results, and the claims say
# which must not; anything else that goes wrong ends the script.
run_experiment() {
  local name=$1 code=0
  shift
  "$(program "experiments/$name")" "$@" || code=$?
  ((code <= 1)) || return "$code"
  ((code == 0)) || echo "$name: some cases failed; their rows say why"
}

# capability_matrix FILE: what the conformance tests find of every method, one test a line only if it fails.
capability_matrix() {
  mkdir -p "$(dirname "$1")"
  "$(program tests/conformance/conformance_test)" --gtest_brief=1 --matrix "$1" >"$1.log" || {
    cat "$1.log"
    return 1
  }
  rm "$1.log"
}
