"""The pages as plain data, for a page in a browser."""

from __future__ import annotations

import json

import pytest

pytest.importorskip("markdown", reason="the pages become HTML with it: pip install markdown")

from cramhy_runtime import course  # noqa: E402
from cramhy_runtime.course import contents  # noqa: E402


@pytest.fixture(scope="module")
def pages():
    return {page["name"]: page for page in json.loads(json.dumps(course.as_json()))["pages"]}


def parts(pages, kind):
    return [part for page in pages.values() for part in page["parts"] if part["kind"] == kind]


def test_all_pages_are_there_in_their_order_but_those_that_need_what_a_tab_has_not(pages):
    assert (
        tuple(pages) == tuple(name for name in contents.NAMES if name not in contents.WITH_ROBOT)
        and pages["lecture-34"]["title"] == "A package of your own (lecture 34)"
    )


def test_each_kind_of_part_has_its_entries(pages):
    entries = {
        "text": {"kind", "html"},
        "code": {"kind", "lisp", "hy", "answer", "answer_hy"},
        "file": {"kind", "lisp", "hy"},
        "task": {"kind", "name", "title", "html", "start", "hints"},
    }
    assert {part["kind"]: set(part) for page in pages.values() for part in page["parts"]} == entries


def test_forms_that_both_languages_type_stand_side_by_side(pages):
    code = parts(pages, "code")
    assert {"kind": "code", "lisp": "(+ 1 2)", "hy": "(+ 1 2)", "answer": "3\n", "answer_hy": "3\n"} in code
    (twice,) = [part for part in code if part["answer"] == "TWICE\n"]
    assert twice["lisp"] == "(defun twice (number)\n  (* 2 number))" and twice["hy"] == "(defn twice [number]\n  (* 2 number))"


def test_what_should_come_out_of_a_task_is_not_in_the_page(pages):
    for task in parts(pages, "task"):
        assert "ask =" not in task["html"] and "<!--" not in task["html"] and task["hints"]
    (rectangle,) = [task for task in parts(pages, "task") if task["name"] == "rectangle"]
    assert rectangle["title"] == "A rectangle" and rectangle["start"]["hy"].startswith("(defn rectangle-around")
    assert "<code>(rectangle-around 2 3)</code>" in rectangle["html"] and "Begin with" not in rectangle["html"]


def test_nothing_in_the_pages_leads_elsewhere(pages):
    for part in parts(pages, "text") + parts(pages, "task"):
        assert "href" not in part["html"] and 'src="' not in part["html"].replace('src="data:image/', "")


def test_pictures_are_inside(pages):
    assert sum(part["html"].count('src="data:image/') for part in parts(pages, "text")) >= 5
