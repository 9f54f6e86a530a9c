"""The extras of the package: the command that installs one, for the installation that runs.

An extra is a set of packages that cramhy can do without (``[project.optional-dependencies]`` in pyproject.toml). A message that asks for
one names a command that works as it stands: an installation from a clone is made from the clone again, and pip is the one that
installs for this Python, also where it is not on the PATH. Where cramhy came from stands in ``direct_url.json``, which pip writes beside
the package's metadata (PEP 610).

This module stands below all rooms, because each of them may miss an extra.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path


def install_command(extra):
    """The shell command that installs an extra.

    extra: its name, or several with commas between them (``"web,record"``). Returns text such as ``pip install 'cramhy[web]'``, quoted for
    the system's shell.
    """
    return " ".join([_pip(), "install", *map(_quoted, _requirement(extra))])


def _pip():
    """The words that run pip for this Python."""
    import shutil  # takes 4 ms, and only a message needs it

    found = shutil.which("pip")
    if found and os.path.dirname(os.path.abspath(found)) == os.path.dirname(os.path.abspath(sys.executable or "")):
        return "pip"
    if sys.prefix == sys.base_prefix or not sys.executable:  # no virtual environment: the user's habits are the best guess
        return "pip"
    return f"{_quoted(os.path.abspath(sys.executable))} -m pip"


def _requirement(extra):
    """The words after ``pip install``, not quoted."""
    source = _direct_url()
    url = source.get("url", "")
    if "dir_info" in source and url.startswith("file:"):
        folder = f"{_path(url)}[{extra}]"
        return ["-e", folder] if source["dir_info"].get("editable") else [folder]
    if "vcs_info" in source:
        return [f"cramhy[{extra}] @ {source['vcs_info'].get('vcs', 'git')}+{url}"]
    if url:
        return [f"cramhy[{extra}] @ {url}"]
    return [f"cramhy[{extra}]"]


def _direct_url():
    """What pip noted of where cramhy came from; empty for an index. Code that runs out of a clone without pip counts as editable."""
    import json
    from importlib import metadata

    try:
        return json.loads(metadata.distribution("cramhy").read_text("direct_url.json") or "{}")
    except ValueError:
        return {}
    except metadata.PackageNotFoundError:
        clone = Path(__file__).absolute().parents[2]
        if (clone / "pyproject.toml").is_file():
            return {"url": clone.as_uri(), "dir_info": {"editable": True}}
        return {}


def _path(url):
    """The path of a ``file:`` address."""
    from urllib.parse import urlsplit
    from urllib.request import url2pathname

    return url2pathname(urlsplit(url).path)


def _quoted(word):
    import shlex  # few processes miss an extra

    return f'"{word}"' if os.name == "nt" and not word.isalnum() else shlex.quote(word)
