"""Each symbol of Common Lisp answers as in SBCL 2.2.9: one test a symbol, over the chapters in ``symbols/``.

``symbols/record.lisp`` says how the files are written and made. The sections run by the compiler and the whole image, each in a
package of its own that uses only COMMON-LISP.
"""

import re
import shutil
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import ProgramError
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.files.files import lisp_path
from cramhy_runtime.languages.commonlisp.pathnames.pathnames import DEFAULTS
from cramhy_runtime.languages.commonlisp.objects.classes import class_name
from cramhy_runtime.languages.commonlisp.objects.instances import InitargError
from cramhy_runtime.lisp_core.packages import COMMON_LISP, Package, delete_package, register, sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.streams.streams import StringInputStream, StringOutputStream
from cramhy_runtime.repl.session import Session, condition_of

FOLDER = Path(__file__).parent / "symbols"
USAGE = Path(__file__).parents[2] / "docs" / "reference" / "common-lisp-usage.tsv"
ANSWERS = ("=>", "!! ", "|")
PROGRAM_ERROR = "!! PROGRAM-ERROR"
SBCL_PROGRAM_ERRORS = (
    "!! ARG-COUNT-ERROR",
    "!! SIMPLE-PROGRAM-ERROR",
    "!! COMPILED-PROGRAM-ERROR",
    "!! INTERPRETED-PROGRAM-ERROR",
    "!! UNKNOWN-KEYWORD-ARGUMENT",
    "!! DEFMACRO-LAMBDA-LIST-B",
    PROGRAM_ERROR,
    "!! INPUT-ERROR-IN",
)
ADDRESS = re.compile(r"\{[0-9A-F]{6,}\}")
SECTION_PACKAGE = re.compile(r"SECTION-\d+")
PACKAGE, PRINT_PRETTY = sym("*PACKAGE*"), sym("*PRINT-PRETTY*")
STANDARD_INPUT, STANDARD_OUTPUT, TRACE_OUTPUT = sym("*STANDARD-INPUT*"), sym("*STANDARD-OUTPUT*"), sym("*TRACE-OUTPUT*")


def sections(path):
    """(symbol, [(form, answer)]) for each section of the file; an answer is a list of lines."""
    found, form, answer = [], [], []
    for line in [*path.read_text().splitlines(), ""]:
        if line.startswith(ANSWERS):
            answer.append(line)
            continue
        if answer:
            found[-1][1].append(("\n".join(form), answer))
            form, answer = [], []
        if line.startswith(";; "):
            found.append((line[3:].strip(), []))
        elif line and not line.startswith(";"):
            form.append(line)
    assert not form, f"{path.name}: no answer is recorded for {form[0]}"
    return found


OF_THE_C_LIBRARY = set("acos acosh asin asinh atan atanh cis cos cosh exp expt log phase sin sinh tan tanh".split())
"""Sections whose answers are the C library's, which may differ in the last digit from one system to the next."""

SECTIONS = [pytest.param(questions, id=name) for path in sorted(FOLDER.glob("*.txt")) for name, questions in sections(path)]


@pytest.fixture(scope="module")
def session():
    yield Session(time="virtual", turtlesim=False)
    kernel.stop()


def words(text):
    return " ".join(text.split())


def report(condition):
    try:
        return condition.report()
    except Condition:
        return "(its report fails)"


def answer(session, text, folder):
    """The lines that we would write into the file behind the form ``text``, with ``folder`` called /here."""
    output = StringOutputStream()
    with binding(STANDARD_OUTPUT, output, TRACE_OUTPUT, output, STANDARD_INPUT, StringInputStream("")):
        try:
            values = session.evaluate_text(text)
        except (Condition, Exception) as problem:
            condition = condition_of(problem)
            with binding(PRINT_PRETTY, None):
                line = words(f"!! {class_name(type(condition)).name} {report(condition)}")
            own = isinstance(condition, InitargError) or class_name(type(condition)).package is PACKAGE.value
            if isinstance(condition, ProgramError) and not own:
                line = PROGRAM_ERROR
        else:
            with binding(PRINT_PRETTY, None):
                line = words("=> " + " ; ".join(prin1_to_string(value) for value in values))
    lines = [*(f"| {shown}".rstrip() for shown in output.text().splitlines()), comparable(line)]
    return [line.replace(str(folder), "/here") for line in lines]


def recorded(line):
    """Malformed calls are program errors in both, each in its own words."""
    return PROGRAM_ERROR if line.startswith(SBCL_PROGRAM_ERRORS) else comparable(line).rstrip()


def nearly(line):
    """``line`` with 15 digits of its double floats."""
    return re.sub(r"\d+\.\d+(?=d0)", lambda found: f"{float(found[0]):.15g}", line)


def comparable(line):
    """``line`` without what differs by nature: addresses, SBCL's name for a section's package and for its own variable that had the
    wrong value (told only where the call is not open-coded), its reading list, and its streams."""
    line = SECTION_PACKAGE.sub("SECTION", ADDRESS.sub("{}", line))
    line = re.sub(r"(GENERIC-FUNCTION COMMON-LISP:\S+) \(\d+\)>", r"\1>", line)  # other tests, too, add methods to these
    if line.startswith("!! "):
        line = re.sub(r" when binding \S+$| See also: .*| Stream: #<.*| Original error: .*", "", line)
        line = re.sub(r"READER-ERROR on #<.*?>: | on #<.*", "", line)
    return line


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("questions", SECTIONS)
def test_the_symbol_answers_as_in_sbcl(session, questions, request):
    package = register(Package("SECTION", use=[COMMON_LISP]))
    request.addfinalizer(lambda: delete_package(package))
    # the folder of pytest has a name so long that lines with it are broken
    with TemporaryDirectory() as folder, binding(PACKAGE, package, DEFAULTS, lisp_path(Path(folder))):
        for form, wanted in questions:
            lines = answer(session, form, folder), [recorded(line) for line in wanted]
            if request.node.callspec.id in OF_THE_C_LIBRARY:
                lines = [[nearly(line) for line in each] for each in lines]
            assert lines[0] == lines[1], form


@pytest.mark.soak
@pytest.mark.skipif(shutil.which("sbcl") is None, reason="SBCL is not installed")
@pytest.mark.parametrize("chapter", ["corners", "details"])
def test_sbcl_answers_again_as_recorded(chapter):
    """The record is SBCL's, not ours: the forms are asked again. Other versions may answer otherwise."""
    version = subprocess.run(["sbcl", "--version"], capture_output=True, text=True, check=True).stdout
    if not version.startswith("SBCL 2.2.9"):
        pytest.skip(f"the answers are those of SBCL 2.2.9, and this is {version.strip()}")
    recorder, path = FOLDER / "record.lisp", FOLDER / f"{chapter}.txt"
    with path.open() as forms:
        asked = subprocess.run(["sbcl", "--script", str(recorder)], stdin=forms, capture_output=True, text=True, timeout=120, check=True)
    lines = [list(map(comparable, text.splitlines())) for text in (asked.stdout, path.read_text())]
    assert lines[0] == lines[1]


def test_every_symbol_that_cram_code_uses_has_a_section():
    used = {line.split("\t")[0] for line in USAGE.read_text().splitlines()[1:]}
    assert used - {section.id for section in SECTIONS} == set()
