#!/usr/bin/python3
"""Names the failed test cases of a finished ctest run and counts all: JUnit files of gtest and rostest, and the
summaries of unittest."""

import glob
import os
import re
import sys
import xml.etree.ElementTree as ElementTree


MAX_REASON_LINES = 12


def fault(case):
    """The <failure> or <error> of a case, if it has one."""
    found = case.find("failure")
    return found if found is not None else case.find("error")


def junit_counts(path):
    """(cases, failed, skipped) of one result file; an unreadable one counts as one failure. Prints the failed ones:
    a rostest's own output buries them below what its nodes print."""
    try:
        root = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, OSError):
        print(f"FAILED {os.path.basename(path)}: cannot be read")
        return 1, 1, 0
    cases = list(root.iter("testcase"))
    faults = [(case, fault(case)) for case in cases if fault(case) is not None]
    for case, found in faults:
        reason = (found.text or found.get("message") or "").strip().splitlines()[-MAX_REASON_LINES:]
        print("\n  ".join([f"FAILED {os.path.basename(path)}: {case.get('name')}"] + reason))
    failed = len(faults)
    skipped = sum(1 for case in cases
                  if case.find("skipped") is not None or case.get("result") == "skipped" or case.get("status") == "notrun")
    return len(cases), failed, skipped


def unittest_counts(log):
    """(cases, failed, skipped) of all unittest runs in ctest's log."""
    cases = sum(int(n) for n in re.findall(r"^Ran (\d+) tests? in", log, re.MULTILINE))
    failed = sum(int(n) for n in re.findall(r"(?:failures|errors)=(\d+)", log))
    skipped = sum(int(n) for n in re.findall(r"skipped=(\d+)", log))
    return cases, failed, skipped


def main():
    build = sys.argv[1]
    results = [junit_counts(path) for path in glob.glob(os.path.join(build, "test_results", "**", "*.xml"), recursive=True)]
    log_path = os.path.join(build, "Testing", "Temporary", "LastTest.log")
    if os.path.exists(log_path):
        with open(log_path, errors="replace") as log:
            results.append(unittest_counts(log.read()))
    cases, failed, skipped = (sum(column) for column in zip(*results)) if results else (0, 0, 0)
    # A test program that crashed writes no case: ctest lists it.
    failed_path = os.path.join(build, "Testing", "Temporary", "LastTestsFailed.log")
    if failed == 0 and os.path.exists(failed_path):
        with open(failed_path) as lines:
            names = [line.strip() for line in lines if line.strip()]
        for name in names:
            print(f"FAILED {name}: ended without a result")
        crashed = len(names)
        failed, cases = crashed, cases + crashed
    print(f"{cases - failed - skipped} passed, {failed} failed, {skipped} skipped")
    return 1 if failed or cases == skipped else 0


if __name__ == "__main__":
    sys.exit(main())
