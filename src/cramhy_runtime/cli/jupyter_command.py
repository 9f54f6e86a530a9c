"""``cramhy jupyter install | uninstall | kernel``: notebooks."""

from __future__ import annotations

import os
import sys


def install(options):
    """Write the kernel's description where the options say, or remove it. Returns the exit status."""
    from cramhy_runtime.jupyter import kernelspec

    prefix = sys.prefix if options.sys_prefix else options.prefix
    if prefix is None and not options.user:
        prefix = sys.prefix
    try:
        if options.action == "install":
            print(f"The kernel is described in {kernelspec.install(prefix, options.user, options.time)}")
        elif kernelspec.uninstall(prefix, options.user):
            print(f"{kernelspec.folder(prefix, options.user)} is removed.")
        else:
            print(f"cramhy: there is no kernel in {kernelspec.folder(prefix, options.user)}.", file=sys.stderr)
            return 1
    except OSError as problem:
        where = problem.filename or kernelspec.folder(prefix, options.user)
        print(f"cramhy: {os.fspath(where)}: {problem.strerror}. Choose a folder with --user or --prefix.", file=sys.stderr)
        return 1
    return 0
