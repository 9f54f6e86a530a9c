"""What came of a submission: points, and words for the student. As text, as JSON, and as JUnit's XML."""

from __future__ import annotations

import json
import textwrap
from typing import NamedTuple

from .exercise import whole
from .harmless import harmless

WIDTH = 100


class _CheckResult(NamedTuple):
    title: str
    points: float
    most: float
    wrong: list[str]
    hint: str | None = None


class CheckResult(_CheckResult):
    """A check: its title, the points it gave and those it could give, and what is wrong, as sentences. All texts become `harmless`."""

    __slots__ = ()

    def __new__(cls, title: str, points: float, most: float, wrong: list[str], hint: str | None = None) -> CheckResult:
        return super().__new__(cls, harmless(title), points, most, [harmless(each) for each in wrong], hint and harmless(hint))

    @property
    def passed(self) -> bool:
        """Whether nothing is wrong."""
        return not self.wrong


class _Report(NamedTuple):
    exercise: str
    checks: list[CheckResult]
    output: str
    held: list[str]


class Report(_Report):
    """The result of grading. exercise: its title. output: what the submission printed, cut off. held: the locks of the sandbox.

    All texts become `harmless`, so they are that wherever the report is written.
    """

    __slots__ = ()

    def __new__(cls, exercise: str, checks: list[CheckResult], output: str, held: list[str]) -> Report:
        return super().__new__(cls, harmless(exercise), checks, harmless(output), [harmless(each) for each in held])

    @property
    def points(self) -> float:
        """The points of all checks."""
        return whole(sum(check.points for check in self.checks))

    @property
    def most(self) -> float:
        """The most points that there are."""
        return whole(sum(check.most for check in self.checks))

    @property
    def passed(self) -> bool:
        """Whether all checks passed."""
        return all(check.passed for check in self.checks)

    def text(self) -> str:
        """The report for a student at a terminal."""
        lines = [f"{self.exercise}: {self.points} of {self.most} points", ""]
        for check in self.checks:
            lines.append(f"{'passed' if check.passed else 'FAILED'}  {whole(check.points)}/{whole(check.most)}  {check.title}")
            lines += [textwrap.indent(sentence.strip(), " " * 8) for sentence in check.wrong]
            if check.wrong and check.hint:
                lines.append(textwrap.indent(f"Hint: {check.hint}", " " * 8))
        if not self.passed and self.output.strip():
            lines += ["", "What the program printed last:", textwrap.indent(self.output.strip(), "  | ")]
        return "\n".join(lines) + "\n"

    def data(self) -> dict:
        """The report as plain data."""
        return {
            "exercise": self.exercise,
            "points": self.points,
            "most": self.most,
            "passed": self.passed,
            "checks": [
                {
                    "title": check.title,
                    "points": whole(check.points),
                    "most": whole(check.most),
                    "passed": check.passed,
                    "wrong": check.wrong,
                }
                for check in self.checks
            ],
            "output": self.output,
            "sandbox": self.held,
        }

    def json(self) -> str:
        """The report as JSON. The same submission gives the same text, unless it prints other things."""
        return json.dumps(self.data(), indent=2, ensure_ascii=False) + "\n"

    def junit(self) -> bytes:
        """The report as JUnit's XML: a test for each check."""
        from xml.etree.ElementTree import Element, SubElement, indent, tostring

        from cramhy_runtime.languages.commonlisp.systems.test_reports import clean_for_xml

        suites = Element("testsuites")
        failed = sum(not check.passed for check in self.checks)
        suite = SubElement(
            suites,
            "testsuite",
            name=clean_for_xml(self.exercise),
            tests=str(len(self.checks)),
            failures=str(failed),
            errors="0",
            skipped="0",
        )
        for check in self.checks:
            case = SubElement(suite, "testcase", classname=clean_for_xml(self.exercise), name=clean_for_xml(check.title), time="0")
            properties = SubElement(case, "properties")
            SubElement(properties, "property", name="points", value=str(whole(check.points)))
            SubElement(properties, "property", name="most", value=str(whole(check.most)))
            if check.wrong:
                message = clean_for_xml(check.wrong[0].partition("\n")[0])
                SubElement(case, "failure", message=message).text = clean_for_xml("\n".join(check.wrong))
        indent(suites)
        return tostring(suites, encoding="utf-8", xml_declaration=True) + b"\n"
