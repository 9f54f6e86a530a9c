"""What is printed reads back as the same, and reading anything at all gives an object or a reader error.

Short in ``make test``; with CRAMHY_SOAK=1 (``make soak``) 10,000 forms and 100,000 texts. The figures are in ``docs/explanation/reliability.md``.
"""

from __future__ import annotations

import math
import random
import time
from pathlib import Path

import pytest
from systems import SOAK
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.languages.commonlisp.collections.array_making import make_array
from cramhy_runtime.lisp_core.arrays import LispArray, bit_vector
from cramhy_runtime.lisp_core.condition_types import EndOfFile, ReaderError
from cramhy_runtime.lisp_core.conditions import Condition, Warning_, handler_bind, muffle_warning
from cramhy_runtime.lisp_core.data import Character, Cons, FreshString, LispString, Symbol, list_from, one
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import evaluate
from cramhy_runtime.languages.commonlisp.pathnames.pathnames import parse_namestring
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.languages.commonlisp.numbers.complex_numbers import SingleComplex, exact
from cramhy_runtime.languages.commonlisp.objects.structures import slots_of
from cramhy_runtime.lisp_core.packages import Package, find_package, intern, keyword, register, sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.syntax.backquote import QUASIQUOTE, Comma
from cramhy_runtime.languages.commonlisp.reader.reader import Reader
from cramhy_runtime.languages.commonlisp.reader.readtables import STANDARD
from cramhy_runtime.languages.commonlisp.packages.package_errors import PackageLockedError

FORMS, TEXTS, SECONDS_A_TEXT = (10_000, 100_000, 5) if SOAK else (120, 3_000, 5)


@pytest.fixture(scope="module", autouse=True)
def lisp():
    kernel.start(clock="virtual")
    boot()
    for name in ODD_PACKAGES:
        if find_package(name) is None:
            register(Package(name))
    with binding(sym("*PACKAGE*"), find_package("COMMON-LISP-USER")):
        evaluate(Reader("(defstruct (ship (:constructor ship (name |crew|))) name |crew|)").read())
    yield
    kernel.stop()


# ------------------------------------------------------------------------------------------------------------------------ forms

ODD_PACKAGES = ("ODD PACKAGE", "lower", "A:B", "1", "x|y")
SETTINGS = {
    "*PRINT-BASE*": st.integers(2, 36),
    "*PRINT-RADIX*": st.sampled_from([None, True]),
    "*PRINT-PRETTY*": st.sampled_from([None, True]),
    "*PRINT-CASE*": st.sampled_from(["UPCASE", "DOWNCASE", "CAPITALIZE"]).map(keyword),
    "*PRINT-RIGHT-MARGIN*": st.sampled_from([None, 1, 20, 40, 80]),
    "*PRINT-MISER-WIDTH*": st.sampled_from([None, 10, 40]),
}
CASES = ("UPCASE", "DOWNCASE", "PRESERVE", "INVERT")

