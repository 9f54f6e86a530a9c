"""``make docs``: write ``docs/command-line.md``, all commands with their options, from the parser; with ``--print`` only show it."""

import argparse
import sys
from pathlib import Path

from cramhy_runtime.cli import options, shims

PAGE = Path(__file__).parents[2] / "docs" / "command-line.md"

BEGINNING = """# The command line

`make docs` writes this page from the parser of the command line, so it says what `cramhy COMMAND --help` says. A default stands in parentheses at
the end of a line. `roslisp_repl` is the same as `cramhy repl`. `cramhy --version` prints the version.

Four variables of the environment stand for options: `CRAMHY_TIME` for `--time`, `CRAMHY_BACKTRACE` for `--backtrace`, `CRAMHY_ROS` for
`--ros`, and `CRAMHY_VIEW=no` for `--no-view`. An option counts before its variable.
"""


def commands():
    """(name, what it does in a line, parser) of each command."""
    made = options.parser()
    (action,) = [action for action in made._actions if isinstance(action, argparse._SubParsersAction)]
    short = {choice.dest: choice.help for choice in action._choices_actions}
    return [(name, short[name], parser) for name, parser in action.choices.items()]


def called(action):
    """How an argument is written."""
    value = action.metavar or ("|".join(map(str, action.choices)) if action.choices else action.dest.upper())
    if not action.option_strings:
        return str(value)
    words = ", ".join(action.option_strings)
    return words if action.nargs == 0 else f"{words} {value}"


def text():
    """The page."""
    made = [BEGINNING]
    for name, short, parser in commands():
        made.append(f"\n## cramhy {name}\n\n{sentence(short)}\n".replace("\\\n", "\n"))
        actions = [action for action in parser._actions if action.dest != "help" and action.help is not argparse.SUPPRESS]
        if actions:
            made.append("| argument | meaning |\n|---|---|")
            made += [f"| `{cell(called(action))}` | {cell(action.help or 'the file to run')} |" for action in actions]
            made.append("")
    return "\n".join(made).replace("\n\n\n", "\n\n")


def sentence(words):
    """``words`` as a sentence; the name of a command keeps its small letter."""
    first = words.partition(",")[0]
    return f"`{first}`{words.removeprefix(first)}." if first in shims.TOOLS else words[0].upper() + words[1:] + "."


def cell(words):
    return words.replace("|", "\\|").replace("%%", "%")


if __name__ == "__main__":
    if sys.argv[1:] == ["--print"]:
        sys.stdout.write(text())
    else:
        PAGE.write_text(text(), encoding="utf-8")
