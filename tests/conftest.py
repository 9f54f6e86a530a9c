"""Fixtures for all rooms: where the shared references lie, and a session in virtual time."""

from __future__ import annotations

import collections
import fnmatch
import functools
import gc
import os
import re
import zlib
from pathlib import Path

import late_threads
import pytest
from systems import BACKENDS, SOAK, takes_long

from cramhy_runtime.session import Image

try:
    from hypothesis import HealthCheck, settings
except ImportError:  # a part of it is compiled, and not for WebAssembly
    settings = None

TESTS = Path(__file__).parent
LEFT_OUT = [
    (re.compile(fnmatch.translate(pattern)), int(share or 0), pattern if together else None)
    for pattern, share, together in re.findall(
        r"^(?!#)(.+?)(?: 1/(\d+)( together)?)?$", (TESTS / "long_tests.txt").read_text(encoding="utf-8"), re.M
    )
]
"""Which tests `make soak` alone runs: patterns of their names, and of how many siblings one runs everywhere (0: none does). The third is the
name of the family if all that the pattern fits are siblings; otherwise the cases of one test are."""

A_FEW_ROOMS = 8000
"""So many cases or fewer run whole: who works on a room wants every case of it."""
REPOSITORY = Path(__file__).parents[1]
SHARED = REPOSITORY.parent / "shared"


LONG = (
    "webassembly",
    "robot_world",
    "course",
    "docs",
    "libraries",
    "grading",
    "session",
    "test_standard_page.py",
    "newcomer",
    "test_interpreters.py",
    "test_missing_systems.py",
    "soak",
    "view",
    "rosbridge",
    "repl",
    "tutorials",
    "slides",
    "test_house.py",
    "test_invariants.py",
    "test_clause_index.py",
    "test_against_reference.py",
    "test_anomalies.py",
    "test_collecting.py",
)
"""Folders and files whose tests take seconds: they come first, so that on two processors neither waits for the other at the end."""

# What hypothesis makes up is the same each time, so that a change is not blamed for what an unlucky draw finds; the soak draws anew.
os.environ["CRAMHY_HISTORY"] = ""  # what tests type is not the user's
os.environ["CRAMHY_AS_ROOT"] = "yes"  # CI is root in a container, and grades what stands in the tests
if settings is not None:
    unhurried = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])  # both would look at the wall clock
    settings.register_profile("steady", unhurried, derandomize=True, max_examples=50)
    settings.register_profile("soak", unhurried)
    settings.load_profile("soak" if SOAK else "steady")

if "CRAMHY_LATE" in os.environ:
    late_threads.install(os.environ["CRAMHY_LATE"])


def pytest_collection_modifyitems(config, items):
    """Long files come first. Of a run of the whole only some siblings stay, and the others are told as deselected: to skip 13,000 one by
    one took half a minute."""
    items.sort(key=lambda item: not any(part in LONG for part in item.path.parts))
    path_of = functools.cache(lambda path: path.relative_to(TESTS).as_posix())
    families: dict[str, list] = collections.defaultdict(list)
    for item in items:
        name = f"{path_of(item.path)}::{item.name}"
        share, family = next((share, family) for pattern, share, family in LEFT_OUT if pattern.match(name))
        if not share:
            item.add_marker(takes_long)
        elif len(items) > A_FEW_ROOMS and not SOAK:
            families[f"{share} {family or name.partition('[')[0]}"].append(item)
    left_out = set()
    for name, siblings in families.items():
        share = min(int(name.partition(" ")[0]), len(siblings))
        kept = zlib.crc32(name.encode()) % share  # not always the first one, which is that on threads
        left_out.update(item for number, item in enumerate(siblings) if number % share != kept)
    if left_out:
        config.hook.pytest_deselected(items=list(left_out))
        items[:] = [item for item in items if item not in left_out]


@pytest.fixture(scope="session")
def shared():
    """The folder of the shared references; tests that need it are skipped where it is missing."""
    if not SHARED.is_dir():
        pytest.skip("the shared references are not beside this checkout")
    return SHARED


@pytest.fixture(autouse=True, scope="module")
def image_of_its_own():
    """Each file of tests has an image of its own, with what all files have defined when they were imported.

    What is there after it stays, so the collector need not look at it again: it took a third of the time of a run.
    """
    with Image(as_now=True):
        yield
    gc.collect()
    gc.freeze()


@pytest.fixture(params=BACKENDS)
def backend(request):
    """The name of a back end: a test that takes it runs on each that there can be on this system."""
    if request.param == "greenlet":
        pytest.importorskip("greenlet")
    return request.param


@pytest.fixture
def session():
    """A session in virtual time, without the turtle."""
    from cramhy_runtime import kernel
    from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
    from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
    from cramhy_runtime.repl.session import Session

    made = Session(time="virtual", turtlesim=False)
    made.package = "CRAM-USER"
    yield made
    kernel.stop()
    PACKAGE.value = COMMON_LISP_USER
