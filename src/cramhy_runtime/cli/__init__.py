"""The command line: ``cramhy repl | learn | swank | jupyter | lsp | run | eval | test | grade | similar | turtlesim | teleop | view |
replay | browser | ros-shims | ros``, ``roslisp_repl``.

`options` says which words there are, `servers` what a session opens to the outside, `standalone_commands` has the commands that are no
session of Lisp's, `start_modules` the bytecode of the modules that a session starts with, `shims` the ROS commands, which `workspace`,
`programs`, `launch`, `keyboard` and the room ``ros_tools`` carry out.
Each command imports what it needs when it runs, so that the quick ones are quick.
"""

from __future__ import annotations

import gc
import os
import sys
from contextlib import ExitStack, contextmanager

from . import start_modules
from .process_environment import check_for_session, ends_if_missing, in_any_surroundings

INTERACTIVE = ("repl", "learn", "swank", "jupyter", "eval")
"""The commands whose users may interrupt a form."""


@ends_if_missing
def session(options, closings, opened=True):
    """The `Session` that the options describe, opened to the outside as they say, with systems loaded and the package set.

    closings: an `ExitStack` that ends the session: first its plans, through their cleanup, then what was opened. opened: whether the
    options can open anything. What cannot be opened is told and ends the process, as a wrong option does.
    """
    from cramhy_runtime import kernel
    from cramhy_runtime.languages.commonlisp.tools import backtrace
    from cramhy_runtime.repl.session import Session
    from cramhy_runtime.session import time_setting
    from cramhy_runtime.session.boot import when_booted
    from cramhy_runtime.session.session import packages_above
    from cramhy_runtime.storage import kept_code
    from .options import DEFAULT_TIMES

    if options.command in INTERACTIVE:
        from cramhy_runtime.kernel import patient_calls

        patient_calls.install()
    packages_above["COURSE"] = _define_course
    backtrace.show(options.backtrace)
    if options.verbose:
        kept_code.show_refusals(lambda sentence: print(f"; {sentence}", file=sys.stderr, flush=True))
    check_for_session(options.backend)
    made = Session(
        time=time_setting.decide(options.time, DEFAULT_TIMES[options.command], robot=bool(getattr(options, "ros", None))),
        seed=options.seed,
        backend="threads" if options.command == "jupyter" else options.backend,
        time_limit=options.time_limit,
        turtlesim=not (options.no_turtlesim or getattr(options, "ros", None)),
        cleanup_limit=options.cleanup_limit,
        whole=not (waits := _waits_at_prompt(options)),
    )
    gc.enable()
    start_modules.note(over=not waits)
    if waits:
        when_booted.extend((gc.freeze, start_modules.note))
    if options.features:
        from cramhy_runtime.languages.commonlisp.reader.dispatch_macros import add_features

        add_features([name for names in options.features for name in names])
    if opened:
        from . import live_page
        from .servers import NotPossible, open_session

        live_page.offer()
        try:
            open_session(options, closings)
        except NotPossible as problem:
            print(f"cramhy: {problem}", file=sys.stderr)
            sys.exit(2)
        if options.command in ("repl", "learn") and options.view is None:
            live_page.open_with_turtle()
    closings.callback(kernel.stop)
    for system in options.prefer_path:
        made.prefer(system)
    for system in options.load:
        made.load(system)
    if options.package:
        made.package = options.package.upper()
    if options.command in ("repl", "swank"):
        offer_swank(made, getattr(options, "swank", None))
    if options.command in ("repl", "learn"):
        evaluate_before_prompt(made, options.forms)
    elif options.command != "run":
        evaluate_forms(made, options.forms)
    return made


def _waits_at_prompt(options):
    """Whether nothing is evaluated, and nobody connects, before a first line is typed at the prompt of Lisp."""
    before = "hy load prefer_path package forms serve view record ros".split()
    return options.command == "repl" and options.swank is None and not any(getattr(options, name) for name in before)


def _define_course():
    from cramhy_runtime.course import package

    package.define()


