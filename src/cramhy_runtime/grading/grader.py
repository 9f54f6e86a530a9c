"""Grading: a submission is read, run in processes of its own, and judged here.

`Grader` keeps fork servers, so that many submissions are graded quickly, and several at a time. `grade` grades one. The checks are tried
one after the other, and each with its seeds; the first seed with a fault decides. A check gives all of its points or none.

To grade is a generator here: it yields a job, and is sent the answer. So one process can have several submissions in hand, and waits for
whichever fork server answers first (`processes.answers`).
"""

from __future__ import annotations

import os
from collections.abc import Generator, Iterable
from pathlib import Path

from . import allowances, judging
from .exercise import Check, Exercise, find
from .forms import source_faults
from .here import Here
from .jobs import job
from .problems import ExerciseError
from .processes import ForkServer, answers
from .report import CheckResult, Report
from .sentences import fault, said
from .told import Told
from cramhy_runtime.kernel.typing_names import Any

_Grading = Generator[dict[str, Any], "dict[str, Any] | None", Report]
LARGEST = 200_000
"""Bytes of a file of a submission."""
KEPT_OUTPUT = 2000
NOISE = "[(ROSLISP TOP) INFO]"
"""What roslisp prints when a node starts, which says nothing about a submission."""
AS_ROOT = (
    "You are root, so a gap in the sandbox would give this machine to whoever hands in. Grade as another user. If this is a container that "
    "has nothing else in it, say --as-root, Grader(as_root=True) or CRAMHY_AS_ROOT=yes."
)
SIGNALS = {
    4: "illegal instruction",
    6: "abort",
    7: "bus error",
    8: "arithmetic error",
    9: "kill",
    11: "segmentation fault",
    15: "terminate",
}


def grade(
    exercise: str | Path, submission: str | Path, seeds: int | None = None, sandbox: str | None = None, as_root: bool = False
) -> Report:
    """Grade a submission, a file or a folder. exercise: a folder, or the name of one of cramhy's. The others: see `Grader`.

    Raises `ExerciseError` if the exercise cannot be used, or if there is no such submission.
    """
    found = find(str(exercise))
    with Grader(seeds, sandbox=sandbox, as_root=as_root) as grader:
        return grader.grade(found, submission)


