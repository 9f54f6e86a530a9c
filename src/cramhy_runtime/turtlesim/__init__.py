"""turtlesim in the process: the simulator of the course. It computes each tick as the C++ program does.

==================  ========================================================================================
``world``           a turtle: kinematics, walls, teleports, pen
``dimensions``        the size of the paper and of the metre
``canvas, strokes`` the paper in pixels, with the lines and the colour sensor; the same lines as vectors
``node``            the simulator: topics, services, parameters, ticks, observers
``teleop``          the arrow keys
``draw_square``     the demonstration: a turtle drives squares
``mimic``           a turtle copies the moves of another one
``executables``     all of these by their names in ``rosrun`` and ``roslaunch``
``drawing``         fourteen turtles as vector paths
``sprites``         the same in pixels
``stills, replay``  pictures of the window: still, or moving; ``history`` keeps the events for a replay
``pictures``        the kinds of pictures, by the ending of the file
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
