"""The words of the command line: which commands there are, and which options each of them takes.

``repl``, ``run``, ``eval`` and ``test`` describe a session with the same options (design.md 4). What a session opens to the world
outside of it is off unless an option asks for it (law 9).
"""

from __future__ import annotations

import argparse


def _seconds(text):
    number = float(text)
    if not number >= 0:
        raise ValueError
    return number


_seconds.__name__ = "number of seconds"  # what argparse calls it in its complaint


def _session_options():
    options = argparse.ArgumentParser(add_help=False)
    options.add_argument("--time", choices=["virtual", "wall"], default=None, help="virtual: as fast as the machine computes; or wall time")
    options.add_argument("--seed", type=int, default=None, help="shuffle the order of tasks, reproducibly")
    options.add_argument("--backend", choices=["threads", "greenlet"], default="threads", help="how tasks get their stacks")
    options.add_argument("--time-limit", type=float, default=None, metavar="SECONDS", help="end a form after so much plan time")
    options.add_argument("--cleanup-limit", type=_seconds, default=5.0, metavar="SECONDS",
                         help="what plans get for their cleanup when the process is asked to end (5)")
    options.add_argument("--load", action="append", default=[], metavar="SYSTEM", help="a system or file to load first")
    options.add_argument("--package", default=None, metavar="PACKAGE", help="the package to begin in")
    options.add_argument("--no-turtlesim", action="store_true", help="do not start the simulator with the first node")
    options.add_argument("--backtrace", choices=["none", "lisp", "python"], default="none", help="show the calls that led to an error")
    options.add_argument("--eval", action="append", default=[], dest="forms", metavar="FORM", help="a form to evaluate after loading")
    return options


def _port(text):
    number = int(text)
    if not 0 <= number <= 65535:
        raise ValueError
    return number


_port.__name__ = "port"  # what argparse calls it in its complaint


def _opening_options():
    """What lets others see the session, or the session see others."""
    options = argparse.ArgumentParser(add_help=False)
    options.add_argument("--serve", action="store_true", help="let rostopic, rosservice ... and other programs of this user connect")
    options.add_argument("--view", action="store_true", help="show the turtle's world and the plan in a page")
    options.add_argument("--port", type=_port, default=None, metavar="N", help="where --serve and --view listen (a free port)")
    options.add_argument("--origin", action="append", default=[], metavar="URL",
                         help="a page of another server that may connect, such as https://app.foxglove.dev")
    options.add_argument("--record", default=None, metavar="FILE.mcap", help="write all messages and events of the plan into a file")
    options.add_argument("--ros", default=None, metavar="ws://HOST:PORT",
                         help="join a real ROS through its rosbridge server; @FILE: its address stands in FILE (the variable CRAMHY_ROS)")
    options.add_argument("--ros-token", default=None, metavar="FILE",
                         help="the file with the token that this server wants (the variable CRAMHY_ROS_TOKEN holds the token itself)")
    return options


def parser():
    """The `argparse.ArgumentParser` of ``cramhy``."""
    common, openings = _session_options(), _opening_options()
    main_parser = argparse.ArgumentParser(prog="cramhy", description="CRAM's robot plan language on Hy and Python.")
    commands = main_parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    commands.add_parser("repl", parents=[common, openings], help="the REPL (also called roslisp_repl)")
    run = commands.add_parser("run", parents=[common, openings], help="load a .lisp, .hy or .asd file and run it")
    run.add_argument("file")
    run.add_argument("--picture", default=None, metavar="FILE",
                     help="write the turtle's paper at the end: .png or .svg; .gif or .replay.svg: the whole way")
    commands.add_parser("eval", parents=[common, openings], help="evaluate forms given as JSON lines")
    test = commands.add_parser("test", parents=[common], help="run the lisp-unit and FiveAM tests of a system, file or folder")
    test.add_argument("path", help="a system by its name, an .asd, .lisp or .hy file, or a folder")
    test.add_argument("--limit", type=float, default=60.0, metavar="SECONDS", help="end a test that takes longer (60)")
    simulator = commands.add_parser("turtlesim", help="the simulator alone, for other programs to drive")
    simulator.add_argument("--view", action="store_true", help="show it in a page, too")
    simulator.add_argument("--port", type=_port, default=None, metavar="N", help="where it listens (a free port)")
    teleop = commands.add_parser("teleop", help="drive the turtle of a running session with the arrow keys")
    teleop.add_argument("turtle", nargs="?", default="turtle1", help="which one (turtle1)")
    view = commands.add_parser("view", help="the live page of a running session, or of a simulator of its own")
    view.add_argument("--port", type=_port, default=None, metavar="N", help="where it listens (a free port)")
    replay = commands.add_parser("replay", help="show a recording in the page")
    replay.add_argument("file", metavar="FILE.mcap")
    replay.add_argument("--port", type=_port, default=None, metavar="N", help="where it listens (a free port)")
    shims = commands.add_parser("ros-shims", help="roscore, rosrun, catkin_make ... as shell functions, or installed in a folder")
    shims.add_argument("--install", metavar="FOLDER", help="write them as programs into FOLDER instead of printing functions")
    shims.add_argument("--shell", choices=["sh", "fish"], default="sh", help="whose functions: sh is for bash, zsh and dash, too")
    ros = commands.add_parser("ros", usage="cramhy ros COMMAND [WORD ...]", help="a command of ROS: cramhy ros rostopic list")
    ros.add_argument("ros_command", metavar="COMMAND", help="rostopic, rosservice, roscore, rosrun, catkin_make ..., with the words of ROS")
    return main_parser
