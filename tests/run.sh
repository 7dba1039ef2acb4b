#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests. Last line: "N passed, N failed".
#   tests/run.sh [NAME_REGEX]      only the tests whose name matches
set -euo pipefail
cd "$(dirname "$0")/.."

deploy/prepare.sh --tests

report=$(mktemp)
trap 'rm -f "$report"' EXIT
status=0
ctest --test-dir build/release --output-on-failure --parallel "$(nproc)" \
  ${1:+--tests-regex "$1"} --output-junit "$report" || status=$?

read -r total failed skipped < <(/usr/bin/python3 - "$report" <<'PYTHON'
import sys
import xml.etree.ElementTree

try:
    suite = xml.etree.ElementTree.parse(sys.argv[1]).getroot()
    print(suite.get("tests"), suite.get("failures"),
          int(suite.get("skipped", 0)) + int(suite.get("disabled", 0)))
except (OSError, xml.etree.ElementTree.ParseError):
    print(0, 1, 0)  # ctest itself did not get far enough to write its report
PYTHON
)
((skipped == 0)) || echo "$skipped skipped (each says above what it is missing)"
echo "$((total - failed - skipped)) passed, $failed failed"
exit "$status"
