"""A page is taken apart: text, code in both languages, files, tasks. What cannot be used is told with its place."""

from __future__ import annotations

import pytest

from cramhy_runtime.course import contents, reading
from cramhy_runtime.course.parts import Code, File, Task, Text, Typed

from .walking import ENDINGS, SOLUTIONS

PAGE = """# A page

Some text.

<!-- installed -->

Only beside a terminal.

<!-- anywhere -->
<!-- in the course
Only in the course.
-->

<!-- tabs -->

```lisp
TUT> (list 1
       2)
(1 2)
TUT> (car 7)
debugger invoked
0] 0
```

```hy
=> [1 2]
[1 2]
```

```sh
$ ls
```

<!-- tabs -->

```lisp title="a.lisp"
# not a heading
```

```hy title="a.hy"
(setv a 1)
```

### Task: do it

<!-- task: do-it
ask = [["(f)", "1"]]
-->

Do it.

<!-- tabs -->

```lisp title="Begin with"
(defun f () 0)
```

```hy title="Begin with"
(defn f [] 0)
```

<details><summary>Hint 1</summary>

One.

</details>

<details><summary>Hint 2</summary>

Two.

</details>

Behind the task.

## And then

The end.
"""


def test_the_parts_of_a_page():
    page = reading.read("a-page", PAGE)
    assert page.title == "A page"
    text, code, shell, file, task, end = page.parts
    assert text == Text("Some text.\n\nOnly in the course.")
    assert code == Code(
        (Typed("TUT> ", "(list 1\n       2)", "(1 2)\n"), Typed("TUT> ", "(car 7)", "debugger invoked\n"), Typed("0] ", "0", "")),
        (Typed("=> ", "[1 2]", "[1 2]\n"),),
    )
    assert code.lisp[0].text == "(list 1\n  2)"
    assert shell == Text("```sh\n$ ls\n```")
    assert file == File(("a.lisp", "# not a heading\n"), ("a.hy", "(setv a 1)\n"))
    assert task == Task(
        "do-it", "Do it", "Do it.", {"lisp": "(defun f () 0)\n", "hy": "(defn f [] 0)\n"}, ("One.", "Two."), ({"ask": [["(f)", "1"]]},)
    )
    assert end == Text("Behind the task.\n\n## And then\n\nThe end.")


def test_two_blocks_of_one_language_are_two_parts():
    page = reading.read("x", "# X\n\n```lisp\nTUT> 1\n1\n```\n\n```lisp\nTUT> 2\n2\n```\n")
    assert [len(part.lisp) for part in page.parts] == [1, 1]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("no heading", "x.md: its first line is not a heading"),
        ("# X\n\n### Task: t\n\n<!-- task: t\nask = [\n-->\n\nDo.\n", "x.md, task t: the comment is not TOML"),
        ("# X\n\n### Task: t\n\n<!-- task: t\nask = []\n-->\n\nDo.\n", "x.md, task t: it has no hints"),
        ('# X\n\n### Task: t\n\n<!-- task: t\nwithin = 1\n[[check]]\nask = []\n-->\n\nDo.\n', "beside \\[\\[check\\]\\] stand within"),
    ],
)  # fmt: skip
def test_a_page_that_cannot_be_used(text, told):
    with pytest.raises(reading.PageError, match=told):
        reading.read("x", text)


def test_a_page_that_is_not_there():
    with pytest.raises(reading.PageError, match="There is no page nowhere. There are first-forms, "):
        reading.page("nowhere")


@pytest.mark.parametrize("name", contents.NAMES)
def test_each_page_has_tasks_with_hints_in_steps_and_solutions(name):
    tasks = reading.page(name).tasks
    assert 2 <= len(tasks) <= 5
    for task in tasks:
        assert len(task.hints) >= 2 and task.markdown and task.checks
        assert set(task.start) in ({"lisp", "hy"}, set())
        for ending in ENDINGS.values():
            assert (SOLUTIONS / f"{task.name}{ending}").is_file()


def test_each_task_has_a_name_of_its_own_and_each_solution_a_task():
    names = [task.name for page in reading.pages() for task in page.tasks]
    assert len(names) == len(set(names)) and {path.stem for path in SOLUTIONS.iterdir()} == set(names)


def test_no_page_of_the_course_says_what_only_concerns_an_installation():
    texts = [part.markdown for page in reading.pages() for part in page.parts if isinstance(part, Text)]
    assert not [text for text in texts if "start the prompt in" in text.lower() or "pip install" in text or "--view" in text]
