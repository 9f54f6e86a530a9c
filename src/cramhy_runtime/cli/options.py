"""The words of the command line: which commands there are, and which options each of them takes.

``repl``, ``run``, ``eval`` and ``test`` describe a session with the same options. What a session opens to the world
outside of it is off unless an option asks for it (law 9).
"""

from __future__ import annotations

import argparse
import functools
import os
import sys


def _seconds(text):
    number = float(text)
    if not number >= 0:
        raise ValueError
    return number


_seconds.__name__ = "number of seconds"  # what argparse calls it in its complaint


def _features(text):
    names = [name.strip().lstrip(":").upper() for name in text.split(",")]
    if not all(names) or any(character in name for name in names for character in " ()'\";|"):
        raise ValueError
    return names


_features.__name__ = "list of features"  # what argparse calls it in its complaint


class _Parser(argparse.ArgumentParser):
    """A parser that asks once how wide the terminal is. `argparse` would ask for each option, by a module that takes 5 ms to import."""

    def __init__(self, **options):
        super().__init__(**{"formatter_class": functools.partial(argparse.HelpFormatter, width=_columns() - 2), **options})


@functools.cache
def _columns():
    """The width of the terminal, as `shutil.get_terminal_size` tells it."""
    try:
        columns = int(os.environ["COLUMNS"])
    except (KeyError, ValueError):
        columns = 0
    try:
        return columns if columns > 0 else os.get_terminal_size(sys.__stdout__.fileno()).columns or 80
    except (AttributeError, ValueError, OSError):
        return 80


DEFAULT_TIMES = {
    "repl": "wall",
    "learn": "virtual",
    "swank": "wall",
    "jupyter": "virtual",
    "run": "virtual",
    "eval": "virtual",
    "test": "virtual",
}
"""The commands with a session, and the time in which it lives when nothing else is said (see ``session/time_setting.py``)."""


def _add_time(options, default):
    """``--time``, which is the same for all commands that have a time."""
    options.add_argument(
        "--time",
        choices=["virtual", "wall"],
        default=None,
        help=f"virtual: as fast as the machine computes; or wall. It counts before the variable CRAMHY_TIME ({default})",
    )


def _session_options(command):
    options = _Parser(add_help=False)
    _add_time(options, DEFAULT_TIMES[command])
    options.add_argument("--seed", type=int, default=None, help="shuffle the order of tasks, reproducibly (first come, first served)")
    auto = "as threads, since Jupyter's loop has the main thread" if command == "jupyter" else "as greenlets where they are installed"
    options.add_argument(
        "--backend",
        choices=["auto", "threads"] if command == "jupyter" else ["auto", "threads", "greenlet"],
        default="auto",
        help=f"how tasks get their stacks; auto: {auto} (auto)",
    )
    options.add_argument("--time-limit", type=float, default=None, metavar="SECONDS", help="end a form after so much plan time (no limit)")
    options.add_argument(
        "--cleanup-limit",
        type=_seconds,
        default=5.0,
        metavar="SECONDS",
        help="what plans get for their cleanup when the process is asked to end (5)",
    )
    options.add_argument(
        "--load", action="append", default=[], metavar="SYSTEM", help="a system or file to load first; may be repeated (none)"
    )
    options.add_argument(
        "--features",
        action="append",
        default=[],
        type=_features,
        metavar="NAMES",
        help="features for #+ and #-, with commas between: sbcl lets a program take its code for SBCL; may be repeated (none)",
    )
    options.add_argument(
        "--prefer-path",
        action="append",
        default=[],
        metavar="SYSTEM",
        help="take this system from ROS_PACKAGE_PATH though cramhy contains one of that name; may be repeated (cramhy's own)",
    )
    options.add_argument("--package", default=None, metavar="PACKAGE", help="the package to begin in (CL-USER)")
    options.add_argument("--no-turtlesim", action="store_true", help="leave the simulator out (it starts with the first node)")
    options.add_argument(
        "--backtrace",
        choices=["none", "lisp", "python"],
        default=None,
        help="show the calls that led to an error. It counts before the variable CRAMHY_BACKTRACE (none)",
    )
    options.add_argument("--verbose", action="store_true", help="say which file is compiled anew each time, and why (nothing)")
    options.add_argument(
        "--eval", action="append", default=[], dest="forms", metavar="FORM", help="a form to evaluate after loading; may be repeated (none)"
    )
    return options


