"""How each shell is told a command: a function that calls this Python by its absolute path, one line for each.

``sh`` is what POSIX shells read: bash, zsh, dash, ksh. fish and PowerShell have languages of their own. A function passes its words on as
they are, leaves its exit status, and reads what is piped into it. ``roscd`` changes the shell's folder, which only a function can do.

PowerShell takes typographic quotes for quotes, and reads what a program prints in the console's code page. So a word is written in ASCII,
with ``[char]0xFC`` for other signs. Sources: about_Quoting_Rules, about_Automatic_Variables (``$MyInvocation``, ``$input``),
fishshell.com/docs/current/language.html#quotes.
"""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Callable


def posix(name: str, words: list[str]) -> str:
    """The function ``name`` of a POSIX shell, which runs the program ``words``."""
    program = shlex.join(words)
    if name == "roscd":
        return f'roscd() {{ local to; to="$({program} "$@")" && cd "$to"; }}\n'
    return f'{name}() {{ {program} "$@"; }}\n'


def fish(name: str, words: list[str]) -> str:
    """The same for fish."""
    program = " ".join("'" + word.replace("\\", "\\\\").replace("'", "\\'") + "'" for word in words)
    if name == "roscd":
        return f"function roscd; set -l to ({program} $argv); and cd $to; end\n"
    return f"function {name}; {program} $argv; end\n"


def powershell(name: str, words: list[str]) -> str:
    """The same for PowerShell, 5.1 of Windows and later ones."""
    program = "& " + " ".join(map(_powershell_word, words)) + " @args"
    if name == "roscd":
        return f"function roscd {{ $to = {program}; if ($LASTEXITCODE -eq 0) {{ Set-Location -LiteralPath $to }} }}\n"
    return f"function {name} {{ if ($MyInvocation.ExpectingInput) {{ $input | {program} }} else {{ {program} }} }}\n"


def _powershell_word(word: str) -> str:
    pieces = re.findall(r"[ -~]+|[^ -~]", word) or [""]
    texts = [f"'{piece.replace(chr(39), chr(39) * 2)}'" if " " <= piece[:1] <= "~" or not piece else _sign(ord(piece)) for piece in pieces]
    return texts[0] if len(texts) == 1 and texts[0].startswith("'") else f"('' + {' + '.join(texts)})"


def _sign(number: int) -> str:
    return f"[char]0x{number:X}" if number < 0x10000 else f"[char]::ConvertFromUtf32(0x{number:X})"


FUNCTIONS: dict[str, Callable[[str, list[str]], str]] = {"sh": posix, "fish": fish, "powershell": powershell}
"""The languages by the names that ``--shell`` has for them."""


def default() -> str:
    """The language that ``cramhy ros-shims`` prints when nothing is said: PowerShell on Windows outside of a POSIX shell, else ``sh``."""
    return "powershell" if os.name == "nt" and not os.environ.get("SHELL") else "sh"


def line(cramhy: str) -> str:
    """The line that defines the commands in the user's shell. cramhy: how to call that, quoted for the shell."""
    if default() == "powershell":
        return f"{'& ' if cramhy.startswith(chr(39)) else ''}{cramhy} ros-shims | Invoke-Expression"
    if os.path.basename(os.environ.get("SHELL", "")) == "fish":
        return f"{cramhy} ros-shims --shell fish | source"
    return f'eval "$({cramhy} ros-shims)"'
