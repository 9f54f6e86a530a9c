"""Which robot a session joins: ``--ros`` and ``--ros-token``, or the variables CRAMHY_ROS and CRAMHY_ROS_TOKEN.

All users of a machine see the arguments of its processes, so a token must not stand there. ``--ros @FILE`` reads the address from a
file, ``--ros-token FILE`` the token alone; CRAMHY_ROS holds what ``--ros`` would be given, CRAMHY_ROS_TOKEN the token itself. An option
comes before its variable. A file with a token must not be readable by others, as ssh wants it of its keys.
"""

from __future__ import annotations

import os
import stat
import sys

from cramhy_runtime.rosbridge import addresses
from cramhy_runtime.storage import owners

ADDRESS, TOKEN = "CRAMHY_ROS", "CRAMHY_ROS_TOKEN"
LONGEST = 4096  # bytes of a file that are read
SEEN = "; Every user of this machine can see the token in --ros {shown}. Write the address into a file: --ros @FILE"


class Unusable(Exception):
    """There is no address in what was given: the text says what is wrong and what to do."""


def chosen(option, token_file):
    """The address to join, or ``None`` when no robot is asked for. option, token_file: what --ros and --ros-token were given, or ``None``.

    Raises `Unusable`.
    """
    if option is None:
        asked, given = ADDRESS, os.environ.get(ADDRESS) or None
    else:
        asked, given = "--ros", option
    if given is None:
        if token_file is not None:
            raise Unusable("--ros-token is the token for a robot; give its address with --ros, too.")
        return None
    url = given
    if given.startswith("@"):
        asked = f"{asked} {given}"
        url = _line_of(given[1:], asked, "the address of a rosbridge server, such as ws://robot:9090")
    if not addresses.is_address(url):
        what = "what the file holds is" if given.startswith("@") else "that is"
        named = asked if given.startswith("@") else f"{asked} {_harmless(url)}"
        raise Unusable(f"{named}: {what} not an address of a rosbridge server; one looks like ws://robot:9090.")
    if given.startswith("@") and addresses.has_token(url):
        _not_for_others(given[1:], asked)
    elif option is not None and addresses.has_token(url):
        print(SEEN.format(shown=addresses.shown(url)), file=sys.stderr, flush=True)
    return _with_token(url, token_file)


def _with_token(url, token_file):
    if token_file is not None:
        asked = f"--ros-token {token_file}"
        token = _line_of(token_file, asked, "a token")
        _not_for_others(token_file, asked)
    elif addresses.has_token(url) or not os.environ.get(TOKEN):
        return url
    else:
        asked, token = TOKEN, os.environ[TOKEN].strip()
    if addresses.has_token(url):
        raise Unusable(f"{asked}: the address {addresses.shown(url)} has a token already. Leave one of them out.")
    joined = addresses.with_token(url, token)
    if not addresses.is_address(joined) or "?" in token:
        raise Unusable(f"{asked}: this is not a token; one is a word of letters, digits, - and _.")
    return joined


def _line_of(path, asked, what):
    """The one line of the file ``path``."""
    try:
        with open(path, "rb") as file:
            lines = file.read(LONGEST).decode("utf-8").split()
    except OSError as problem:
        raise Unusable(f"{asked}: the file cannot be read: {problem.strerror}.") from None
    except ValueError:  # no UTF-8; a zero byte in the path
        lines = []
    if len(lines) != 1:
        raise Unusable(f"{asked}: the file must hold one line, {what}.")
    return lines[0]


def _not_for_others(path, asked):
    status = os.stat(path)
    if stat.S_ISREG(status.st_mode) and owners.open_to_others(status):
        raise Unusable(f"{asked}: others than you can read this file, and it holds a token. Type: chmod 600 {path}")


def _harmless(text):
    """What the user gave instead of an address, cut before anything that may be a token."""
    scheme, separator, rest = text.rpartition("://")
    host, slash, _ = rest.partition("/")
    return scheme + separator + host + (addresses.HIDDEN if slash else "")
