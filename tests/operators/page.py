"""``make docs``: write ``docs/operators.md``, all operators with their shapes and examples, from the tables; with ``--print`` only show it."""

import contextlib
import io
import re
import sys
import textwrap
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))

from cramhy_runtime.session import boot  # noqa: E402

boot()

from examples import EXAMPLES, hy_of  # noqa: E402
from harness import in_lisp  # noqa: E402

from cramhy_runtime.languages.hy.plan_macros import hy_shape  # noqa: E402
from cramhy_runtime.languages.operators import TABLES  # noqa: E402

PAGE = Path(__file__).parents[2] / "docs" / "operators.md"
WIDTH = 100

TITLES = {
    "CRAM-LANGUAGE-IMPLEMENTATION": "The plan language",
    "CRAM-PROLOG": "Prolog",
    "CRAM-UTILITIES": "Utilities",
    "CRAM-DESIGNATORS": "Designators",
    "CRAM-PROCESS-MODULES": "Process modules",
    "CRAM-PROJECTION": "Projection",
    "CRAM-EXECUTION-TRACE": "Episodes",
    "ROSLISP": "roslisp",
    "ACTIONLIB": "actionlib",
    "CL-TF": "tf",
}

BEGINNING = """# The operators

Every operator of the plan language and of its neighbours, as Common Lisp and as plain Hy write it, with an example. `make docs` writes
this page from the tables in `src/cramhy_runtime/languages/operators/` and the examples in `tests/operators/`. A test runs each example in
Lisp, in Hy and in Python, and compares the values, and the arguments of `note`, a function that remembers them. Both stand below the example.

In a shape, `x...` is any number of parts. Parts in `[...]` in Lisp's shapes, and in `{...}` in Hy's, may be left out; brackets in
Hy's shapes are written. In Hy, `(lisp x)` is data of Lisp, `(leave x)` takes the place of `(return x)`, and `cl` in the examples stands for
an object with the functions of Common Lisp.
"""

_TOKEN = re.compile(r"""[ \n]+|(?P<token>(?:\#'|,@|[`',~])*[(\[]|\#\(|[)\]]|"(?:[^"\\]|\\.)*"|[^\s()\[\]"]+)""")


def pretty(text):
    """A text of Lisp or Hy with a line for each form, or several where a form is long."""
    tokens = [found["token"] for found in _TOKEN.finditer(text) if found["token"]]
    forms = []
    while tokens:
        forms.append(lines(tree(tokens), 0))
    return "\n".join(forms)


def tree(tokens):
    token = tokens.pop(0)
    if token[-1] not in "([" or token[0] == '"':
        return token
    parts = [token]
    while tokens[0] not in (")", "]"):
        parts.append(tree(tokens))
    return [*parts, tokens.pop(0)]


def flat(form):
    return form if isinstance(form, str) else form[0] + " ".join(map(flat, form[1:-1])) + form[-1]


def lines(form, column):
    shown = flat(form)
    if isinstance(form, str) or column + len(shown) <= WIDTH or len(form) < 4:
        return shown
    opening, *parts, closing = form
    kept = 1
    while kept < len(parts) - 1 and len(" ".join(map(flat, parts[: kept + 1]))) < 40 and isinstance(parts[kept], str):
        kept += 1
    if kept == 1 and len(parts) > 2 and len(flat(parts[1])) < 40 and not isinstance(parts[1], str):
        kept = 2
    indent = column + (len(opening) if not isinstance(parts[0], str) or opening[-1] == "[" else len(opening) + 1)
    rest = [" " * indent + lines(part, indent) for part in parts[kept:]]
    return opening + " ".join(map(flat, parts[:kept])) + "\n" + "\n".join(rest) + closing


def outcome(example):
    """A sentence about what an example returns, and what it gives to ``note``."""
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        value, notes = in_lisp(example.lisp, "threads")
    values = [f"`{each}`" if each[:2] not in ("a ", "an") else each for each in value.split(" ; ")]
    returned = f"The value is {values[0]}" if len(values) == 1 else f"The values are {', '.join(values)}"
    return f"{returned}." if notes == "NIL" else f"{returned}. `note` was called with `{notes[1:-1]}`."


def text():
    """The page."""
    made = [BEGINNING]
    for table in TABLES:
        made.append(f"\n## {TITLES[table.package]}\n")
        for name, operator in table.items():
            example = EXAMPLES[name.lower()]
            made.append(f"### {name.lower()}\n")
            made.append(operator.documentation + "\n")
            made.append(f"* Lisp: `{operator.shape}`\n* Hy: `{hy_shape(operator)}`\n")
            made.append("<!-- tabs -->\n")
            made.append(f"```lisp\n{pretty(example.lisp)}\n```\n")
            made.append(f"```hy\n{pretty(hy_of(example))}\n```\n")
            if example.python:
                made.append(f"```python\n{textwrap.dedent(example.python).strip()}\n```\n")
            else:
                made.append(f"Python: {example.only}.\n")
            made.append(outcome(example) + "\n")
    return "\n".join(made)


if __name__ == "__main__":
    if sys.argv[1:] == ["--print"]:
        sys.stdout.write(text())
    else:
        PAGE.write_text(text(), encoding="utf-8")
