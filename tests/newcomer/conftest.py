"""A newcomer's machine: an empty home, no cramhy on the path, and a clone of the repository."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def commands_of_the_readme():
    """The lines of README's blocks of commands, in order."""
    blocks = re.findall(r"^```(\w*)\n(.*?)^```$", (ROOT / "README.md").read_text(), re.M | re.S)
    return [line for language, block in blocks for line in block.splitlines() if not language]


class Newcomer:
    """Somebody who has just cloned the repository. ``clone``: its folder; ``home``: where the newcomer's own files are."""

    def __init__(self, folder):
        self.clone, self.home = folder / "cramhy", folder / "home"
        programs = folder / "bin"
        for made in (self.home, programs, folder / "run"):
            made.mkdir(mode=0o700)
        python = programs / "python3"
        python.write_text(f'#!/bin/sh\nexec "{Path(sys._base_executable).resolve()}" "$@"\n')
        python.chmod(0o755)
        kept = {name: os.environ[name] for name in os.environ if name.startswith(("PIP_", "SSL_")) or name.endswith("_proxy")}
        self.variables = {
            **kept,
            "PATH": os.pathsep.join([str(programs), "/usr/local/bin", "/usr/bin", "/bin"]),
            "HOME": str(self.home),
            "XDG_RUNTIME_DIR": str(folder / "run"),
            "LANG": "C.UTF-8",
            "TERM": "xterm-256color",
        }
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True)
        if listed.returncode:
            pytest.skip("this tree is no clone of git's, so what a newcomer's clone has is not known")
        for name in filter(None, listed.stdout.split("\0")):
            if (ROOT / name).is_file():
                (self.clone / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / name, self.clone / name)

    def start(self, command, folder=None, **options):
        """A process that a shell starts with a command line, in the clone or in another folder. options: of `subprocess.Popen`."""
        words = ["/bin/bash", "-c", command]
        return subprocess.Popen(words, cwd=folder or self.clone, env=self.variables, stdin=subprocess.DEVNULL, text=True, **options)

    def run(self, command, folder=None):
        """Run a command line; what it prints. A status other than 0 is an error."""
        with self.start(command, folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
            printed = process.communicate()[0]
        assert process.returncode == 0, f"{command}\n{printed}"
        return printed

    def terminal(self, command):
        """A `Terminal` of 40 lines in which a shell runs a command line in the clone."""
        from repl.terminal import Terminal

        variables = {**dict.fromkeys(os.environ), "PYTHONPATH": None, "PROMPT_TOOLKIT_NO_CPR": None, **self.variables}
        return Terminal(program=["/bin/bash", "-c", f"cd '{self.clone}' && {command}"], variables=variables, size=(40, 120))


@pytest.fixture(scope="session")
def newcomer(tmp_path_factory):
    """A `Newcomer` who has typed README's commands one after the other, all but the last, which opens a prompt."""
    for tool in ("bash", "git", "make"):
        if not shutil.which(tool):
            pytest.skip(f"{tool} is not installed")
    made = Newcomer(tmp_path_factory.mktemp("newcomer"))
    if made.start("command -v cramhy roslisp_repl").wait() == 0:
        pytest.skip("a cramhy is installed for all users of this machine")
    for command in commands_of_the_readme()[:-1]:
        with made.start(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
            printed = process.communicate()[0]
        if process.returncode and re.search(r"No matching distribution|Could not fetch|Connection|Temporary failure", printed):
            pytest.skip(f"what README installs cannot be fetched here: {printed.strip().splitlines()[-1]}")
        assert process.returncode == 0, f"{command}\n{printed}"
    return made
