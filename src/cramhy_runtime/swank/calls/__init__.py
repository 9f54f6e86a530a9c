"""The calls of SLIME and SLY, by what they are for. A module enters its calls into the table of `rpcs` when it is imported.

Where the parts are: `connecting` the first words and the last; `evaluating` forms, the REPL buffer and its presentations; `compiling`
files and definitions, with notes; `completing` names and arglists; `describing` documentation; `finding` definitions and uses; `expanding`
macros; `inspecting` objects; `debugging` errors; `threads` tasks; `packages` symbols and packages; `systems` those of ASDF; `tracing` the
buffer of recorded calls; `copying` objects that Emacs shows.
"""

from . import (
    compiling,
    completing,
    connecting,
    copying,
    debugging,
    describing,
    evaluating,
    expanding,
    finding,
    inspecting,
    packages,
    systems,
    threads,
    tracing,
)

ALL = (
    compiling,
    completing,
    connecting,
    copying,
    debugging,
    describing,
    evaluating,
    expanding,
    finding,
    inspecting,
    packages,
    systems,
    threads,
    tracing,
)
