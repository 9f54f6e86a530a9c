"""The names of types in ``typep``, ``subtypep`` and ``coerce``: what SBCL answers (``sbcl/type_names.txt``)."""

from pathlib import Path

FOLDER = Path(__file__).parent / "sbcl"
OF_THE_IMPLEMENTATION = {"COMPILED-FUNCTION", "STANDARD-CLASS", "STANDARD-OBJECT", "STRUCTURE-OBJECT"}
"""Whether system classes, streams and hash tables are of these types is SBCL's own affair."""
UNDECIDED = {"ATOM", "COMPLEX", "(AND INTEGER (NOT (EQL 3)))", "(NOT SYMBOL)"}
"""Complements, of which SBCL knows more: there our answer may be "unknown"."""
ALL_STRINGS_ARE_OF_CHARACTERS = {(name, "(VECTOR CHARACTER)") for name in ("STRING", "SIMPLE-STRING", "(STRING 3)")}
"""SBCL has strings of base characters too."""


def answers(session):
    from cramhy_runtime.languages.commonlisp.streams.streams import STANDARD_OUTPUT, StringOutputStream

    output = StringOutputStream()
    STANDARD_OUTPUT.value, before = output, STANDARD_OUTPUT.value
    try:
        session.package = "COMMON-LISP-USER"
        session.evaluate_text((FOLDER / "type_names.lisp").read_text())
    finally:
        STANDARD_OUTPUT.value = before
    return output.take().splitlines()


def test_the_names_of_types_mean_what_they_mean_in_sbcl(session):
    expected, found = (FOLDER / "type_names.txt").read_text().splitlines(), answers(session)
    assert len(expected) == len(found) > 200
    names = [line.rsplit(": ", 1)[0] for line in expected if not line.startswith(("sub ", "coerce "))]
    wrong = []
    for theirs, ours in zip(expected, found):
        head, bits = theirs.rsplit(": ", 1)
        if head.startswith("coerce"):
            if theirs != ours and "BASE-STRING" not in head:
                wrong.append((head, theirs, ours))
        elif head.startswith("sub "):
            name = head[4:]
            wrong += [
                (head, other, yes, no)
                for other, yes, no in zip(names, bits, ours.rsplit(": ", 1)[1])
                if yes != no
                and not {name, other} & OF_THE_IMPLEMENTATION
                and (name, other) not in ALL_STRINGS_ARE_OF_CHARACTERS
                and not (name in UNDECIDED and no == "?")
            ]
        elif theirs != ours and head not in OF_THE_IMPLEMENTATION:
            wrong.append((head, theirs, ours))
    assert not wrong
