"""The page of differences says what the rows say, and each name in a row is one that there is."""

from __future__ import annotations

import re

import differences_page
import pytest

from cramhy_runtime.lisp_core.data import UNBOUND
from cramhy_runtime.lisp_core.packages import COMMON_LISP, all_packages, find_package
from cramhy_runtime.languages.commonlisp.evaluation.symbols import fboundp
from cramhy_runtime.languages.commonlisp.objects.classes import find_class
from cramhy_runtime.languages.operators import OPERATORS, differences
from cramhy_runtime.languages.operators.differences import SECTIONS, section
from cramhy_runtime.prolog.engine import database


def test_the_page_is_what_the_rows_say():
    assert differences_page.PAGE.read_text(encoding="utf-8") == differences_page.text(), "make docs writes it anew"


TEXTS = [
    path.read_text(encoding="utf-8")
    for folder, pattern in (
        ("src/cramhy_runtime/libraries", "**/*.lisp"),
        ("src/cramhy_runtime/libraries", "**/*.asd"),
        ("src/cramhy_runtime/ros_tools", "**/*.py"),
        ("src/cramhy_runtime/tf/programs", "*.py"),
        ("src/cramhy_runtime/turtlesim", "*.py"),
        ("tutorials", "**/*.hy"),
        ("src/cramhy_runtime/episodes", "**/*.py"),
        ("src/cramhy_runtime/actionlib", "*.py"),
        ("docs", "command-line.md"),
    )
    for path in sorted((differences_page.PAGE.parents[1] / folder).glob(pattern))
]
"""Where names stand that are no symbols of a session before a library is loaded: commands, their options, types of actions."""


def defined(symbol):
    """Whether a symbol names a function, macro, variable, class, type or predicate, or belongs to COMMON-LISP."""
    return (
        fboundp(symbol) is not None
        or symbol.value is not UNBOUND
        or find_class(symbol, None) is not None
        or symbol in database.functors
        or symbol.package is COMMON_LISP
    )


def exists(name):
    package, _, plain = name.upper().rpartition(":")
    if package.rstrip(":"):
        found = find_package(package.rstrip(":"))
        if found is not None and found.lookup(plain)[1] is not None:
            return True
    elif any(name.upper() == operator for _, operator in OPERATORS):
        return True
    elif any(defined(symbol) for each in all_packages() if (symbol := each.lookup(plain)[0]) is not None):
        return True
    words = rf"(?<![\w-]){re.escape(name.rpartition(':')[2] if package else name).replace(chr(92) + ' ', '.{0,40}?')}(?![\w-])"
    return any(re.search(words, text, re.S | re.I) for text in TEXTS)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", SECTIONS)
def test_each_name_in_a_row_is_there(session, name):
    session.evaluate_text("(list 'actionlib:call-goal 'actionlib-lisp:state 'cl-tf:transformer)")  # which makes their packages
    assert [operator for row in section(name)[1] for operator in row.operators if not exists(operator)] == []


@pytest.mark.parametrize("name", SECTIONS)
def test_each_row_says_what_is_here_and_why(name):
    heading, rows = section(name)
    assert heading.startswith("##") and rows
    assert [row.names for row in rows if not row.here.endswith((".", ")")) or not row.why.endswith(".")] == []
    assert len({row.here for row in rows}) == len(rows)


@pytest.mark.parametrize(
    ("block", "problem"),
    [
        ("`pursue`\n  here: It ends.", "A difference has its names in the first line, and the fields here and why"),
        ("`pursue`\n  hear: It ends.\n  why: So.", "This line of a difference begins no field"),
        ("`pursue`\nIt ends.", "This line of a difference begins no field"),
    ],
)
def test_a_row_that_is_written_wrongly_says_so(block, problem):
    with pytest.raises(ValueError, match=re.escape(problem)):
        differences.row(block)


def test_a_name_that_is_not_there_is_found():
    assert not exists("pursued") and not exists("cpl:pursued") and exists("pursue") and exists("cpl:pursue")