def _port(text):
    number = int(text)
    if not 0 <= number <= 65535:
        raise ValueError
    return number


_port.__name__ = "port"  # what argparse calls it in its complaint


def _add_view(options, what, default, by_itself=None):
    """``--view``, which shows ``what``, and ``--no-view`` where a page opens by itself: when ``by_itself`` says."""
    options.add_argument("--view", action="store_true", default=None, help=f"show {what} in a page ({by_itself or default})")
    if by_itself:
        options.add_argument(
            "--no-view",
            dest="view",
            action="store_false",
            default=None,
            help="open no page by itself. The variable CRAMHY_VIEW=no says the same (it opens)",
        )


def _opening_options(by_itself=None):
    """What lets others see the session, or the session see others. by_itself: when its page opens in a browser though nobody asked."""
    options = _Parser(add_help=False)
    options.add_argument(
        "--serve", action="store_true", help="let rostopic, rosservice ... and other programs of this user connect (nobody)"
    )
    _add_view(options, "the turtle's world and the plan", "no page", by_itself)
    options.add_argument("--port", type=_port, default=None, metavar="N", help="where --serve and --view listen (a free port)")
    options.add_argument(
        "--origin",
        action="append",
        default=[],
        metavar="URL",
        help="a page of another server that may connect, such as https://app.foxglove.dev; may be repeated (none)",
    )
    options.add_argument(
        "--record", default=None, metavar="FILE.mcap", help="write all messages and events of the plan into a file (no file)"
    )
    options.add_argument(
        "--ros",
        default=None,
        metavar="ws://HOST:PORT",
        help="join a real ROS through its rosbridge server; @FILE: its address stands in FILE (the variable CRAMHY_ROS, or none)",
    )
    options.add_argument(
        "--ros-token",
        default=None,
        metavar="FILE",
        help="the file with the token that this server wants (the variable CRAMHY_ROS_TOKEN, which holds the token itself, or none)",
    )
    return options


def _session(commands, name, help, openings=None):
    """Add a command with a session; ``openings``: what it can open, as from `_opening_options`."""
    return commands.add_parser(name, parents=[_session_options(name), *([openings] if openings else [])], help=help)


def _add_repl(commands):
    repl = _session(commands, "repl", "the REPL (also called roslisp_repl)", _opening_options("on a desktop it opens with the turtle"))
    repl.add_argument(
        "--hy",
        action="store_true",
        help="begin in plain Hy, after (require cramhy *), where (in-package ...) leads to Lisp (begin in Lisp)",
    )
    repl.add_argument("--quiet", action="store_true", help="begin without a banner (two lines, where somebody sits at a terminal)")
    repl.add_argument(
        "--swank",
        nargs="?",
        type=_port,
        const=0,
        default=None,
        metavar="PORT",
        help="let Emacs connect, too: M-x slime-connect. Without PORT at a free one (nobody)",
    )


def _add_swank(commands):
    swank = _session(commands, "swank", "a session for Emacs: M-x slime-connect")
    swank.add_argument("--port", type=_port, default=None, metavar="N", help="where it listens on loopback (4005)")
    swank.add_argument("--socket", default=None, metavar="FILE", help="listen at this Unix socket instead (at a port)")
    swank.add_argument("--port-file", default=None, metavar="FILE", help="write the port into FILE when it listens (no file)")


def _add_jupyter(commands):
    """``cramhy jupyter``, whose options of a session are those of its kernel."""
    jupyter = _session(commands, "jupyter", "the kernel for notebooks: install it, remove it, run it")
    jupyter.add_argument(
        "action", choices=["install", "uninstall", "kernel"], help="install: tell Jupyter of it; kernel: run it, as Jupyter does"
    )
    place = jupyter.add_mutually_exclusive_group()
    place.add_argument("--user", action="store_true", help="for this user (for the environment of this Python)")
    place.add_argument("--prefix", default=None, metavar="FOLDER", help="for the environment in FOLDER (that of this Python)")
    place.add_argument("--sys-prefix", action="store_true", help="for the environment of this Python (which is what happens anyway)")
    jupyter.add_argument(
        "-f", "--connection-file", default=None, metavar="FILE", help="of kernel: where Jupyter says how to connect (Jupyter gives it)"
    )


