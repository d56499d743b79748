#!/usr/bin/env python3
"""Usage: test_summary.py RESULTS.xml

Reads what `ctest --output-junit` wrote. Prints `PASSED FAILED SKIPPED` on standard output, and on
standard error every test that was skipped with its reason, so that a skip is never overlooked.
"""
import re
import sys
import xml.etree.ElementTree as ElementTree


def skipReason(case):
    """The test's own words: the line after GoogleTest's "Skipped", or the proof's "SKIPPED: ..." line."""
    text = case.findtext("system-out") or ""
    match = re.search(r"^SKIPPED: (.*)$", text, re.MULTILINE) or re.search(r": Skipped\n(.+)", text)
    return match.group(1).strip() if match else (case.find("skipped").get("message") or "no reason given")


def main():
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__.strip())
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    for case in ElementTree.parse(sys.argv[1]).iter("testcase"):
        skip = case.find("skipped")
        # A test that skipped itself, not one that ctest could not run (program or fixture missing).
        if skip is not None and (skip.get("message") or "").startswith("SKIP_"):
            counts["skipped"] += 1
            print(f"SKIPPED {case.get('name')}: {skipReason(case)}", file=sys.stderr)
        elif case.get("status") == "run":
            counts["passed"] += 1
        else:  # "fail", and whatever else did not pass: not found, timed out
            counts["failed"] += 1
    print(*counts.values())


if __name__ == "__main__":
    main()
