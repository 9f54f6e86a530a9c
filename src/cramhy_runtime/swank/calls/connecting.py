"""The first words of a connection and the last ones: what this Lisp is, which parts of SLIME it has, and its end."""

from __future__ import annotations

import os
import platform
import sys

from cramhy_runtime import __version__
from cramhy_runtime.lisp_core.packages import KEYWORD, symbol_package
from cramhy_runtime.languages.commonlisp.reader.dispatch_macros import FEATURES

from .. import images, indentation
from ..packages import prompt_of
from ..rpcs import rpc
from ..slime_version import slime_version
from ..wire import Name

MODULES = """SWANK-REPL SWANK-PRESENTATIONS SWANK-ARGLISTS SWANK-FUZZY SWANK-C-P-C SWANK-FANCY-INSPECTOR SWANK-PACKAGE-FU SWANK-UTIL
SWANK-INDENTATION SWANK-ASDF SWANK-TRACE-DIALOG""".split()


def features():
    """The names of ``*features*`` as Emacs knows them."""
    return [Name(f":{each.name}".lower()) for each in FEATURES.value or () if symbol_package(each) is KEYWORD]


@rpc("connection-info")
def connection_info(call):
    package = call.connection.package
    return [
        Name(":pid"), os.getpid(),
        Name(":style"), Name(":spawn"),
        Name(":encoding"), [Name(":coding-systems"), ["utf-8-unix", "iso-latin-1-unix"]],
        Name(":lisp-implementation"),
        [Name(":type"), "cramhy", Name(":name"), "cramhy", Name(":version"), __version__, Name(":program"), sys.argv[0]],
        Name(":machine"),
        [Name(":instance"), platform.node(), Name(":type"), platform.machine(), Name(":version"), platform.processor()],
        Name(":features"), features(),
        Name(":modules"), MODULES,
        Name(":package"), [Name(":name"), package.name, Name(":prompt"), prompt_of(package)],
        Name(":version"), slime_version(),
    ]  # fmt: skip


@rpc("swank-require slynk-require")
def swank_require(call, modules, *_):
    """Parts of SLIME that Emacs wants; the parts that are here. Calls of others are refused one by one."""
    names = {str(each).upper() for each in (modules if isinstance(modules, list) else [modules])}
    if "SWANK-MEDIA" in names:
        images.wanted(call.connection)
        return [*MODULES, "SWANK-MEDIA"]
    return MODULES


@rpc("update-indentation-information")
def update_indentation(call):
    call.connection.indentation.clear()
    indentation.tell(call.connection)


@rpc("quit-lisp")
def quit_lisp(call):
    call.connection.server.quit()


@rpc("ping io-speed-test flow-control-test")
def ping(call, *_):
    return "pong"


@rpc("toggle-debug-on-swank-error toggle-break-on-signals buffer-first-change slynk-add-load-paths")
def does_nothing(call, *_):
    return None
