#!/usr/bin/env bash
# Builds with a sanitizer and runs the tests: tests/sanitize.sh asan|tsan [NAME_REGEX]
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-}
only=${2:-.}
[[ $preset == asan || $preset == tsan ]] || { sed -n 2p "$0" | cut -c3-; exit 2; }

cmake --preset "$preset" >/dev/null
ninja -C "build/$preset" --quiet

export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1
export UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan_suppressions.txt:print_suppressions=0

found=$(ctest --test-dir "build/$preset" --show-only --tests-regex "$only" |
        sed -n 's/^Total Tests: //p')
((found > 0)) || { echo "sanitize.sh: no test has a name that matches $only" >&2; exit 1; }

# Either of the two runs of tsan may be left without a test.
run() {
  ctest --test-dir "build/$preset" --output-on-failure --parallel "$(nproc)" --no-tests=ignore \
    --tests-regex "$only" "$@"
}

failed=0
if [[ $preset == tsan ]]; then
  # Tests whose code is all ours carry no label and run strictly. The others go through libraries
  # that were built without the sanitizer; what those do among themselves is ignored.
  run --label-exclude uninstrumented || failed=1
  export TSAN_OPTIONS=ignore_noninstrumented_modules=1:suppressions=$PWD/tests/tsan_suppressions.txt
  run --label-regex uninstrumented || failed=1
else
  run || failed=1
fi
exit $failed
