"""The REPL sessions of docs/prolog.md: what stands there after a prompt is typed, and what stands below it is what the REPL answers.

``python tests/prolog/test_prolog_page.py`` writes the page anew with the answers of now.
"""

import re
import subprocess
import sys
from pathlib import Path

PAGE = Path(__file__).parents[2] / "docs" / "prolog.md"
PROMPT = re.compile(r"^(?:CL-USER|KITCHEN)> ", re.M)


def entries(text):
    """(prompt, form, answer) of each line at a prompt; a form goes on where lines are indented to the prompt."""
    found = []
    for block in re.findall(r"```lisp\n(.*?)```", text, re.S):
        starts = [match.start() for match in PROMPT.finditer(block)] + [len(block)]
        for start, end in zip(starts, starts[1:]):
            prompt = PROMPT.match(block, start).group()
            first, *lines = block[start + len(prompt) : end].splitlines()
            count = 0
            while count < len(lines) and (lines[count].startswith(" " * len(prompt)) or (not lines[count] and count + 1 < len(lines))):
                count += 1
            found.append((prompt, "\n".join([first, *(line[len(prompt) :] for line in lines[:count])]), "\n".join(lines[count:])))
    return found


def answers(forms):
    """What the REPL prints for each form."""
    done = subprocess.run(
        [sys.executable, "-m", "cramhy_runtime.cli", "repl", "--time", "virtual", "--no-turtlesim"],
        text=True,
        input="\n".join(forms) + "\n",
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    return [answer.rstrip("\n") for answer in PROMPT.split(done.stdout)[1 : len(forms) + 1]]


def test_the_page_shows_what_the_repl_answers():
    told = entries(PAGE.read_text())
    assert len(told) > 20
    for (_, form, answer), got in zip(told, answers([form for _, form, _ in told]), strict=True):
        assert got == answer, form


def write():
    text = PAGE.read_text()
    told = entries(text)
    got = iter(list(zip(told, answers([form for _, form, _ in told]))))
    blocks = []
    for block in re.findall(r"```lisp\n(.*?)```", text, re.S):
        lines = []
        for _ in PROMPT.findall(block):
            (prompt, form, _), answer = next(got)
            lines.append(prompt + form.replace("\n", "\n" + " " * len(prompt)))
            lines += [answer] if answer else []
        blocks.append("```lisp\n" + re.sub(r" +$", "", "\n".join(lines), flags=re.M) + "\n```")
    fresh = iter(blocks)
    PAGE.write_text(re.sub(r"```lisp\n.*?```", lambda match: next(fresh), text, flags=re.S))


if __name__ == "__main__":
    write()