class Grader:
    """Grades submissions. seeds: with how many seeds checks are tried that name a number of them, ``None`` for that number.

    apart: whether a submission runs in a process of its own. If not, nothing protects this process from it (`Here`).
    at_once: how many submissions `grade_all` has in hand at a time, ``None`` for as many as there are processors.
    sandbox: "bubblewrap", "locks" for cramhy's own locks alone, or ``None`` for bubblewrap where it works.
    as_root: whether to grade although the user is root; the variable CRAMHY_AS_ROOT says it, too. Else `ExerciseError` is raised then.
    """

    def __init__(
        self, seeds: int | None = None, apart: bool = True, at_once: int | None = None, sandbox: str | None = None, as_root: bool = False
    ):
        if apart and not as_root and getattr(os, "geteuid", lambda: 1)() == 0 and not os.environ.get("CRAMHY_AS_ROOT"):
            raise ExerciseError(AS_ROOT)
        self.seeds, self.apart, self.sandbox = seeds, apart, sandbox
        self.at_once = (at_once or os.cpu_count() or 1) if apart else 1
        self.fork_servers: dict[tuple[int, tuple[str, ...]], ForkServer | Here] = {}

    def __enter__(self) -> Grader:
        return self

    def __exit__(self, *problem: object) -> None:
        for fork_server in self.fork_servers.values():
            fork_server.close()

    def grade(self, exercise: Exercise, submission: str | Path) -> Report:
        """The `Report` of a submission, a file or a folder."""
        return self.grade_texts(exercise, submitted_files(exercise, Path(submission)))

    def grade_texts(self, exercise: Exercise, submitted: dict[str, str | None]) -> Report:
        """The `Report` of a submission whose files are given as texts, by name; ``None`` for a file that is no text."""
        return self._all([(exercise, submitted)])[0]

    def grade_all(self, submissions: Iterable[tuple[Exercise, str | Path]]) -> list[Report]:
        """The `Report` of each submission, in their order. submissions: pairs of an exercise and a file or folder.

        The points are those of `grade`, whatever is graded at the same time. A file that is not there costs its own points only.
        """
        return self._all([(exercise, _files_or_none(exercise, Path(place))) for exercise, place in submissions])

    def _all(self, work: list[tuple[Exercise, dict[str, str | None]]]) -> list[Report]:
        """The report of each pair of an exercise and the texts of a submission. Each slot has one of them in hand."""
        reports: dict[int, Report] = {}
        asked: dict[ForkServer | Here, tuple[int, int, _Grading]] = {}  # for each fork server with a job: the slot, the number, the grading
        numbers = iter(range(len(work)))

        def go_on(slot, number, grading, answer):
            """Take a grading to its next job. When it is over, the slot takes the next submission."""
            while number is not None:
                try:
                    next_job = grading.send(answer)
                except StopIteration as end:
                    reports[number] = end.value
                    number = next(numbers, None)
                    grading, answer = number is not None and self._grading(*work[number]), None
                else:
                    fork_server = self._fork_server(slot, work[number][0])
                    fork_server.ask(next_job)
                    asked[fork_server] = slot, number, grading
                    return

        for slot, number in zip(range(self.at_once), numbers):
            go_on(slot, number, self._grading(*work[number]), None)
        while asked:
            for fork_server, answer in answers(list(asked)):
                go_on(*asked.pop(fork_server), answer)
        return [reports[number] for number in range(len(work))]

    def _grading(self, exercise: Exercise, submitted: dict[str, str | None]) -> _Grading:
        """Yield the jobs of a submission, each for its answer, ``None`` if its fork server was lost; the `Report`."""
        submitted = {name: text if text is not None and _is_text(text) else None for name, text in submitted.items()}
        missing = [name for name in exercise.submission if submitted.get(name) is None]
        if missing:
            words = [
                f"The file {name} is not there." if name not in submitted else f"The file {name} is not UTF-8 text, or too large."
                for name in missing
            ]
            return Report(exercise.title, [CheckResult(each.title, 0, each.points, words) for each in exercise.checks], "", [])
        results, output, held = [], "", []
        lost: list[str] | None = None
        for check in exercise.checks:
            wrong: list[str] = []
            if check.kind == "source":
                faults = source_faults(check.table["source"], submitted)
                wrong = said([fault("The text is not as it should be.", each) for each in faults], check.hidden)
            elif lost is not None:
                wrong = lost
            else:
                seeds = self.seeds if self.seeds is not None and check.seeds > 1 else check.seeds
                for seed in range(1, seeds + 1):
                    faults, printed, locks, hopeless = yield from self._try(exercise, check, seed, submitted)
                    wrong = said(faults, check.hidden, check.show_answers)
                    held = held or locks
                    if wrong:
                        if seeds > 1 and not check.hidden:
                            wrong = [f"With seed {seed}:", *wrong]
                        output = output or ("" if check.hidden else printed)
                        lost = wrong if hopeless else None
                        break
            wrong += [
                f"This counts only if the check {exercise.checks[number - 1].title!r} passes, too."
                for number in check.needs
                if not results[number - 1].passed
            ]
            results.append(CheckResult(check.title, 0 if wrong else check.points, check.points, wrong, check.table.get("hint")))
        if any(check.kind == "source" for check in exercise.checks) and not any(
            result.passed for check, result in zip(exercise.checks, results) if check.kind != "source"
        ):  # a text alone is worth nothing
            results = [result._replace(points=0) for result in results]
        return Report(exercise.title, results, output[-KEPT_OUTPUT:], held)

    def _try(self, exercise: Exercise, check: Check, seed: int, submitted: dict[str, str | None]):
        """What is wrong with a check for a seed, what was printed, the locks, and whether other checks cannot be better."""
        work, values = job(exercise, check, seed, submitted)
        answer = yield work
        if answer is None:
            ended = "The program ended the process that grades it."
            return [fault(ended, ended)], "", [], True
        told = Told(answer["reports"], work["nonce"])
        output = "".join(line for line in answer["output"].splitlines(True) if not line.startswith(NOISE))
        hopeless = told.doing in ("begin", "load")
        if told.malformed and answer["ended"] in ("left", "done") and not answer["signal"]:  # else the last line was cut off
            sentence = f"The program sends reports of its own, or destroys those of its run: {told.malformed}."
            return [fault(sentence, sentence)], output, told.held, False
        if told.error and told.doing in ("load", "before"):
            if "TIME-LIMIT" in told.error["types"]:
                wrong = fault("Loading the program never ended.", f"Loading {told.what} never ended, and was stopped.")
            else:
                wrong = fault("The program cannot be used.", f"{told.what} cannot be used:\n{told.error['text']}")
            return [wrong], output, told.held, told.doing == "load"
        if not told.done:
            return [_unfinished(told, answer, exercise)], output, told.held, hopeless
        allow = allowances.allowed(exercise, check.table)
        if check.kind == "tests":
            return judging.of_tests(check, told, allow), output, told.held, False
        judge = judging.of_answers if check.kind == "ask" else judging.of_run
        return judge(check, work, values, told, allow), output, told.held, False

    def _fork_server(self, slot: int, exercise: Exercise) -> ForkServer | Here:
        key = slot, (*exercise.systems, "lisp-unit", "fiveam")
        if key not in self.fork_servers:
            self.fork_servers[key] = ForkServer(list(key[1]), self.sandbox) if self.apart else Here()
        return self.fork_servers[key]