characters = st.characters(exclude_categories=["Cs"])
texts = st.text(characters, max_size=12)
glyphs = characters.filter(lambda char: char != " ")  # "#\\ " at the end of a line loses its space, in SBCL too
names = st.one_of(
    st.sampled_from(
        "a A Car |  . .. ... 1 -1 +1 1/2 1e5 1.5d0 + - 1+ a.b :a a: a:b NIL nil T #a a# 'a `a ,a a;b (a \\ \\| \" 1E ^ _ É é "
        "ABC abc aBc FF ff 10 1A a1 ß".split(" ")
    ),
    st.text(st.sampled_from("aAbB1-+./ |\\:#;'\"(),`eEdD_^~\n\t"), min_size=1, max_size=6),
    texts,
)
symbols = st.one_of(
    names.map(lambda name: intern(name, "COMMON-LISP-USER")),
    names.map(keyword),
    st.sampled_from(["CAR", "LIST", "QUOTE"]).map(sym),
    st.tuples(names, st.sampled_from(ODD_PACKAGES)).map(lambda pair: intern(*pair)),
    st.sampled_from([None, True]),
)
singles = st.floats(allow_nan=False, allow_infinity=False, width=32).map(SingleFloat)
doubles = st.floats(allow_nan=False, allow_infinity=False)
integers = st.one_of(st.integers(-100, 100), st.integers(-(2**70), 2**70), st.integers(-(10**400), 10**400))
ratios = st.fractions().map(lambda ratio: ratio.numerator if ratio.denominator == 1 else ratio)
complexes = st.one_of(
    st.tuples(st.integers(-9, 9), st.fractions()).map(lambda parts: exact(*parts)),
    st.tuples(singles, singles).map(lambda p: SingleComplex(*p)),
    st.tuples(st.floats(-1e9, 1e9), st.floats(-1e9, 1e9)).map(lambda parts: complex(*parts)),
)
bits = st.lists(st.integers(0, 1), max_size=9).map(bit_vector)
pathnames = st.text(st.characters(codec="utf-8", exclude_characters="\0*?[]\\"), max_size=12).map(lambda text: one(parse_namestring(text)))
atoms = st.one_of(symbols, singles, doubles, integers, ratios, complexes, glyphs.map(Character), texts, texts.map(FreshString), bits)


@st.composite
def forms(draw, depth=3):
    def inner(most, least=0):
        return [draw(forms(depth - 1)) for _ in range(draw(st.integers(least, most)))]

    kind = draw(st.integers(0, 8)) if depth else 0
    if kind in (0, 1):
        return draw(atoms)
    if kind == 2:
        return list_from(inner(5))
    if kind == 3:
        *items, tail = inner(4, 2)
        for item in reversed(items):
            tail = Cons(item, tail)
        return tail
    if kind == 4:
        return inner(4)
    if kind == 5:
        return list_from([draw(st.sampled_from([sym("QUOTE"), sym("FUNCTION")])), *inner(1, 1)])
    if kind == 6:
        contents, rank = inner(1, 1)[0], draw(st.integers(0, 3))
        for _ in range(rank):
            contents = list_from([contents] * 2)
        return make_array(list_from([2] * rank), initial_contents=contents)
    if kind == 7:
        return intern("SHIP", "COMMON-LISP-USER").function(*inner(2, 2))
    commas = st.sampled_from([None, ",", ",@", ",."])
    items = [(draw(commas), item) for item in inner(4, 1)]
    return list_from([QUASIQUOTE, list_from([item if comma is None else Comma(comma, item) for comma, item in items])])


@st.composite
def knots(draw):
    """Forms with shared and circular parts and symbols without a package."""
    ship = intern("SHIP", "COMMON-LISP-USER").function
    leaves = atoms.filter(lambda atom: atom is not sym("QUOTE"))  # 'a does not show that the rest of the list is shared
    parts = [Cons(draw(leaves), None) for _ in range(3)] + [[draw(atoms)] for _ in range(2)] + [Symbol(draw(names)) for _ in range(2)]
    parts += [ship(draw(leaves), draw(st.sampled_from(parts))) for _ in range(2)]
    for part in parts:
        if part.__class__ is list:
            part.extend(draw(st.lists(st.sampled_from(parts), max_size=3)))
        elif part.__class__ is Cons:
            if draw(st.booleans()):
                part.car = draw(st.sampled_from(parts))
            part.cdr = draw(st.sampled_from([None, *parts]))
        elif hasattr(part.__class__, "lisp_structure"):
            setattr(part, part.lisp_structure.slots[0].attribute, draw(st.sampled_from(parts)))
    return list_from([draw(st.sampled_from(parts)) for _ in range(3)])