def _add_learn(commands):
    learn = _session(commands, "learn", "the course, step by step at the prompt", _opening_options("on a desktop it opens with the turtle"))
    learn.add_argument("page", nargs="?", default=None, metavar="PAGE", help="a page by its number or name (the one that was left last)")
    learn.add_argument(
        "--language",
        choices=["lisp", "hy"],
        default=None,
        help="the language to learn in: Common Lisp, or plain Hy (that of the last time; first lisp)",
    )
    learn.add_argument("--folder", default=None, metavar="FOLDER", help="where the files of the lectures go (cramhy-course)")


def _add_grade(commands):
    grade = commands.add_parser("grade", help="grade a submission: run it in a sandbox, and tell what failed and how many points it gets")
    grade.add_argument("exercise", metavar="EXERCISE", help="the folder of an exercise, or the name of one of cramhy's, such as square")
    grade.add_argument("submission", metavar="SUBMISSION", help="the file that a student hands in, or the folder with the files")
    grade.add_argument("--seeds", type=_at_least_one, default=None, metavar="N", help="try checks with N seeds (as the exercise says)")
    grade.add_argument(
        "--sandbox",
        choices=["bubblewrap", "locks"],
        default=None,
        help="what keeps the submission from this machine: bubblewrap, and nothing is graded where that does not work, or cramhy's own "
        "locks alone (bubblewrap where it works)",
    )
    grade.add_argument("--as-root", action="store_true", help="grade although you are root (that is refused)")
    grade.add_argument("--json", default=None, metavar="FILE", help="write the result into FILE, too, as JSON (no file)")
    grade.add_argument("--junit", default=None, metavar="FILE", help="write the result into FILE, too, in JUnit's XML (no file)")
    grade.add_argument(
        "--format",
        choices=["text", "json", "github", "vpl", "coderunner"],
        default="text",
        help="what is printed: text for people, or what GitHub Classroom, Moodle's VPL or Moodle's CodeRunner reads (text)",
    )


def _add_similar(commands):
    similar = commands.add_parser("similar", help="list pairs of submissions that are alike after renaming and reordering")
    similar.add_argument("folder", metavar="FOLDER", help="a folder with a file or a folder for each submission")
    similar.add_argument("--given", default=None, metavar="FOLDER", help="what all students were given, which does not count (nothing)")
    similar.add_argument(
        "--least", type=_percent, default=40, metavar="PERCENT", help="leave out pairs that have less in common than this (40)"
    )
    similar.add_argument("--json", default=None, metavar="FILE", help="write the pairs into FILE, too, as JSON (no file)")


def _at_least_one(text):
    number = int(text)
    if not 1 <= number <= 1000:
        raise ValueError
    return number


_at_least_one.__name__ = "number from 1 to 1000"  # what argparse calls it in its complaint


def _percent(text):
    number = float(text)
    if not 0 <= number <= 100:
        raise ValueError
    return number


_percent.__name__ = "percentage"


def _add_lsp(commands):
    commands.add_parser("lsp", help="a language server for editors, at standard input and output")


def _add_run(commands):
    run = _session(commands, "run", "load a .lisp, .hy or .asd file and run it", _opening_options())
    run.add_argument("file", help="a .lisp, .hy or .asd file")
    run.add_argument(
        "--picture",
        default=None,
        metavar="FILE",
        help="write the turtle's paper at the end: .png or .svg; .gif or .replay.svg: the whole way (no file)",
    )


def _add_eval(commands):
    _session(commands, "eval", "evaluate forms given as JSON lines", _opening_options())


def _add_test(commands):
    test = _session(commands, "test", "run the lisp-unit and FiveAM tests of a system, file or folder")
    test.add_argument("path", help="a system by its name, an .asd, .lisp or .hy file, or a folder")
    test.add_argument("--only", action="append", default=None, metavar="TEST", help="a test by its name; may be repeated (all)")
    test.add_argument("--limit", type=float, default=60.0, metavar="SECONDS", help="end a test that takes longer (60)")
    test.add_argument("--junit", default=None, metavar="FILE", help="write the results into FILE, too, in JUnit's XML (no file)")


def _add_turtlesim(commands):
    simulator = commands.add_parser("turtlesim", help="the simulator alone, for other programs to drive")
    _add_view(simulator, "it", "no page", "on a desktop it opens with the turtle")
    simulator.add_argument("--port", type=_port, default=None, metavar="N", help="where it listens (a free port)")
    _add_time(simulator, "wall")


