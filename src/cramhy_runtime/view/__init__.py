"""The live page: the turtles' world, the plan's tasks, fluents, process modules, time and log, in a browser.

The page is a client of the rosbridge server like any other (`cramhy_runtime.rosbridge`), so this room has no protocol of its own: it holds
the files of the page (``static/``: plain ES modules, one idea each, no build step, nothing from elsewhere), and starts the server with
them. The page can watch, drive the turtles, move objects of a robot's world, and set the pace of virtual time; it cannot evaluate code.

Where the parts are: `page` serves the files and opens the browser.
"""


def start(session=None, port=None, open_browser=True):
    """Show the active session in a page, at any time; the `page.Page`, with ``url`` and ``close()``. See `page.start`."""
    from . import page

    return page.start(session, port, open_browser)
