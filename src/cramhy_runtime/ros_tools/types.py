"""``rosmsg`` and ``rossrv``: the definitions of messages and services. They need no session."""

from __future__ import annotations

from ..ros.former_types import successor
from . import definitions, arguments as words
from .arguments import CommandError, command, one, option


def _register(tool, kind, what, find, text):
    """The commands of ``rosmsg`` or of ``rossrv``."""

    def unknown(name):
        package, slash, short = name.partition("/")
        if not slash:
            reason = f"Cannot locate {what} [{name}] in any package"
        elif package not in definitions.packages(kind):
            reason = f"Cannot locate {what} [{short}]: unknown package [{package}] on ROS_PACKAGE_PATH"
        else:
            reason = f"Cannot locate {what} [{short}] in package [{package}]; it has {_joined(definitions.types(package, kind))}"
        former = successor(name) if kind == "msg" else None
        if former is not None:
            reason += f". {former}"
        return CommandError(f"Unable to load {kind} [{name}]: {reason}")

    def meant(command_name, given):
        """The name that was given, and the full names that it means: one without a package means those of all packages."""
        name = one(words.TOOLS[tool][command_name], given, f"{what} type")
        if "/" in name:
            names = [name] if find(name) is not None else []
        else:
            names = [
                full for package in definitions.packages(kind) for full in definitions.types(package, kind) if full.endswith("/" + name)
            ]
        if not names:
            raise unknown(name)
        return name, names

    def show(terminal, options, given):
        name, names = meant("show", given)
        for full in names:
            if "/" not in name:
                terminal.line(f"[{full}]:")
            terminal.write(text(find(full)) + "\n")

    command(tool, "show", f"<{what} type>", f"prints the fields of a {what}")(show)
    command(tool, "info", f"<{what} type>", "the same as show")(show)

    @command(tool, "list", "", f"lists all {what}s")
    def list_all(terminal, options, given):
        for package in definitions.packages(kind):
            for full in definitions.types(package, kind):
                terminal.line(full)

    @command(tool, "md5", f"<{what} type>", f"prints the MD5 sum of a {what}")
    def print_md5(terminal, options, given):
        name, names = meant("md5", given)
        for full in names:
            found = definitions.md5(full, kind)
            terminal.line(found if "/" in name else f"[{full}]: {found}")

    single = option("-s", "all on one line")

    @command(tool, "package", "[-s] <package>", f"lists the {what}s of a package", single)
    def of_package(terminal, options, given):
        package = one(words.TOOLS[tool]["package"], given, "package name")
        if package not in definitions.packages(kind):
            raise CommandError(f"Error: there is no package {package} with {what}s. There are {_joined(definitions.packages(kind))}.")
        _list(terminal, options, definitions.types(package, kind))

    @command(tool, "packages", "[-s]", f"lists the packages that have {what}s", single)
    def list_packages(terminal, options, given):
        _list(terminal, options, definitions.packages(kind))


def _list(terminal, options, names):
    terminal.line((" " if options else "\n").join(names))


def _joined(names):
    return ", ".join(names) or "none"


_register("rosmsg", "msg", "message", definitions.message_definition, definitions.text_of)
_register("rossrv", "srv", "service", definitions.service_definition, definitions.service_text)
