"""``--help`` of every command tells every default, and time is one setting for all of them."""

from __future__ import annotations

import argparse

import pytest

from cramhy_runtime import cli, kernel
from cramhy_runtime.session import Image
from cramhy_runtime.cli import options, programs


def commands():
    parser = options.parser()
    (found,) = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    return found.choices


OPTIONS = [
    (command, action)
    for command, parser in commands().items()
    for action in parser._actions
    if (action.option_strings or action.nargs == "?") and not isinstance(action, argparse._HelpAction)
]


@pytest.mark.soak(all_but=24)
@pytest.mark.parametrize(("command", "action"), OPTIONS, ids=lambda value: value if isinstance(value, str) else value.dest)
def test_help_tells_the_default(command, action):
    text, _, default = action.help.removesuffix(")").rpartition("(")
    assert action.help.endswith(")") and text.endswith(" ") and default
    if action.default not in (None, False, []):
        assert default.startswith(f"{action.default:g}" if isinstance(action.default, float) else str(action.default))


def test_help_tells_what_every_word_is():
    for command, parser in commands().items():
        assert all(action.help for action in parser._actions), command
        parser.format_help()


def test_every_command_that_has_a_time_takes_the_same_option():
    found = {command: parser.parse_args([*needed, "--time", "virtual"]).time for command, parser, needed in _with_time()}
    assert found == dict.fromkeys(["repl", "learn", "swank", "jupyter", "run", "eval", "test", "turtlesim", "view"], "virtual")


def _with_time():
    for command, parser in commands().items():
        if any("--time" in action.option_strings for action in parser._actions):
            yield command, parser, {"run": ["x"], "test": ["x"], "jupyter": ["kernel"]}.get(command, [])


@pytest.mark.parametrize("command", ["repl", "learn", "swank", "jupyter kernel", "run x", "eval", "test x", "turtlesim", "view"])
def test_a_wrong_time_in_the_environment_is_told(command, monkeypatch, capsys):
    monkeypatch.setenv("CRAMHY_TIME", "slow")
    assert cli.main(command.split()) == 2
    assert capsys.readouterr().err == 'cramhy: The variable CRAMHY_TIME says "slow". Time is "virtual" or "wall".\n'


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("option", "variable", "found"),
    [(None, None, (False, 1.0)), ("virtual", None, (True, 1.0)), (None, "virtual", (True, 1.0)), ("wall", "virtual", (False, 1.0))],
)
def test_the_simulator_alone_lives_in_that_time_too(private, monkeypatch, option, variable, found):
    """In virtual time it keeps the wall's pace, since it is there to be watched."""
    pytest.importorskip("uvicorn")
    if variable is not None:
        monkeypatch.setenv("CRAMHY_TIME", variable)
    seen = []
    monkeypatch.setattr(programs, "_wait", lambda nodes, *_: seen.append((kernel.active().clock.virtual, kernel.pace().speed)) or "ended")
    assert cli.main(["turtlesim", *(["--time", option] if option else [])]) == 0
    assert seen == [found]


def test_a_preferred_system_comes_from_the_path(tmp_path, monkeypatch, capsys):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "trivial-garbage.asd").write_text('(defsystem trivial-garbage :components ((:file "s")))')
    (tmp_path / "mine" / "s.lisp").write_text(
        "(defpackage trivial-garbage (:use :cl) (:export #:finalize))\n(defun trivial-garbage:finalize (x) (list :mine x))\n"
    )
    (tmp_path / "f.lisp").write_text("(print (trivial-garbage:finalize 1))\n")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    for words, shown, status in [
        (["--prefer-path", "trivial-garbage"], "(:MINE 1)", 0),
        ([], "invalid number of arguments", 1),
        (["--prefer-path", "trivial-garbadge"], 'There is no system "trivial-garbadge" on ROS_PACKAGE_PATH', 1),
    ]:
        with Image():
            assert cli.main(["run", *words, str(tmp_path / "f.lisp")]) == status
        out, err = capsys.readouterr()
        assert shown in out + err


@pytest.mark.parametrize("command", ["repl", "eval", "swank", "run", "test"])
def test_each_command_takes_greenlets_where_they_are_installed(command):
    words = [command, *{"run": ["f.lisp"], "test": ["f.lisp"]}.get(command, [])]
    assert options.parser(words).parse_args(words).backend == "auto"
    assert options.parser(words).parse_args([*words, "--backend", "greenlet"]).backend == "greenlet"


def test_a_kernel_for_notebooks_runs_its_plans_on_threads(capsys):
    words = ["jupyter", "kernel", "--backend", "greenlet"]
    with pytest.raises(SystemExit):
        options.parser(words).parse_args(words)
    assert "argument --backend: invalid choice: 'greenlet' (choose from" in capsys.readouterr().err


def test_a_parser_of_one_command_reads_it_as_the_parser_of_all_does():
    for words in (["repl", "--hy"], ["eval", "--eval", "1"], ["view", "--port", "8"], ["ros-shims", "--shell", "fish"], ["test", "a"]):
        assert vars(options.parser(words).parse_args(words)) == vars(options.parser().parse_args(words))