def _add_teleop(commands):
    teleop = commands.add_parser("teleop", help="drive the turtle of a running session with the arrow keys")
    teleop.add_argument("turtle", nargs="?", default="turtle1", help="which one (turtle1)")


def _add_page(commands):
    view = commands.add_parser("view", help="open the live page of a running session, or of a simulator of its own")
    view.add_argument("--port", type=_port, default=None, metavar="N", help="where a simulator of its own listens (a free port)")
    _add_time(view, "wall")


def _add_replay(commands):
    replay = commands.add_parser("replay", help="show a recording in the page")
    replay.add_argument("file", metavar="FILE.mcap", help="the recording, which --record has written")
    replay.add_argument("--port", type=_port, default=None, metavar="N", help="where it listens (a free port)")


def _add_browser(commands):
    browser = commands.add_parser("browser", help="write the course as static files, which run in a browser's tab, and show them")
    browser.add_argument("--out", metavar="FOLDER", help="write them there: an empty folder, or that of an older site (none)")
    browser.add_argument("--serve", metavar="FOLDER", help="show those of that folder in a browser, until Ctrl-C (none)")
    browser.add_argument("--port", type=_port, default=None, metavar="N", help="where --serve listens on this machine (a free port)")
    browser.add_argument(
        "--pyodide",
        default=None,
        metavar="FOLDER",
        help="the package pyodide of npm, unpacked (in a clone: the one that make pyodide has fetched)",
    )


def _add_shims(commands):
    shims = commands.add_parser("ros-shims", help="roscore, rosrun, catkin_make ... as shell functions, or installed in a folder")
    shims.add_argument("--install", metavar="FOLDER", help="write them as programs into FOLDER (print functions)")
    shims.add_argument(
        "--shell",
        choices=["sh", "fish", "powershell"],
        default=None,
        help="whose functions; sh is for bash, zsh and dash, too (sh; on Windows powershell)",
    )


def _add_ros(commands):
    ros = commands.add_parser("ros", usage="cramhy ros COMMAND [WORD ...]", help="a command of ROS: cramhy ros rostopic list")
    ros.add_argument(
        "ros_command",
        metavar="COMMAND",
        help="rostopic, rosservice, roscore, rosrun, catkin_make ..., with the words of ROS. rosrun turtlesim turtlesim_node opens the "
        "page on a desktop, unless the variable CRAMHY_VIEW says no",
    )


_COMMANDS = {
    "repl": _add_repl,
    "learn": _add_learn,
    "swank": _add_swank,
    "jupyter": _add_jupyter,
    "lsp": _add_lsp,
    "run": _add_run,
    "eval": _add_eval,
    "test": _add_test,
    "grade": _add_grade,
    "similar": _add_similar,
    "turtlesim": _add_turtlesim,
    "teleop": _add_teleop,
    "view": _add_page,
    "replay": _add_replay,
    "browser": _add_browser,
    "ros-shims": _add_shims,
    "ros": _add_ros,
}


class _Version(argparse.Action):
    """``--version`` prints the versions of cramhy, Python and Hy, which a report of a defect needs."""

    def __init__(self, option_strings, dest):
        super().__init__(option_strings, dest=argparse.SUPPRESS, nargs=0, help="print the versions of cramhy, Python and Hy, and end")

    def __call__(self, parser, namespace, values, option_string=None):
        import platform
        from importlib import metadata

        from cramhy_runtime import __version__

        print(f"cramhy {__version__} (Python {platform.python_version()}, Hy {metadata.version('hy')}, {platform.platform()})")
        parser.exit()


def parser(words=()):
    """The `argparse.ArgumentParser` of ``cramhy``. words: what it will parse; if they begin with a command, it knows no other one.

    A prompt is there 10 ms sooner without the options of the other commands.
    """
    main_parser = _Parser(prog="cramhy", description="CRAM's robot plan language on Hy and Python.")
    main_parser.add_argument("--version", action=_Version)
    commands = main_parser.add_subparsers(dest="command", metavar="COMMAND", required=True, prog="cramhy")
    named = [name for name in words[:1] if name in _COMMANDS]
    for name in named or _COMMANDS:
        _COMMANDS[name](commands)
    return main_parser
