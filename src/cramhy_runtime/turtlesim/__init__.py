"""turtlesim in the process: the simulator of the course, tick by tick as the C++ one computes it.

==================  ========================================================================================
``world``           a turtle: kinematics, walls, teleports, pen
``dimensions``        how large the paper and the metre are
``canvas, strokes`` the paper in pixels, with the lines and the colour sensor; the same lines as vectors
``node``            the simulator: topics, services, parameters, ticks, observers
``roscpp``          what all executables have in common: command line, log, loggers
``teleop``          the arrow keys
``draw_square``     the demonstration that drives squares
``mimic``           the turtle that does what another one does
``executables``     all of these by the names that ``rosrun`` and ``roslaunch`` know
``drawing``         fourteen turtles as vector paths
``sprites``         the same in pixels
``stills, replay``  pictures of the window, as it is and as it came about; ``history`` is what a replay shows
``pictures``        which kind of picture a file gets
``window``          the page that shows the turtles, as the original's window does
==================  ========================================================================================

Importing this package imports none of them.
"""


def view() -> str:
    """Show the turtles' world and the plan in a page; its address. Any session can do so at any time. On a desktop the page opens in a
    browser.

    Errors: `window.NoPage`, when the extra ``web`` is not installed, no server can start, or the program that runs offers no page.
    """
    from .window import view

    return view()
