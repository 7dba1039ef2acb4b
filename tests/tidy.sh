#!/usr/bin/env bash
# clang-tidy and clang's thread-safety analysis: tests/tidy.sh [--all | FILES]
# clang's path analyser is left out: it takes longer than all else together.
# Default: the files that differ from main's last commit before this branch.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset tidy -DVS_TIDY=OFF >/dev/null
mapfile -t headers < <(ninja -C build/tidy -t targets all | grep -oE '^generated/[^:]*\.pb\.h' | sort -u)
ninja -C build/tidy --quiet "${headers[@]}"

if [[ ${1:-} == --all ]]; then
  mapfile -t files < <(git ls-files '*.cc')
  exec python3 tests/tidy_batches.py build/tidy "${files[@]}"
elif (($#)); then
  files=("$@")
else
  base=$(git merge-base HEAD main)
  mapfile -t files < <(git diff --name-only --diff-filter=d "$base" -- '*.cc'; git diff --name-only --diff-filter=d HEAD~1 -- '*.cc')
fi
((${#files[@]})) || { echo "nothing to check"; exit 0; }

# The compiler's own -Wthread-safety is an error in this preset; clang-tidy reports it as well.
printf '%s\n' "${files[@]}" | sort -u |
  xargs --max-args=1 --max-procs="$(nproc)" clang-tidy --quiet -p build/tidy
