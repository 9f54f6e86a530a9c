"""Makes the recorded answers of other programs again: ``make recorded``, or ``python tests/recorded.py [NAME ...]``.

`RECORDINGS` says which file holds answers of which program, and by which command they are made. A recording whose program (or library) is
not installed is told and left as it is. ``git diff`` shows what has changed. Debian has what they need: apt install sbcl cl-alexandria roslisp.
``test_recorded.py`` makes a few of them again where SBCL is, as the tests of continuous integration do.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

TESTS = Path(__file__).parent
SBCL = ("sbcl", "--script")
PATIENCE = 300  # s that a program may take for one file


@dataclass(frozen=True)
class Recording:
    """A file with answers. command: what makes them. given: what it reads, ``"file"`` on its standard input, ``"forms"`` as a file of the
    forms alone whose name is in the variable FORMS, or ``""``. comments: whether it leaves out lines that begin with a semicolon."""

    path: Path
    command: tuple[str, ...]
    given: str = "file"
    comments: bool = False
    library: str = ""  # a folder that must be there

    @property
    def name(self) -> str:
        return self.path.relative_to(TESTS).as_posix()

    @property
    def lacking(self) -> str | None:
        """What has to be installed to make it, or ``None``."""
        if shutil.which(self.command[0]) is None:
            return self.command[0]
        return self.library if self.library and not Path(self.library).exists() else None

    def made(self) -> str:
        """The file as the program makes it now. What the program writes of an address or a process is as it is there."""
        old = self.path.read_text()
        with tempfile.TemporaryDirectory() as folder:
            environment = {
                **os.environ,
                "LC_ALL": "C.UTF-8",
                "ASDF_OUTPUT_TRANSLATIONS": f'(:output-translations (t "{folder}/") :ignore-inherited-configuration)',
            }
            if self.given == "forms":
                forms = Path(folder) / "forms.lisp"
                forms.write_text("".join(json.loads(line)[0] + "\n" for line in old.splitlines()))
                environment["FORMS"] = str(forms)
            done = subprocess.run(
                self.command,
                input=old if self.given == "file" else "",
                capture_output=True,
                text=True,
                cwd=self.path.parent,
                env=environment,
                timeout=PATIENCE,
                check=True,
            )
        return "".join(f"{line}\n" for line in old.splitlines() if line.startswith(";")) + done.stdout if self.comments else done.stdout


INCIDENTAL = (
    (re.compile(r"\{[0-9A-F]{6,}\}"), "{}"),  # an address
    (re.compile(r"SECTION-\d+"), "SECTION"),  # the package of a section: it is counted
    (re.compile(r"#:[A-Z-]*\d+"), "#:"),  # a gensym
    (re.compile(r':IN "[^"]*/tests/'), ':IN "tests/'),  # where the tests lie
    (re.compile(r"^;.*\n", re.M), ""),
)
"""What differs from run to run and says nothing of the answers."""


def answers(text: str) -> str:
    """``text`` without what is `INCIDENTAL`."""
    for pattern, instead in INCIDENTAL:
        text = pattern.sub(instead, text)
    return "\n".join(json.dumps(json.loads(line)) if line.startswith('["') else line for line in text.splitlines())


def _of_forms(folder: str, *names: str, **more) -> list[Recording]:
    return [Recording(TESTS / folder / name, (*SBCL, "record.lisp"), **more) for name in names]


RECORDINGS = [
    *_of_forms(
        "lisp/sbcl",
        *(
            f"{name}.txt"
            for name in "arrays characters compiler corners equality hash_tables lists loop odds passes reader sequences strings".split()
        ),
        comments=True,
    ),
    *_of_forms("lisp/symbols", *sorted(path.name for path in (TESTS / "lisp" / "symbols").glob("*.txt"))),
    *_of_forms("lisp/printing", *(f"{name}.jsonl" for name in "code float_directives floats format random_data".split()), given="forms"),
    Recording(TESTS / "lisp" / "sbcl" / "uiop.txt", (*SBCL, "record_uiop.lisp"), comments=True),
    Recording(TESTS / "lisp" / "sbcl" / "type_names.txt", (*SBCL, "type_names.lisp"), given=""),
    Recording(
        TESTS / "libraries" / "alexandria.txt",
        (*SBCL, "record.lisp", "alexandria"),
        comments=True,
        library="/usr/share/common-lisp/source/alexandria",
    ),
    Recording(
        TESTS / "libraries" / "s_xml.txt",
        (*SBCL, "record.lisp", "/usr/share/roslisp/s-xml/", "s-xml"),
        comments=True,
        library="/usr/share/roslisp/s-xml",
    ),
    Recording(TESTS / "libraries" / "uiop.txt", (*SBCL, "record.lisp", "uiop"), comments=True),
    Recording(
        TESTS / "libraries" / "contributions.txt",
        (*SBCL, "record.lisp", "sb-bsd-sockets", "sb-rotate-byte", "sb-rt", "sb-posix", "sb-cltl2"),
        comments=True,
    ),
]


def main(names: list[str]) -> int:
    """Make the recordings of these names, or all; 1 if one of them could not be made."""
    status = 0
    for recording in RECORDINGS:
        if names and recording.name not in names:
            continue
        if (lacking := recording.lacking) is not None:
            print(f"{recording.name}: left as it is, since {lacking} is not installed")
            continue
        try:
            text = recording.made()
        except (subprocess.SubprocessError, OSError) as problem:
            print(f"{recording.name}: {' '.join(recording.command)} failed: {problem}")
            status = 1
            continue
        changed = answers(text) != answers(recording.path.read_text())
        if changed:
            recording.path.write_text(text)
        print(f"{recording.name}: {'CHANGED' if changed else 'the same'}")
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
