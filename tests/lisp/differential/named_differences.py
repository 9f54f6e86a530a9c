"""The differences between SBCL's answers and ours that ``docs/differences.md`` names.

A `Named` has words of that page, which a test looks for there, and a predicate of the question and both answers. An answer is compared
as it was written down, but for addresses.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

from shrinking import parts

from cramhy_runtime.lisp_core.packages import find_package

ADDRESS = re.compile(r"\{[0-9A-F]{6,}\}")


def comparable(answer: str) -> str:
    """``answer`` without what differs by nature: the addresses of objects."""
    return ADDRESS.sub("{}", answer)


class Named(NamedTuple):
    """A named difference: its words in ``docs/differences.md``, and whether an answer differs for this reason."""

    words: str
    explains: Callable[[str, str, str], bool]


def _types(answer: str) -> set[str]:
    """The standard types of the condition that an answer tells of; none if it tells of values."""
    return set(answer.splitlines()[-1].split()[1:]) if answer.splitlines()[-1].startswith("!!") else set()


def _same_but(theirs: str, ours: str, *replacements: tuple[str, str]) -> bool:
    """Whether both answers are values that are the same when each (pattern, replacement) has been applied to both."""
    for pattern, replacement in replacements:
        theirs, ours = (re.sub(pattern, replacement, text) for text in (theirs, ours))
    return theirs == ours and not _types(theirs)


def _more_specific(question: str, theirs: str, ours: str) -> bool:
    return _types(theirs) == {"ERROR"} and bool(_types(ours))


def _refused_text(question: str, theirs: str, ours: str) -> bool:
    return "READER-ERROR" in _types(ours) and bool(_types(theirs))


def _found_by_compiling(question: str, theirs: str, ours: str) -> bool:
    says_more = _types(ours) > {"ERROR"} or "(format" in question
    return _types(theirs) == {"PROGRAM-ERROR", "ERROR"} and bool(_types(ours)) and says_more


def _certain(question: str, theirs: str, ours: str) -> bool:
    uncertain = r"NIL( ;)? NIL"
    return "subtypep" in question and bool(re.search(uncertain, theirs)) and not re.search(uncertain, ours) and not _types(ours)


def _without_value(question: str, theirs: str, ours: str) -> bool:
    again = [name for name in re.findall(r"\(defclass (\S+)", question) if question.count(f"(defclass {name} ") > 1]
    return bool(again) and not _types(theirs) and not _types(ours) and (":UNBOUND" in ours or "| ((" in theirs)


def _base_characters(question: str, theirs: str, ours: str) -> bool:
    return _same_but(theirs, ours, (r"\(SIMPLE-BASE-STRING (\d+)\)", r"(SIMPLE-ARRAY CHARACTER (\1))"), ("BASE-(CHAR|STRING)", "CHARACTER"))


CHARACTERS = (r"#\\{1,2}([\w-]+|\\\"|\\{1,2}|.)", "#")
NUMBER = re.compile(r"-?\d+\.\d+(?:[esdf][+-]?\d+)?|-?\d{8,}")
"""A float, or an integer that a float of so many digits became."""
JOINED = re.compile(r"\([-/] |a(?:cos|sin|tan)h? ")
WITH_COMPLEX_RESULTS = re.compile(r"\((?:sin|cos|tan|sinh|cosh) |\((?:log|expt) .*d")


def _last_digit(question: str, theirs: str, ours: str) -> bool:
    """The same but for the last digit of floats, of a form whose constants SBCL joins or whose complex result it computes in singles."""
    may = JOINED.search(question) or "#C(" in theirs and WITH_COMPLEX_RESULTS.search(question)
    if not may or NUMBER.sub("*", theirs) != NUMBER.sub("*", ours):
        return False
    pairs = zip(NUMBER.findall(theirs), NUMBER.findall(ours), strict=True)
    pairs = [[float(re.sub("[sdf]", "e", text)) for text in pair] for pair in pairs]
    return all(abs(one - other) <= 1e-5 * abs(one) for one, other in pairs)


DENORMAL = re.compile(
    r"\d[esf]-(?:4[0-9]|39)|\d\.?\d*d-3(?:0[89]|1\d|2[0-4])|least-positive-(?:short|single|double|long)-float|scale-float"
)


def _denormal(question: str, theirs: str, ours: str) -> bool:
    """Another float, or the ratio of one, where the question or an answer has a denormal number."""
    return any(map(DENORMAL.search, (question, theirs, ours))) and not _types(theirs) and not _types(ours)


def _endless(question: str, theirs: str, ours: str) -> bool:
    return "FLOATING-POINT-OVERFLOW" in _types(theirs) and "DOUBLE-FLOAT-" in ours and "INFINITY" in ours


DECLARATION = re.compile(r"\((?:the|declare \((?:type)?) ?")
ELEMENT_TYPE = re.compile(r"\((?:simple-)?(?:array|vector) |element-type ")


def _has_empty_type(question: str, place: re.Pattern[str]) -> bool:
    """Whether one of the forms behind a ``place`` is a type specifier of no objects."""
    forms = sorted(parts(question))
    behind = [next((question[start:end] for start, end in forms if start >= found.end()), "") for found in place.finditer(question)]
    return any(_is_empty(specifier.removeprefix("'")) for specifier in behind)


def _no_object_has(question: str, theirs: str, ours: str) -> bool:
    differs = "TYPE-ERROR" in _types(ours) and (not _types(theirs) or "CONTROL-ERROR" in _types(theirs))
    return differs and _has_empty_type(question, DECLARATION)


def _is_empty(specifier: str) -> bool:
    """Whether our `subtypep`, which another chapter compares, is certain that no object is of the type."""
    return find_package("DIFFER").external["ANSWER"].function(f"(subtypep '{specifier} nil)") == "=> T ; T"


def _are_structures(question: str, theirs: str, ours: str) -> bool:
    of_these = re.search(r"\*(standard|error|trace)-(in|out)put\*|stream|make-hash-table|copy-pprint-dispatch|find-restart", question)
    refused = _types(ours) == {"TYPE-ERROR", "ERROR"}
    return "structure-object" in question and bool(of_these) and not _types(theirs) and (refused or not _types(ours))


def _defined_again(question: str, theirs: str, ours: str) -> bool:
    names = re.findall(r"\(defstruct \(?([^\s()]+)", question)
    return len(names) > len(set(names)) and _types(theirs) == {"ERROR"} and not _types(ours)


def _bounds_pass(question: str, theirs: str, ours: str) -> bool:
    crossed = any(int(start) > int(end) for start, end in re.findall(r":start (\d+) :end (\d+)", question))
    return crossed and bool(re.search(r"\((position|find)", question)) and "TYPE-ERROR" in _types(ours) and not _types(theirs)


def _behind_the_end(question: str, theirs: str, ours: str) -> bool:
    asked = re.search(r"\(elt |\(subseq .* (\d+) \1\)", question)
    return bool(asked) and "TYPE-ERROR" in _types(ours) and not _types(theirs) and "NIL" in theirs


def _map_to_lists(question: str, theirs: str, ours: str) -> bool:
    return bool(re.search(r"\(map '(cons|null|\(cons )", question)) and "TYPE-ERROR" in _types(ours) and not _types(theirs)


def _inapplicable(question: str, theirs: str, ours: str) -> bool:
    """Whether a method may be there that the combination does not know and that does not apply."""
    return bool(re.search(r"\(defmethod \S+ [^\s()]+ \(", question)) and _types(theirs) == {"ERROR"} and not _types(ours)


NAMED = [
    Named("Where SBCL signals a plain `error`", _more_specific),
    Named("Text that cannot be read is a `reader-error`", _refused_text),
    Named("an error that SBCL's compiler finds is a `program-error`", _found_by_compiling),
    Named("`subtypep` is certain of more than SBCL's", _certain),
    Named(
        "The slot that an `&aux` variable without a form leaves empty",
        lambda question, theirs, ours: "&aux" in question and ("#<unbound>" in theirs or "TYPE-ERROR" in theirs),
    ),
    Named(
        "A character prints as itself when `*print-readably*` is true",
        lambda question, theirs, ours: "readably" in question and _same_but(theirs, ours, CHARACTERS),
    ),
    Named(
        "hash tables are not printed readably",
        lambda question, theirs, ours: "MAKE-HASH-TABLE" in theirs.upper() and ours.startswith("!! PRINT-NOT"),
    ),
    Named("the last digit may differ from what its functions give", _last_digit),
    Named("They are read as the nearest float there is", _denormal),
    Named("beyond the largest one is infinite where the compiler adds them in place, and so is a quotient", _endless),
    Named(
        "SBCL divides by zero",
        lambda question, theirs, ours: "DIVISION-BY-ZERO" in _types(theirs) and "(log " in question and "=> #C(" in ours,
    ),
    Named("literals of the same characters may be `eq`", lambda question, theirs, ours: bool(re.search(r'#\d=\\?"', ours))),
    Named("Names of symbols and texts of the reader are strings of characters", _base_characters),
    Named(
        "whose name reads as a float",
        lambda question, theirs, ours: _same_but(theirs, ours, (r"\|([+-]?\d*\.?\d+([ESFDL][+-]?\d+)?)\|", r"\1")),
    ),
    Named(
        "checked when they are used",
        lambda question, theirs, ours: "*print-" in question and "TYPE-ERROR" in _types(theirs) and not _types(ours),
    ),
    Named("counts a slot without a value as a new one", _without_value),
    Named(
        "A shared slot that inherits its initform",
        lambda question, theirs, ours: (
            ":allocation :class" in question and "(incf *counter*)" in question and _same_but(theirs, ours, (r"\d+", "0"))
        ),
    ),
    Named(
        "changes a read-only slot of a structure",
        lambda question, theirs, ours: (
            ":read-only" in question and "(setf (slot-value" in question and "UNDEFINED-FUNCTION" in _types(theirs)
        ),
    ),
    Named("A structure that is defined again with other slots", _defined_again),
    Named("A declared type that no object has", _no_object_has),
    Named("evaluates itself for ever", lambda question, theirs, ours: "STORAGE-CONDITION" in _types(theirs) and bool(_types(ours))),
    Named(
        "never gives SBCL's own classes",
        lambda question, theirs, ours: (
            "class-of" in question and ("SB-KERNEL:" in theirs or "SIMPLE-CHARACTER-STRING" in theirs or "COMPLEX-" in theirs)
        ),
    ),
    Named("are not of the type `structure-object`", _are_structures),
    Named(
        "`defmethod` without a lambda list",
        lambda question, theirs, ours: bool(re.search(r"\(defmethod \S+( [^\s()]+)*\)", question)) and "PROGRAM-ERROR" in _types(ours),
    ),
    Named(
        "`call-next-method` outside of a method",
        lambda question, theirs, ours: (
            "next-method" in question and "UNDEFINED-FUNCTION" in _types(theirs) and "PROGRAM-ERROR" in _types(ours)
        ),
    ),
    Named(
        "A form that is a dotted list",
        lambda question, theirs, ours: " . " in question and "TYPE-ERROR" in _types(theirs) and _types(ours) == {"PROGRAM-ERROR", "ERROR"},
    ),
    Named(
        "A vector of the element type nil is a string",
        lambda question, theirs, ours: not _types(theirs) and _has_empty_type(question, ELEMENT_TYPE),
    ),
    Named("A start behind the end is always an error", _bounds_pass),
    Named("An index behind the end of a list is always an error for `elt` and `subseq`", _behind_the_end),
    Named("`map` to a type of lists is an error", _map_to_lists),
    Named("A method with qualifiers that its combination does not know", _inapplicable),
    Named(
        "A symbol without a function may be given to a function that never calls it",
        lambda question, theirs, ours: (
            "UNDEFINED-FUNCTION" in _types(theirs) and not _types(ours) and bool(re.search(r"'[a-z]|[( ](nil|t)[ )]", question))
        ),
    ),
    Named(
        "shows the parameters that its Python code has",
        lambda question, theirs, ours: _same_but(theirs, ours, (r"(?<=\(LAMBDA )\([^()]*\)", "()"), ("NIL(?= {})", "()")),
    ),
]


def named(question: str, theirs: str, ours: str) -> Named | None:
    """The difference that explains why the answers differ, or ``None``."""
    return next((difference for difference in NAMED if difference.explains(question, theirs, ours)), None)