def offer_swank(made, port):
    """Let SLIME find the packages that it calls. With a port, listen for Emacs there, too."""
    from cramhy_runtime.lisp_core.packages import on_demand
    from cramhy_runtime.languages.commonlisp.systems import program_files

    def define(*loader):
        from cramhy_runtime.swank import package

        package.stand_in(*loader)

    on_demand.update(dict.fromkeys(("SWANK-LOADER", "SWANK", "SLYNK-LOADER", "SLYNK"), define))
    program_files.stand_ins.update(dict.fromkeys(("swank-loader.lisp", "slynk-loader.lisp"), define))
    if port is not None:
        from . import swank_command

        swank_command.listen(made, port or None)


def evaluate_forms(made, forms):
    for form in forms:
        made.evaluate_text(form, "<--eval>")


def evaluate_before_prompt(made, forms):
    """As `evaluate_forms`; Ctrl-C ends these forms, and the prompt comes."""
    from cramhy_runtime.repl.listener import tell_interrupted
    from cramhy_runtime.repl.session import Interruption

    try:
        evaluate_forms(made, forms)
    except Interruption:
        tell_interrupted()


@in_any_surroundings
def main(arguments=None):
    """Run the command; the exit status. That of a process that a signal ended is 128 + the signal's number, as a shell says it."""
    from cramhy_runtime.kernel import signals

    with program():
        status = _main(sys.argv[1:] if arguments is None else arguments)
        return 128 + signals.received[0] if signals.received else status


@contextmanager
def program():
    """What stands around a program with a prompt or a session: signals end it in order, and the terminal is as it was afterwards."""
    from cramhy_runtime.kernel import signals, standard_input, terminals

    with signals.held(), terminals.terminal_of_a_session():
        standard_input.install()
        yield


def _main(arguments):
    from cramhy_runtime.kernel.errors import Abandoned, Terminated

    try:
        if arguments and arguments[0].startswith(("ros", "catkin")):
            from . import shims

            if arguments[0] == "ros" and len(arguments) > 1 and not arguments[1].startswith("-"):
                return shims.tool(arguments[1], arguments[2:])  # the words belong to the tool, whatever they look like
            if complaint := shims.meant(arguments):
                sys.stderr.write(complaint)
                return 2
        from .options import DEFAULT_TIMES, parser

        words = arguments or ["repl"]  # what Emacs types for a Lisp: its name alone
        options = parser(words).parse_args(words)
        if options.command in DEFAULT_TIMES:
            start_modules.install()
            gc.disable()  # looking for garbage takes a twelfth of the time that a session takes to start, and there is none
        if hasattr(options, "time") and (complaint := _wrong_variable()):
            print(f"cramhy: {complaint}", file=sys.stderr)
            return 2
        return globals()[f"_{options.command.replace('-', '_')}"](options) or 0
    except Terminated as ended:
        return ended.code
    except (KeyboardInterrupt, Abandoned):
        return 130
    finally:
        gc.enable()
        start_modules.keep()


def _wrong_variable():
    """What is wrong with the variable CRAMHY_TIME or CRAMHY_PASSES, or ``None``."""
    from cramhy_runtime.session import time_setting

    try:
        time_setting.decide()
        if os.environ.get("CRAMHY_PASSES"):
            from cramhy_runtime.languages.commonlisp.compiler.passes import from_environment

            from_environment()
    except ValueError as problem:
        return problem
    return None


def roslisp_repl():
    """The console script of that name: ``cramhy repl``."""
    sys.exit(main(["repl", *sys.argv[1:]]))


def _checked(options):
    """Whether all that the options ask for can be had; what cannot is told."""
    if not (
        options.serve
        or options.view
        or options.port
        or options.origin
        or os.environ.get("CRAMHY_ROS")
        or any(getattr(options, name, None) is not None for name in ("record", "ros", "ros_token", "picture"))
    ):
        return True
    from . import servers

    try:
        servers.check(options)
    except servers.NotPossible as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return False
    return True


def _repl(options):
    from cramhy_runtime.repl import banner
    from cramhy_runtime.repl.console import Console

    if not _checked(options):
        return 2
    greets = banner.wanted() and not options.quiet
    sys.path.append("")  # modules of the current folder are found, as at the prompts of Python and Hy, and hide none of others
    with ExitStack() as closings:
        if options.hy:
            from cramhy_runtime.repl import hy_prompt

            return hy_prompt.run(lambda: session(options, closings), banner.of_hy() if greets else "" if options.quiet else None)
        return Console(lambda: session(options, closings), banner=banner.of_lisp() if greets else "").run()