def _unfinished(told, answer, exercise):
    """The `Fault` of a run that did not come to its end: it names the question, or the plan, in which that happened."""
    doing = {"load": f"Loading {told.what}", "do": told.what, "ask": told.what, "before": told.what, "tests": "The tests"}
    what = doing.get(told.doing, "The program")
    limits = exercise.limits
    reasons = {
        "time": f"took more than {limits['time']:g} s of processor time, and was stopped. Is there a loop that never ends?",
        "idle": "waited for something that never came, and was stopped. Wait with the plan's clock: (cpl:sleep 1).",
        "long": "took too long, and was stopped.",
        "output": f"printed more than {limits['output']:g} kB, and was stopped.",
        "memory": f"used more than {limits['memory']:g} MB of memory, and was stopped.",
        "threads": "started too many threads, and was stopped.",
        "disk": "wrote too many files, and was stopped.",
        "sandbox": f"was not tried, because there was no sandbox for it. Grade it again. ({answer.get('why')})",
    }
    if answer["ended"] in reasons:
        why = reasons[answer["ended"]]
    elif answer["signal"]:
        why = f"ended the process by a signal ({SIGNALS.get(answer['signal'], answer['signal'])})."
    else:
        why = "ended the process before it was over."
    kind = {"ask": "A question", "do": "The plan", "tests": "The tests"}.get(told.doing, "The program")
    return fault(f"{kind} {why}", f"{what} {why}")


def _is_text(text):
    """Whether ``text`` can be written as UTF-8, and is not too large."""
    try:
        return len(text.encode()) <= LARGEST
    except UnicodeEncodeError:
        return False


def submitted_files(exercise: Exercise, place: Path) -> dict[str, str | None]:
    """The texts of the files that were handed in, by name; ``None`` for one that is no text. Raises `ExerciseError` if nothing is there.

    place: a folder, or the file itself if one file is handed in.
    """
    if place.is_dir():
        paths = {name: place / name for name in exercise.submission}
    elif place.is_file() and len(exercise.submission) == 1:
        paths = {exercise.submission[0]: place}
    elif place.is_file():
        raise ExerciseError(f"{place} is one file, but {', '.join(exercise.submission)} are handed in. Name their folder.")
    else:
        raise ExerciseError(f"There is no file or folder {place}.")
    found: dict[str, str | None] = {}
    for name, path in paths.items():
        try:
            if not path.is_file() or (place.is_dir() and place.resolve() not in path.resolve().parents):  # a link to somewhere else
                continue
            data = path.read_bytes() if path.stat().st_size <= LARGEST else None
            found[name] = None if data is None else data.decode("utf-8-sig")
        except (OSError, RuntimeError, UnicodeDecodeError):  # not to be read, links in a circle, no text
            found[name] = None
    return found


def _files_or_none(exercise: Exercise, place: Path) -> dict[str, str | None]:
    """As `submitted_files`, and an empty dictionary if nothing is there or the folder cannot be looked into."""
    try:
        return submitted_files(exercise, place)
    except (ExerciseError, OSError):
        return {}
