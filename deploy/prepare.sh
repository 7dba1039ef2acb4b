#!/usr/bin/env bash
# Installs what is missing from Debian's packages and builds VisionServer (release).
#   deploy/prepare.sh [--tests]     with --tests: also what the tests need
# Sourced by nobody; run.sh and tests/run.sh call it. Quick when there is nothing to do.
set -euo pipefail
cd "$(dirname "$0")/.."

with_tests=OFF
[[ ${1:-} == --tests ]] && with_tests=ON

say() { printf '%s\n' "$*" >&2; }

# The packages of deploy/packages.txt; those of the [test] part only when they are wanted, those of
# the [web] part only where nothing else brought npm (its package and NodeSource's exclude each other).
wanted_packages() {
  local has_npm
  has_npm=$(command -v npm || true)
  awk -v tests="$with_tests" -v npm="$has_npm" '/^# \[/ { part = $2 } /^#/ || NF == 0 { next }
    !(part == "[test]" && tests != "ON") && !(part == "[web]" && npm)' deploy/packages.txt
}

missing_packages() {
  local installed
  installed=$(dpkg-query -W -f '${Package} ${Status}\n' 2>/dev/null |
              awk '/install ok installed$/ { sub(/:.*/, "", $1); print $1 }')
  grep -vxF -f <(printf '%s\n' "$installed") <(wanted_packages) || true
}

as_root() {
  if [[ $(id -u) == 0 ]]; then "$@"; elif command -v sudo >/dev/null; then sudo "$@"; else
    say "prepare.sh: these packages are missing and need root or sudo to install: ${missing[*]}"
    exit 1
  fi
}

mapfile -t missing < <(missing_packages)
if ((${#missing[@]})); then
  say "Installing ${#missing[@]} packages: ${missing[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    "${missing[@]}" >/dev/null
fi

build=build/release
if ((${#missing[@]})) || [[ ! -f $build/build.ninja ]] || ! grep -q "^BUILD_TESTING:BOOL=$with_tests" $build/CMakeCache.txt; then
  # A build with tests also serves a run without them: never take them out again.
  # What was just installed may serve more than what was built before.
  if [[ $with_tests == ON || ! -f $build/build.ninja ]]; then
    say "Configuring ($build)"
    cmake --preset release -DBUILD_TESTING=$with_tests >/dev/null
  elif ((${#missing[@]})); then
    cmake --preset release >/dev/null
  fi
fi
say "Building ($build)"
if ! ninja -C $build --quiet >&2; then
  say "prepare.sh: the build failed; the first error stands above"
  exit 1
fi
