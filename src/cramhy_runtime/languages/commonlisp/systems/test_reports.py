"""What came of a run of tests: for people, with file, line and values, as pytest shows it, and for programs, as a file of JUnit's XML.

The libraries print their own summaries, in the words of the original. They do not say where a check stands. So what failed is told once
more behind them, with its place, and a last line counts the tests.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import NamedTuple

from cramhy_runtime import storage
from cramhy_runtime.lisp_core.conditions import FileError, error
from cramhy_runtime.lisp_core.source_places import describe, excerpt

from ..files.files import lisp_path
from .unit_tests import LispTest, Outcome

WIDTH = 80
SHORT = 100
"""So many characters of a failure stand in the list at the end."""
_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


class Result(NamedTuple):
    """A test, what came of it, and the seconds of the wall clock that it took."""

    test: LispTest
    outcome: Outcome
    seconds: float

    @property
    def name(self):
        return f"{self.test.package.name}::{self.test.name}"

    @property
    def kind(self):
        """ "failed", "skipped" or "passed"."""
        if self.outcome.failures:
            return "failed"
        return "skipped" if self.outcome.skipped and not self.outcome.passed else "passed"


def shown(failure):
    """What a failed check says, with its place and the line of Lisp."""
    place = [f"  at {describe(failure.place)}", excerpt(failure.place)] if failure.place else []
    return "\n".join([failure.text, *place])


def summary(results):
    """The text of a run: what failed, where and with which values, and the counts."""
    failed = [result for result in results if result.kind == "failed"]
    lines = []
    if failed:
        lines.append(" FAILURES ".center(WIDTH, "="))
    for result in failed:
        lines += [f" {result.name} ".center(WIDTH, "_"), "\n\n".join(map(shown, result.outcome.failures))]
    if failed:
        lines.append(" short test summary info ".center(WIDTH, "="))
        lines += [
            f"FAILED {_place(result, failure)} {result.name} - {_short(failure.text)}"
            for result in failed
            for failure in result.outcome.failures
        ]
    counts = [(kind, sum(result.kind == kind for result in results)) for kind in ("failed", "passed", "skipped")]
    counted = ", ".join(f"{count} {kind}" for kind, count in counts if count)
    lines.append(f"{counted} in {sum(result.seconds for result in results):.2f}s")
    return "\n".join(lines) + "\n"


def _place(result, failure):
    return describe(failure.place or result.test.place)


def _short(text):
    words = " ".join(line.removeprefix(" |").removeprefix(" Failed Form:").strip() for line in text.splitlines())
    words = " ".join(words.split())
    return words if len(words) <= SHORT else words[: SHORT - 3] + "..."


# -------------------------------------------------------------------------------------------------------------------- JUnit


def write_junit(path, results):
    """Write the results of a run into the file ``path``, as JUnit's XML, which CI servers read."""
    _write(path, [_case(result) for result in results])


def write_junit_of_one(path, name, error=None):
    """Write into ``path`` what came of tests that are counted as one, called ``name``: the text of an error, or all was well."""
    from xml.etree.ElementTree import Element, SubElement

    case = Element("testcase", classname="cramhy", name=clean_for_xml(name), time="0")
    if error is not None:
        SubElement(case, "error", message=clean_for_xml(error.strip().split("\n")[0])).text = clean_for_xml(error)
    _write(path, [case])


def _case(result):
    from xml.etree.ElementTree import Element, SubElement

    file, line = (result.test.place or ("", 0))[:2]
    case = Element(
        "testcase",
        classname=clean_for_xml(result.test.package.name),
        name=clean_for_xml(result.test.name),
        file=clean_for_xml(os.path.relpath(file)) if file and not file.startswith("<") else clean_for_xml(file),
        line=str(line),
        time=f"{result.seconds:.3f}",
    )
    if result.kind == "failed":
        failures = result.outcome.failures
        SubElement(case, "failure", message=clean_for_xml(_short(failures[0].text))).text = clean_for_xml("\n\n".join(map(shown, failures)))
    elif result.kind == "skipped":
        SubElement(case, "skipped", message=clean_for_xml("; ".join(result.outcome.skipped)))
    return case


def clean_for_xml(text):
    """``text`` without the characters that XML cannot hold."""
    return _NOT_IN_XML.sub(lambda found: f"\\x{ord(found[0]):02x}", text)


def _write(path, cases):
    from xml.etree.ElementTree import Element, SubElement, indent, tostring

    suites = Element("testsuites")
    counts = {kind: str(sum(case.find(tag) is not None for case in cases)) for kind, tag in _COUNTED.items()}
    seconds = sum(float(case.get("time")) for case in cases)
    suite = SubElement(suites, "testsuite", name="cramhy", tests=str(len(cases)), **counts, time=f"{seconds:.3f}")
    suite.extend(cases)
    indent(suites)
    try:
        storage.write_whole(Path(path).absolute(), tostring(suites, encoding="utf-8", xml_declaration=True) + b"\n")
    except OSError as problem:
        error(FileError(lisp_path(path), "Cannot write the results of the tests into ~A: ~A.", str(path), problem.strerror))


_COUNTED = {"failures": "failure", "errors": "error", "skipped": "skipped"}

__all__ = ["clean_for_xml", "Result", "shown", "summary", "write_junit", "write_junit_of_one"]
