"""Auto tracing: every plan that ends is saved, as ``<YYYYMMDDHHMMSS>-<PLAN-NAME>.ek`` in one directory.

Off at first. The time is that of the kernel's clock at the plan's end; a name that is taken gets ``-1``, ``-2``. A plan is not to
suffer from it: what goes wrong in saving is a warning. Source: projection-and-events.md C3.
"""

from __future__ import annotations

import os

from cramhy_runtime.kernel.images import Cell
from cramhy_runtime.lisp_core.conditions import Error, SimpleError, error, handler_case, type_error, warn
from cramhy_runtime.lisp_core.data import truth
from ...files.files import ensure_directories_exist, path_of
from ...pathnames.pathnames import pathname
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.lisp_core.printing import princ_to_string
from cramhy_runtime.utilities.small_functions import current_string_timestamp, ensure_unused_string, sanitize_filename
from .files import save_to
from cramhy_runtime.episodes.symbols import sym
from cramhy_runtime.episodes.tracing import enable_fluent_tracing, tracing

TYPE = ".ek"
_directory = Cell(None)  # the folder, as the system calls it


def set_auto_tracing_directory(path, *, ensure_directory=None):
    """Save into the directory ``path`` from now on; with ``ensure_directory`` it is made. Returns its name. Errors: there is none."""
    folder = os.path.join(path_of(path), "")
    if truth(ensure_directory):
        ensure_directories_exist(folder)
    if not os.path.isdir(folder):
        return error(
            SimpleError("Pathspec ~s does not designate a valid path for auto tracing.", pathname(path)),
            hint="There is no such directory. With :ensure-directory t it is made.",
        )
    _directory.value = folder
    return folder


def enable_auto_tracing():
    """Save every plan that ends from now on; returns t. A directory must have been set."""
    if _directory.value is None:
        return type_error(
            None,
            sym("PATHNAME"),
            "\n(Auto tracing needs a directory: call (set-auto-tracing-directory path) before, or (setup-auto-tracing path).)",
        )
    tracing.saving = save
    tracing.observe()
    return True


def disable_auto_tracing():
    """Save plans no more. Returns nil."""
    tracing.saving = None
    tracing.observe()


def auto_tracing_enabled():
    return True if tracing.saving is not None else None


def setup_auto_tracing(directory, *, ensure_directory=None):
    """Trace fluents, and save every plan into ``directory``; returns t."""
    set_auto_tracing_directory(directory, ensure_directory=ensure_directory)
    enable_fluent_tracing()
    return enable_auto_tracing()


def save(episode):
    """Save the episode of a plan that just ended."""
    name = "NIL" if episode.plan_name is None else symbol_name(episode.plan_name)
    base = f"{_directory.value}{current_string_timestamp()}-{sanitize_filename(name)}"
    file = ensure_unused_string(base, lambda candidate: os.path.exists(candidate + TYPE) or None) + TYPE
    try:
        handler_case([(Error, lambda problem: _not_saved(file, problem))], lambda: save_to(file, episode))
    except OSError as problem:
        _not_saved(file, problem)


def _not_saved(file, problem):
    why = princ_to_string(problem) if isinstance(problem, Error) else str(problem)
    warn("The episode of the plan could not be saved in ~a: ~a", file, why)