def _learn(options):
    from . import learn_command

    learn_command.tell_begin()
    return learn_command.learn(options) if _checked(options) else 2


def _swank(options):
    from . import swank_command

    with ExitStack() as closings:
        return status_of(lambda: swank_command.run(lambda: session(options, closings, opened=False), options))


def _jupyter(options):
    from . import jupyter_command, servers

    try:
        servers.require("jupyter", "cramhy jupyter")
    except servers.NotPossible as problem:
        print(problem, file=sys.stderr)
        return 2
    if options.action != "kernel":
        return jupyter_command.install(options)
    if options.connection_file is None:
        sys.stderr.write("cramhy: jupyter kernel is started by Jupyter, with -f FILE. To tell Jupyter of it: cramhy jupyter install\n")
        return 2
    from cramhy_runtime.jupyter import launching

    with ExitStack() as closings:
        return status_of(lambda: launching.run(session(options, closings, opened=False), options.connection_file))


def _lsp(options):
    from . import lsp_command

    return lsp_command.run()


def _browser(options):
    from . import browser_command

    return browser_command.run(options)


def _eval(options):
    from cramhy_runtime.languages.commonlisp.streams import streams
    from cramhy_runtime.lisp_core.conditions import Condition
    from cramhy_runtime.repl import answer_streams, json_lines
    from cramhy_runtime.repl.console import report
    from cramhy_runtime.repl.session import Interruption, condition_of

    if not _checked(options):
        return 2
    streams.STANDARD_OUTPUT.value = streams.CONSOLE_ERROR  # standard output is for the answers
    lines, out = sys.stdin, sys.stdout
    with answer_streams.turned_aside() as descriptors, ExitStack() as closings:
        try:
            made = session(options, closings)
        except Interruption:
            return 130
        except (Exception, Condition) as problem:
            report(condition_of(problem))
            return 1
        json_lines.serve(made, lines if descriptors is None else descriptors.requests, out, descriptors)


def _run(options):
    if not _checked(options):
        return 2
    from cramhy_runtime.languages.commonlisp.tools.error_reports import end_line

    with ExitStack() as closings:
        closings.callback(end_line)
        return status_of(lambda: _load(options, closings))


def _load(options, closings):
    from cramhy_runtime.repl.progress import Progress

    made = session(options, closings)
    if options.picture:
        from .servers import save_picture

        closings.callback(save_picture, options.picture)
    with Progress().during():
        made.load(options.file)
        if options.package:
            made.package = options.package.upper()
        evaluate_forms(made, options.forms)


def status_of(work):
    """The exit status that ``work()`` gives; 130 after Ctrl-C, 1 after an error, which is reported."""
    from cramhy_runtime.lisp_core.conditions import Condition
    from cramhy_runtime.repl.session import Interruption

    try:
        return work()
    except Interruption:
        return 130
    except (Exception, Condition) as problem:
        _tell(problem)
        return 1


def _tell(problem):
    """Tell of the error that ended a program, in whichever language it is written."""
    if "hy" in sys.modules:
        from cramhy_runtime.languages.hy import errors

        errors.tell(problem)
    else:  # no Hy program can have to do with it, so Hy need not be loaded
        from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_of, report

        report(condition_of(problem))


def _test(options):
    """Run the tests of a system, an ``.asd``, ``.lisp`` or ``.hy`` file, or of all test files below a folder."""
    from cramhy_runtime.languages.commonlisp.systems import unit_tests

    unit_tests.limit_tests(options.limit)
    with ExitStack() as closings:
        return status_of(lambda: 0 if session(options, closings, opened=False).test(options.path, options.junit, options.only) else 1)


def _grade(options):
    from . import grading_commands

    return grading_commands.grade(options)


def _similar(options):
    from . import grading_commands

    return grading_commands.similar(options)


def _turtlesim(options):
    from . import standalone_commands

    return standalone_commands.turtlesim(options.port, options.view, options.time)


def _teleop(options):
    from . import keyboard

    return keyboard.teleop([] if options.turtle == "turtle1" else [f"turtle1/cmd_vel:={options.turtle}/cmd_vel"])


def _view(options):
    from . import standalone_commands

    return standalone_commands.view(options.port, options.time)


def _replay(options):
    from . import standalone_commands

    return standalone_commands.replay(options.file, options.port)


def _ros_shims(options):
    from . import shims

    return shims.run(options.install, options.shell)
