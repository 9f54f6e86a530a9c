"""Calls that evaluate forms: in the REPL buffer, in the echo area, into a buffer."""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.printer.print_controls import PRINT_PRETTY, PRINT_RIGHT_MARGIN
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.systems import program_files
from cramhy_runtime.session.requests import request_of
from cramhy_runtime.session.session import HISTORY, LAST_FORMS, LAST_VALUES, value_text

from .. import indentation, presentations
from ..packages import prompt_of
from ..reasons import aborted
from ..rpcs import Refused, number, rpc, text
from ..wire import Name

TOP = "Return to Emacs."


def evaluated(call, source, name=None):
    """The values of the last form of ``source``, evaluated in the package of the call's buffer. If the user aborts it, `Refused`."""
    with binding(evaluator.PACKAGE, call.package):
        return aborting(call, lambda: call.session.evaluate_text(source, name, top=call.debugger is None))


def aborting(call, thunk):
    """What ``thunk`` returns, called where the restart ABORT leads back to Emacs. `Refused` if that was taken."""
    completed, result = call.session.with_abort(thunk, TOP)
    if not completed:
        request = request_of()
        raise Refused(aborted(request.owner if request is not None else None))
    return result


def echo(values):
    """The values for the echo area, as SLIME shows them."""
    if not values:
        return "; No value"
    shown = ", ".join(map(value_text, values))
    only = values[0]
    if len(values) == 1 and isinstance(only, int) and not isinstance(only, bool):
        return f"=> {only} ({only.bit_length()} bit{'s' if only.bit_length() != 1 else ''}, #x{only:X}, #o{only:o}, #b{only:b})"
    return f"=> {shown}"


# --------------------------------------------------------------------------------------------------------------- echo area


@rpc("interactive-eval interactive-eval-region", evaluates=True)
def interactive_eval(call, source):
    values = evaluated(call, text(source))
    return aborting(call, lambda: echo(values))


@rpc("pprint-eval", evaluates=True)
def pprint_eval(call, source):
    values = evaluated(call, text(source))
    with binding(PRINT_PRETTY, True):
        return aborting(call, lambda: "".join(value_text(value) + "\n" for value in values)) or "; No value"


@rpc("eval-and-grab-output", evaluates=True)
def eval_and_grab_output(call, source):
    output = streams.StringOutputStream()
    with binding(streams.STANDARD_OUTPUT, output, streams.ERROR_OUTPUT, output, streams.TRACE_OUTPUT, output):
        values = evaluated(call, text(source))
    return [output.take(), aborting(call, lambda: "\n".join(map(value_text, values)))]


@rpc("value-for-editing", evaluates=True)
def value_for_editing(call, source):
    with binding(PRINT_PRETTY, True):
        return "".join(value_text(value) for value in evaluated(call, text(source))[:1])


@rpc("commit-edited-value", evaluates=True)
def commit_edited_value(call, source, value):
    return echo(evaluated(call, f"(setf {text(source)} {text(value)})"))


@rpc("load-file", evaluates=True)
def load_file(call, path):
    source = text(path).endswith((".lisp", ".hy", ".asd"))
    with binding(evaluator.PACKAGE, call.package):
        aborting(call, lambda: call.session.load(text(path)) if source else program_files.load(text(path)))
    indentation.tell(call.connection)
    return f"=> {path} is loaded."


# ---------------------------------------------------------------------------------------------------------------------- REPL


@rpc("create-repl")
def create_repl(call, target=None, *, coding_system=None):
    package = call.connection.package
    indentation.tell(call.connection)
    return [package.name, prompt_of(package)]


@rpc("listener-eval", evaluates=True)
def listener_eval(call, source, *, window_width=None):
    """The form of the REPL buffer. Its values go there as presentations, and the package that it leaves is that of the next prompt."""
    connection = call.connection
    margin = (PRINT_RIGHT_MARGIN, window_width) if isinstance(window_width, int) and window_width > 20 else ()
    with binding(evaluator.PACKAGE, connection.package, *margin):
        if connection.images is not None:
            connection.images.begin()
        values = aborting(call, lambda: call.session.evaluate_text(text(source), None, top=True))
        before, connection.package = connection.package, evaluator.PACKAGE.value
        if connection.package is not before:
            connection.send(Name(":new-package"), connection.package.name, prompt_of(connection.package))
        aborting(call, lambda: show(connection, values))
        if connection.images is not None:
            connection.images.show()
    if "(" in text(source) and ("mac" in text(source).lower() or "load" in text(source).lower()):
        indentation.tell(connection)  # it may have defined macros


@rpc("create-mrepl")
def create_mrepl(call, *_):
    raise Refused("cramhy has no REPL buffer for SLY. C-x C-e, C-c C-c and M-. work in SLY's buffers of files; for a REPL take SLIME.")


def show(connection, values):
    """Write ``values`` into the REPL buffer as the results of a form."""
    kept, result = presentations.of(connection), Name(":repl-result")
    fresh = streams.STANDARD_OUTPUT.value
    if getattr(fresh, "column", 0):
        fresh.fresh_line()
    if not values:
        connection.send(Name(":write-string"), "; No value\n", result)
    for value in values:
        shown = value_text(value)
        if connection.presents:
            id_ = kept.add(value)
            connection.send(Name(":presentation-start"), id_, result)
            connection.send(Name(":write-string"), shown, result)
            connection.send(Name(":presentation-end"), id_, result)
            connection.send(Name(":write-string"), "\n", result)
        else:
            connection.send(Name(":write-string"), shown + "\n", result)


@rpc("init-presentations")
def init_presentations(call, *_):
    call.connection.presents = True


@rpc("clear-repl-results")
def clear_repl_results(call):
    presentations.of(call.connection).objects.clear()
    return True


@rpc("clear-repl-variables")
def clear_repl_variables(call):
    for variable in (*HISTORY, *LAST_VALUES, *LAST_FORMS):
        variable.value = None


@rpc("lookup-and-save-presented-object-or-lose")
def lookup_and_save(call, id_):
    kept = presentations.of(call.connection)
    return kept.add(kept.find(id_))


@rpc("redirect-trace-output init-presentation-streams")
def not_here(call, *_):
    return None


def presented(id_, *default):
    """``(swank:lookup-presented-object-or-lose 3)``: the object that Emacs shows under that number."""
    request = request_of(kernel.current())
    connection = getattr(request.owner, "connection", None) if request is not None else None
    if connection is None:
        raise Refused("A presented object can be looked up only by a form that Emacs sends.")
    return presentations.of(connection).find(number(id_))
