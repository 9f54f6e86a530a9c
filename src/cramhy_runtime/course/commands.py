"""The commands of ``cramhy learn``: lines that begin with a colon, and what is said where such a line stands in a form that is open."""

from __future__ import annotations

import difflib

from cramhy_runtime.repl.open_forms import OpenForms

COMMANDS = {
    "next": ("n", "the next step, or the next page"),
    "type": ("t", "type the next form of this step for you"),
    "back": ("b", "the step before"),
    "again": ("a", "this step, shown again"),
    "hint": ("h", "the next hint for the task"),
    "check": ("c", "look whether the task is solved"),
    "write": ("w", "write the file of this step, over one of your own, too"),
    "pages": ("p", "all pages, and what you have solved"),
    "page": ("", "go to a page, by its number: :page 3; :page 3 2 goes to its step 2"),
    "replay": ("r", "type again what you typed on this page in an earlier session"),
    "help": ("?", "this list"),
    "quit": ("q", "leave; cramhy learn goes on here"),
}
"""The commands: the short name of each, and what it does."""
_SHORT = {short: name for name, (short, _) in COMMANDS.items() if short}
WITH_ARGUMENT = ("page",)


def command(line: str) -> tuple[str, str] | None:
    """(name, argument) of the command that a line is, with or without the colon in front; ``None`` if it is none."""
    first, *arguments = line.strip().lower().split() or [""]
    word = first.removeprefix(":")
    name = word if word in COMMANDS else _SHORT.get(word) if first.startswith(":") else None
    if name not in WITH_ARGUMENT:
        return (name, "") if name is not None and not arguments else None
    if 1 <= len(arguments) <= 2:
        return name, " ".join(arguments)
    return (name, "") if first.startswith(":") else None


def meant(line: str) -> str | None:
    """What to say of a line with a colon in front that is almost a command; ``None`` for any other line."""
    first, *arguments = line.strip().lower().split() or [""]
    if not first.startswith(":"):
        return None
    found = command(first)
    if found is not None and arguments:
        return f"; :{found[0]} stands alone in its line." if found[0] not in WITH_ARGUMENT else None
    near = difflib.get_close_matches(first[1:], COMMANDS, 1, 0.65)
    return f"; There is no command {first}. Did you mean :{near[0]}?" if near and not arguments else None


def told_of_open_form(lines: list[str], language: str = "lisp") -> str | None:
    """What to say when a form is open, and the last of ``lines`` is empty, a command, or was meant for the debugger; else ``None``."""
    line = lines[-1].strip()
    found = command_in_form(line)
    if line and found is None and line.lower() not in ("q", "help", "?", "exit"):
        return None
    opened = OpenForms(hy=language == "hy")
    opened.read("\n".join([*(lines[:-1] if found else lines), ""]))
    if opened.within == '"':
        what, close = "A text is open", 'End it by "'
    else:
        ends = "".join(")]}"["([{".index(each[0])] for each in reversed(opened.lists))
        what, close = "A form is open", f"Close it by {ends}" if 0 < len(ends) < 10 and not opened.within else "Close its parentheses"
    if found is not None:
        return (
            f"; {what}, so :{found} has to wait, and what you have typed stays. {close}, or press Ctrl-C to leave it. Then type :{found}."
        )
    taken = f", and {line} is taken for a part of it" if line else ""
    return f"; {what}{taken}. {close}, or press Ctrl-C to begin anew."


def command_in_form(line: str) -> str | None:
    """The name of the command that a further line of a form is, with its colon. It is not a part of the form."""
    found = command(line) if line.strip().startswith(":") else None
    return found[0] if found is not None else None


__all__ = ["COMMANDS", "WITH_ARGUMENT", "command", "command_in_form", "meant", "told_of_open_form"]
