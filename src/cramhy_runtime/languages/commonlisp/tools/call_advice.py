"""What to try where a list that was meant as a call is none: the operator stands in the wrong place, or a space is missing."""

from __future__ import annotations

from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.lisp_core.data import Cons, Symbol, UndefinedFunction, list_parts
from ..evaluation.forms import special_operator_p
from ..printer.printer import prin1_to_string
from .operators_around import token_at

_GLUED = late_pattern(r"([-+*/<>=]|[<>/]=)(\d\S*)")


def of_head(form, position) -> str | None:
    """What to try instead of ``form``, a list with a number or another object as its first element. position: of its parenthesis."""
    if position and (told := glued(token_at(position, 1))):
        return told
    elements, _ = list_parts(form)
    if isinstance(form.car, Cons):
        called = " ".join(map(prin1_to_string, elements))
        return f"Is a parenthesis too many in front of it? A function that a form gives is called so: (funcall {called})"
    operators = [each for each in elements if isinstance(each, Symbol) and not isinstance(each.function, UndefinedFunction)]
    if not operators:
        return f"In a call the name of the function comes first. A list that is no call has a quote: '{prin1_to_string(form)}"
    name = operators[0]
    first = next(each for each in elements if each is not name)
    return f"The name of the function comes first: ({name.name.lower()} {prin1_to_string(first)} ...)"


def of_lambda_list(lambda_list) -> str | None:
    """What to try where ``lambda_list`` is a call, so that the list of the parameters was forgotten; ``None`` if it is none."""
    head = lambda_list.car if isinstance(lambda_list, Cons) else None
    if not isinstance(head, Symbol):
        return None
    if head.macro is None and not special_operator_p(head) and isinstance(head.function, UndefinedFunction):
        return None
    return "The list of the parameters comes behind the name of the function. If it has none, write () there: (defun name () ...)"


def glued(token: str) -> str | None:
    """What to try where ``token`` is an operator and a number in one, such as ``*24``; ``None`` if it is not."""
    match = _GLUED.fullmatch(token)
    return f"Is a space missing behind the {match[1]}? ({match[1]} {match[2]} ...)" if match else None
