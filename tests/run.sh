#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests. Last line: "N passed, N failed".
#   tests/run.sh [NAME_REGEX]      only the tests whose name matches
set -euo pipefail
cd "$(dirname "$0")/.."

deploy/prepare.sh --tests || { echo "0 passed, 1 failed"; exit 1; }

report=$(mktemp)
trap 'rm -f "$report"' EXIT
status=0
ctest --test-dir build/release --output-on-failure --parallel "$(nproc)" --no-tests=error \
  ${1:+--tests-regex "$1"} --output-junit "$report" || status=$?

# Prints why tests were skipped and what was measured, which ctest does not, then the last line.
/usr/bin/python3 - "$report" "$status" <<'PYTHON'
import collections
import re
import sys
import xml.etree.ElementTree

try:
    cases = xml.etree.ElementTree.parse(sys.argv[1]).getroot().findall("testcase")
except (OSError, xml.etree.ElementTree.ParseError):
    cases = []  # ctest itself did not get far enough to write its report

passed = failed = 0
reasons = collections.Counter()
for case in cases:
    skipped = case.find("skipped")  # also of a test that was not built, for another reason
    if case.get("status") == "run":
        passed += 1
        if case.get("name") == "e2e_figures":
            print(case.findtext("system-out", "").strip())
    elif skipped is not None and skipped.get("message") == "SKIP_REGULAR_EXPRESSION_MATCHED":
        # GTEST_SKIP() << reason, or the reason why there is no network of its own.
        output = case.findtext("system-out", "")
        reason = re.search(r": Skipped\n(.+)|\[  SKIPPED \] (no .+)", output)
        reasons[(reason[1] or reason[2]) if reason else "no reason given: " + case.get("name")] += 1
    elif case.get("status") != "disabled":
        failed += 1
for reason, count in reasons.items():
    print(f"{count} skipped: {reason}")
if sys.argv[2] != "0":  # ctest also fails where no test does
    failed = max(failed, 1)
print(f"{passed} passed, {failed} failed")
PYTHON
exit "$status"