def same(a, b, sharing):
    """Whether two objects are alike; with ``sharing`` whether the same parts are shared, too."""
    todo, there, back = [(a, b)], {}, {}
    while todo:
        a, b = todo.pop()
        if sharing and (
            isinstance(a, (Cons, list)) or hasattr(a.__class__, "lisp_structure") or isinstance(a, Symbol) and a.package is None
        ):
            if id(a) in there or id(b) in back:
                if there.get(id(a)) is not b or back.get(id(b)) is not a:
                    return False
                continue
            there[id(a)], back[id(b)] = b, a
        if isinstance(a, (str, LispString)):
            if not isinstance(b, (str, LispString)) or str(a) != str(b):
                return False
            continue
        if a.__class__ is not b.__class__:
            return False
        if isinstance(a, Cons):
            todo += [(a.car, b.car), (a.cdr, b.cdr)]
        elif isinstance(a, list):
            if len(a) != len(b) or getattr(a, "element_type", True) is not getattr(b, "element_type", True):
                return False
            todo += zip(a, b, strict=True)
        elif isinstance(a, LispArray):
            if a.dimensions != b.dimensions:
                return False
            todo += zip(a.active(), b.active(), strict=True)
        elif isinstance(a, Comma):
            if a.kind != b.kind:
                return False
            todo.append((a.form, b.form))
        elif isinstance(a, Symbol):
            if a is not b and (a.package or b.package or a.name != b.name):
                return False
        elif hasattr(a.__class__, "lisp_structure"):
            todo += [(mine, its) for (_, mine), (_, its) in zip(slots_of(a), slots_of(b), strict=True)]
        elif a.__class__ is complex:
            todo += [(a.real, b.real), (a.imag, b.imag)]
        elif isinstance(a, float):
            if a != b or math.copysign(1, a) != math.copysign(1, b):
                return False
        elif a != b:
            return False
    return True


def reread(form, values, case, **more):
    """(the text of ``form`` printed under the settings, what reading that gives)."""
    table = STANDARD.copy()
    table.case = keyword(case)
    settings_ = {
        **values,
        **more,
        "*READTABLE*": table,
        "*READ-BASE*": values["*PRINT-BASE*"],
        "*PACKAGE*": find_package("COMMON-LISP-USER"),
        "*PRINT-LENGTH*": None,
        "*PRINT-LEVEL*": None,
        "*PRINT-LINES*": None,
    }
    with binding(*[part for name, value in settings_.items() for part in (sym(name), value)]):
        text = prin1_to_string(form)
        try:
            return text, Reader(text, strict=True).read()
        except Condition as problem:
            raise AssertionError(f"{text!r} is not readable: {problem.report()}") from problem


PROPERTY = settings(max_examples=FORMS, deadline=None, suppress_health_check=list(HealthCheck))


@pytest.mark.soak
@PROPERTY
@given(forms(), st.fixed_dictionaries(SETTINGS), st.sampled_from(CASES))
def test_a_form_that_is_printed_reads_back_as_the_same(form, values, case):
    text, found = reread(form, values, case)
    assert same(form, found, sharing=False), text


@pytest.mark.soak
@PROPERTY
@given(knots(), st.fixed_dictionaries(SETTINGS), st.sampled_from(CASES))
def test_shared_and_circular_parts_are_shared_and_circular_again(form, values, case):
    text, found = reread(form, values, case, **{"*PRINT-CIRCLE*": True})
    assert same(form, found, sharing=True), text


@PROPERTY
@given(pathnames)
def test_a_path_name_reads_back_as_the_same(path):
    with binding(sym("*PACKAGE*"), find_package("COMMON-LISP-USER")):
        assert Reader(prin1_to_string(path)).read() == path


# ------------------------------------------------------------------------------------------------------------------------ texts

