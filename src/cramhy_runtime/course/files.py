"""The folders in which a student works, and the files of the pages in them.

The lectures let a package of the student's own grow, which has the name of the one that comes with cramhy. So the lectures have a folder of
their own, and the other pages find cramhy's package.
"""

from __future__ import annotations

from pathlib import Path

from cramhy_runtime import storage
from cramhy_runtime.grading.exercise import own_exercises
from cramhy_runtime.languages.commonlisp.systems import systems

from . import contents
from .parts import Code, File, Page
from .reading import page as page_of

PACKAGE, SYSTEM = "cram_my_beginner_tutorial", "cram-my-beginner-tutorial"
"""The course's package, and its system: that of cramhy, and that which the student writes on the pages that grow."""
HY_PACKAGE = "turtlesim_in_hy"
"""The course's package in plain Hy, which the later pages import."""


def work_folder(page: Page, language: str, top: Path) -> Path | None:
    """The folder for a page below ``top``, made if the page needs files; ``None`` if it needs none."""
    imports = _imports_hy_package(page) and language == "hy"
    if not imports and not any(isinstance(part, File) for part in page.parts):
        return None
    place = top / ("lectures" if page.name in contents.GROWING else "turtle")
    place.mkdir(parents=True, exist_ok=True)
    if imports and not (place / HY_PACKAGE).exists():
        _copy(tutorials() / HY_PACKAGE, place / HY_PACKAGE)
    return place


def _copy(package, place):
    with storage.Tree() as made:
        for file in sorted(package.rglob("*")):
            if file.is_file() and "__pycache__" not in file.parts:
                target = place / file.relative_to(package)
                made.folder(target.parent)
                made.write(target, file.read_bytes())


def _imports_hy_package(page):
    written = HY_PACKAGE.replace("_", "-")
    return any(written in typed.form for part in page.parts if isinstance(part, Code) for typed in part.hy)


def tutorials() -> Path:
    """The folder with the packages that come with cramhy."""
    return next(iter(own_exercises().values())).parents[1]


def earlier(page: Page, language: str) -> dict[str, str]:
    """The files of the pages before, by name, that a page goes on with."""
    found: dict[str, str] = {}
    if page.name in contents.GROWING:
        for name in contents.GROWING[: contents.GROWING.index(page.name)]:
            found |= dict(_files(page_of(name), language))
    return found


def settle(page: Page, language: str) -> None:
    """Make a session that goes on from page to page, in one folder, ready for ``page``: that of a tab. Errors: `OSError`.

    See `provide_earlier` and `choose_package`.
    """
    provide_earlier(page, language)
    choose_package(page)


def provide_earlier(page: Page, language: str) -> None:
    """Let the files of the pages before be in the current folder. One that has this page's text already stays: a student who comes back
    to the page has written it. One with the text of a later page is set back. Errors: `OSError`."""
    own = set(_files(page, language))
    for name, text in earlier(page, language).items():
        path = Path(name)
        if not (path.is_file() and (name, path.read_text(encoding="utf-8", errors="replace")) in own):
            provide(name, text)


def choose_package(page: Page) -> None:
    """Let the course's system be the student's own on the pages on which that grows, and cramhy's on all others: it has the same name."""
    own = None if page.name in contents.GROWING else tutorials() / PACKAGE / f"{SYSTEM}.asd"
    if systems.chosen.get(SYSTEM) != own:
        systems.forget_system(SYSTEM)
        systems.chosen.pop(SYSTEM, None)
        if own is not None:
            systems.chosen[SYSTEM] = own


def _files(page, language):
    for part in page.parts:
        if isinstance(part, File) and (file := getattr(part, language)) is not None:
            yield file


def shown(name: str) -> str:
    """A file of the current folder, with the two folders above, in which a student finds it."""
    here = Path.cwd()
    return "/".join([*here.parts[-2:], name]) if len(here.parts) > 2 else name


def known_texts(name: str) -> set[str]:
    """All texts that pages give to the file of that name."""
    return {
        text for each in contents.NAMES for language in ("lisp", "hy") for file, text in _files(page_of(each), language) if file == name
    }


def provide(name: str, text: str, over: bool = False) -> str:
    """Make ``text`` the file ``name`` in the current folder. Returns what happened: "written", "there", or "other".

    A file that is there with another text stays as it is ("other"), unless that text is of the course, or ``over``. Then what was there
    becomes NAME.old. Errors: `OSError`.
    """
    path = Path(name)
    try:
        present = path.read_text(encoding="utf-8", errors="replace")
    except FileNotFoundError:
        present = None
    if present == text:
        return "there"
    if present is not None and present not in known_texts(name):
        if not over:
            return "other"
        storage.write_whole(path.with_name(path.name + ".old"), present, durable=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    storage.write_whole(path, text, durable=False)
    return "written"
