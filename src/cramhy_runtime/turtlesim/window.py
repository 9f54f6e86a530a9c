"""The window of turtlesim: a page in a browser, which opens when somebody wants to see the turtles.

The original opens its window when ``turtlesim_node`` starts. Here a page shows the turtles, and the plan that drives them. The room that
makes it stands far above this one, so whoever begins a session says how its page is opened (`offer`). From then on it opens at any time,
without a restart: ``(turtlesim:view)`` at the prompt and ``turtlesim.view()`` in Python call `view`; other terminals ask for it by the
service ``/cramhy/open_page`` (``ros_tools/hosting.py``).
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import Cell
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from .signatures import Opener, Page

_opener: Cell[Opener | None] = Cell(None)


class NoPage(Exception):
    """The page cannot be opened; the text says why and what to do."""


def offer(opener: Opener) -> None:
    """Have ``opener(show, asked)`` open the page from now on. It returns the `signatures.Page`, the same one each time, or raises `NoPage`.

    show: whether to open a browser, too, if a person sits at this terminal and has a screen. asked: whether the user has asked for the
    page. Then virtual time passes as the wall's, so that there is something to see. A page that opens by itself leaves time as it is.
    """
    _opener.value = opener


def offered() -> bool:
    """Whether somebody has said how the page is opened."""
    return _opener.value is not None


def page(show: bool, asked: bool) -> Page:
    """The page of the active session, which opens now if it is not open. show, asked: as for `offer`. Raises `NoPage`."""
    if _opener.value is None:
        raise NoPage(
            "The program that runs this session offers no page. cramhy repl, cramhy run and import cramhy do. A program in Python "
            "opens the page itself: from cramhy_runtime import view; print(view.start().url)"
        )
    return _opener.value(show, asked)


def view() -> str:
    """Show the turtles' world and the plan in a page; its address. On a desktop the page opens in a browser. Raises `NoPage`."""
    return page(show=True, asked=True).url