READING = (ReaderError, EndOfFile, PackageLockedError)
"""The conditions of reading; the last is SBCL's for a new symbol in COMMON-LISP."""
SCRAPS = (
    """( ) ' ` , ,@ ,. . .. ; " | \\ # #( #' #\\ #| |# #+ #- #. #1= #1# #= ## #b #o #x #2r #c( #* #3* #2A #0A #A #: #s( #p #< #) cl:
cl:: nope: :a a: a:b::c 1/0 1/2 1e400 1d0 -1.5e+3 +. #\\Space #\\x #\\( |a #+(and #-(or #(1 2 #1=(a . #1#)
#.(car 5) #S(nope :a 1) #P5
#99999999999(1) #37r1 #2A((1) 2) a\\ \x00 \ud800 \ufeff \x7f \xa0 λ İ ß ﬁ #5(1
#C(a b) #!x #@ #^ #5 #_""".split()
    + [" ", "\n", "\t", "\r\n"]
)
REAL = "\n".join(
    line
    for path in sorted((Path(__file__).parent / "symbols").glob("*.txt"))
    for line in path.read_text().splitlines()
    if line.startswith(("(", "'", "`", "#", '"'))
)


def any_text(chance):
    kind, size = chance.randrange(4), int(2 ** chance.uniform(0, 8))
    if kind == 0:
        return chance.randbytes(size).decode(chance.choice(["latin-1", "utf-8", "utf-16", "cp437"]), "replace")
    if kind == 1:
        return "".join(chance.choice([" ", "", ""]) + chance.choice(SCRAPS) for _ in range(size // 4 + 1))
    start = chance.randrange(len(REAL) - size)
    text = list(REAL[start : start + size])
    for _ in range(1 + size // 16):  # real Lisp with accidents
        where, accident = chance.randrange(len(text) + 1), chance.randrange(4)
        if accident == 0:
            text.insert(where, chance.choice(SCRAPS))
        elif accident == 1:
            del text[where : where + chance.randrange(4)]
        elif accident == 2:
            text[where:where] = text[max(0, where - 9) : where]
        else:
            text[where : where + 1] = chr(chance.randrange(256))
    return "".join(text)


def read_all(text, strict):
    """The condition that reading ``text`` to its end signals, or ``None``."""
    reader = Reader(text, filename="x.lisp", strict=strict)
    try:
        handler_bind([(Warning_, lambda warning: muffle_warning(warning))], lambda: [None for _ in reader.read_all()])
    except Condition as condition:
        return condition
    return None


@pytest.mark.soak
def test_reading_anything_gives_objects_or_a_reader_error():
    chance, slowest = random.Random(20261121 if not SOAK else None), 0
    package = Package("SCRATCH", use=[find_package("COMMON-LISP")])
    with binding(sym("*READ-EVAL*"), None, sym("*PACKAGE*"), package):
        for _ in range(TEXTS):
            text = any_text(chance)
            start = time.perf_counter()
            try:
                problem = read_all(text, chance.random() < 0.5)
            except Exception as error:
                raise AssertionError(repr(text)) from error
            slowest = max(slowest, time.perf_counter() - start)
            if problem is not None:
                assert isinstance(problem, READING), (text, problem)
                assert problem.report() and problem.position[0] == "x.lisp", text
                assert 1 <= problem.position[1] <= text.count("\n") + 1, text
    print(f"{TEXTS} texts, the slowest in {slowest * 1000:.0f} ms")
    assert slowest < SECONDS_A_TEXT


@pytest.mark.parametrize("name", ["\u2126", "\uff21", "A\xb2", "A\u2460", "E\u0301", "A\ufb01B"])
def test_a_name_that_the_reader_would_normalize_has_bars(name, session):
    """As in SBCL: without bars ``\u2126`` would be read as ``\u03a9``."""
    session.package = "CL-USER"
    assert session.evaluate_text(f'(prin1-to-string (intern "{name}"))') == [f"|{name}|"]
    assert session.evaluate_text(f'(let ((s (intern "{name}"))) (eq s (read-from-string (prin1-to-string s))))') == [True]
