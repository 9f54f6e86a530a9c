"""The command line: ``cramhy repl | run | eval | test | turtlesim | teleop | view | ros-shims`` and ``roslisp_repl``."""

from __future__ import annotations

import argparse
import sys


def _session_options():
    options = argparse.ArgumentParser(add_help=False)
    options.add_argument("--time", choices=["virtual", "wall"], default=None, help="virtual: as fast as the machine computes; or wall time")
    options.add_argument("--seed", type=int, default=None, help="shuffle the order of tasks, reproducibly")
    options.add_argument("--backend", choices=["threads", "greenlet"], default="threads", help="how tasks get their stacks")
    options.add_argument("--time-limit", type=float, default=None, metavar="SECONDS", help="end a form after so much plan time")
    options.add_argument("--load", action="append", default=[], metavar="SYSTEM", help="a system or file to load first")
    options.add_argument("--package", default=None, metavar="PACKAGE", help="the package to begin in")
    options.add_argument("--no-turtlesim", action="store_true", help="do not start the simulator with the first node")
    options.add_argument("--backtrace", choices=["none", "lisp", "python"], default="none", help="show the calls that led to an error")
    options.add_argument("--eval", action="append", default=[], dest="forms", metavar="FORM", help="a form to evaluate after loading")
    return options


def parser():
    common = _session_options()
    main_parser = argparse.ArgumentParser(prog="cramhy", description="CRAM's robot plan language on Hy and Python.")
    commands = main_parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    repl = commands.add_parser("repl", parents=[common], help="the REPL (also called roslisp_repl)")
    repl.add_argument("--commands", action="store_true", help="serve rosservice, rostopic ... from this user's other terminals")
    repl.add_argument("--view", action="store_true", help="show the turtle's paper in a page")
    run = commands.add_parser("run", parents=[common], help="load a .lisp, .hy or .asd file and run it")
    run.add_argument("file")
    commands.add_parser("eval", parents=[common], help="evaluate forms given as JSON lines")
    test = commands.add_parser("test", parents=[common], help="run the lisp-unit and FiveAM tests of a system, file or folder")
    test.add_argument("path", help="a system by its name, an .asd, .lisp or .hy file, or a folder")
    test.add_argument("--limit", type=float, default=60.0, metavar="SECONDS", help="end a test that takes longer (60)")
    for name, text in (("turtlesim", "the simulator alone"), ("teleop", "drive with the arrow keys"), ("view", "the live page")):
        commands.add_parser(name, parents=[common], help=text)
    shims = commands.add_parser("ros-shims", help="roscore, rosrun, catkin_make ... as shell functions, or installed in a folder")
    shims.add_argument("--install", metavar="FOLDER", help="write them as programs into FOLDER instead of printing functions")
    ros = commands.add_parser("ros", help=argparse.SUPPRESS)
    ros.add_argument("tool")
    ros.add_argument("arguments", nargs=argparse.REMAINDER)
    return main_parser


def session(options, default_time="wall"):
    """The `Session` that the options describe, with systems loaded and the package set."""
    from cramhy_runtime.repl import backtrace
    from cramhy_runtime.repl.session import Session

    backtrace.show(options.backtrace)
    made = Session(time=options.time or default_time, seed=options.seed, backend=options.backend, time_limit=options.time_limit,
                   turtlesim=not options.no_turtlesim)
    for system in options.load:
        made.load(system)
    if options.package:
        made.package = options.package.upper()
    if options.command != "run":
        evaluate_forms(made, options.forms)
    return made


def evaluate_forms(made, forms):
    for form in forms:
        made.evaluate_text(form, "<--eval>")


def main(arguments=None):
    """Run the command; the exit status."""
    options = parser().parse_args(arguments)
    try:
        return globals()[f"_{options.command.replace('-', '_')}"](options) or 0
    except BrokenPipeError:
        sys.stderr.close()
        return 1
    except KeyboardInterrupt:
        return 130


def roslisp_repl():
    """The console script of that name: ``cramhy repl``."""
    sys.exit(main(["repl", *sys.argv[1:]]))


def _repl(options):
    from cramhy_runtime.repl.console import Console

    if options.view:
        return _view(options)
    return Console(lambda: session(options), commands=options.commands and options.time != "virtual").run()


def _eval(options):
    from cramhy_runtime.lisp.streams import streams
    from cramhy_runtime.lisp.conditions import Condition
    from cramhy_runtime.repl import json_lines
    from cramhy_runtime.repl.console import report
    from cramhy_runtime.repl.session import condition_of, handle_interrupts

    streams.STANDARD_OUTPUT.value = streams.CONSOLE_ERROR  # standard output is for the answers
    try:
        made = session(options, default_time="virtual")
    except (Exception, Condition) as problem:
        report(condition_of(problem))
        return 1
    handle_interrupts()
    json_lines.serve(made)


def _run(options):
    from cramhy_runtime.repl.console import report
    from cramhy_runtime.repl.session import Interruption, condition_of, handle_interrupts
    from cramhy_runtime.lisp.conditions import Condition

    handle_interrupts()
    try:
        made = session(options)
        made.load(options.file)
        if options.package:
            made.package = options.package.upper()
        evaluate_forms(made, options.forms)
    except Interruption:
        return 130
    except (Exception, Condition) as problem:
        report(condition_of(problem))
        return 1


def _not_here(what):
    print(f"cramhy: {what}", file=sys.stderr)
    return 2


def _test(options):
    """Run the tests of a system, an ``.asd``, ``.lisp`` or ``.hy`` file, or of all test files below a folder."""
    from cramhy_runtime.lisp.systems import unit_tests
    from cramhy_runtime.lisp.conditions import Condition
    from cramhy_runtime.repl.console import report
    from cramhy_runtime.repl.session import Interruption, condition_of, handle_interrupts

    handle_interrupts()
    unit_tests.limit = options.limit
    try:
        made = session(options, default_time="virtual")
        return 0 if made.test(options.path) else 1
    except Interruption:
        return 130
    except (Exception, Condition) as problem:
        report(condition_of(problem))
        return 1


def _turtlesim(options):
    return _not_here("the simulator runs inside the REPL: it starts with (start-ros-node \"name\").")


def _teleop(options):
    return _not_here("press the turtle's keys inside the REPL: (turtlesim:press :up), also :down :left :right.")


def _view(options):
    return _not_here("the live page is not part of this version; (turtlesim:save-paper \"turtle.png\") writes the paper.")


def _ros_shims(options):
    from cramhy_runtime.repl import shims

    return shims.run(options.install)


def _ros(options):
    from cramhy_runtime.repl import shims

    return shims.tool(options.tool, options.arguments)


if __name__ == "__main__":
    sys.exit(main())
