"""What the guide says of slips in facts and rules: names, commands and variables that Prolog takes for something else.

Such a group is accepted as it is, and later the answer is only that nothing holds. The sentence says what stands wrong, by the words of the
student, or by an example that is not the answer of a task.
"""

from __future__ import annotations

import difflib
import re

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

from .trees import Listed, atoms, bare, lists, read, shown

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

COLONS = "In a rule a property stands with colons, as in (:seconds 3) or (:type :waiting)."
"""How the properties of a designator are written in a rule, in Lisp."""
NAMES = "A property is described by names without quotes, as in (type waiting)."
"""How they are written in Hy."""
_EXAMPLE = {"lisp": "(wait ?seconds)", "hy": '["wait" ?seconds]'}
_SETTERS = ("setv", "setf", "setq", "let", "is")
_FUNCTIONS_OF_FUNCTIONS = ("apply", "funcall", "mapcar", "reduce", "map", "filter")


def of_form(text: str, language: str, checked: bool = False) -> str | None:
    """What to say of a form with facts or rules, or with a module that gets a motion; ``None`` if nothing in it is a slip.

    checked: whether the form is a solution that a check has not taken. Before that it may be the unfinished one that a task begins with.
    """
    if "<-" not in text and "pm-execute" not in text:
        return None
    for form in lists(read(text)):
        if form.head == "pm-execute" and len(form) > 2 and isinstance(form[1], str) and re.fullmatch(r"[a-z][\w-]*", form[1]):
            return f"; A quote stands before the name of the module: (pm-execute '{form[1]} ...)"
        if form.head == "<-" and (told := next(_slips(form, language, checked), None)) is not None:
            return f"; {told}"
    return None


def of_predicates(text: str, asked: Collection[str]) -> str | None:
    """What to say of a group, or of a question, that has another predicate than those that a task asks for, but almost their name."""
    tree = [each for each in lists(read(text))]
    facts = [each[1].head for each in tree if each.head == "<-" and len(each) > 1 and isinstance(each[1], Listed)]
    questions = [each.head for each in tree if each.quote == "'"]
    for wanted in asked:
        if wanted not in facts + questions and (near := difflib.get_close_matches(wanted, facts + questions, 1, 0.8)):
            other = f"your group has {near[0]}" if near[0] in facts else f"the question has {near[0]}"
            return f"; The predicate of this task is {wanted}, and {other}."
    return None


def _slips(rule: Listed, language: str, checked: bool) -> Iterator[str]:
    """What is wrong in a fact or a rule."""
    if len(rule) < 2 or not isinstance(rule[1], Listed):
        return
    head, conditions = rule[1], [each for each in rule[2:] if isinstance(each, Listed)]
    quoted = next((each for each in [*atoms(rule)] if re.match(r"'[a-z]", each)), None)
    properties = [each[2] for each in conditions if each.head == "desig-prop" and len(each) > 2 and isinstance(each[2], Listed)]
    for pair in properties:
        yield from _of_property(pair, language)
    if quoted is not None or any(each.quote for each in lists(rule)):
        yield f"In facts and rules names stand without a quote{f': {quoted[1:]}' if quoted is not None else '.'}"
    yield from _of_command(head, language)
    variables = {each for each in atoms(rule) if re.match(r"\?\w", each)}
    names = [each for part in (head, *conditions) for each in _names_in(part)]
    for name in names:
        if f"?{name}" in variables:
            yield f"{name} without a question mark is a name, and not the variable ?{name}."
    if conditions and not variables and all(each.head == head.head for each in conditions):
        yield "A second fact behind the same <- is a condition of the first one. Each fact has a <- of its own."
    for each in conditions:
        if each.head in _SETTERS:
            yield f"{each.head} is no predicate. A rule computes by lisp-fun, as in (lisp-fun max 2 7 ?most)."
    yield from _of_functions(head, conditions, checked)


def _names_in(condition):
    """The names in a condition, but for the predicate, for what `lisp-fun` calls, a designator has, or values are compared with."""
    if condition.head in ("lisp-fun", "desig-prop") or not re.search(r"\w", condition.head):  # or a comparison
        return
    for each in condition[1:]:
        yield from (atom for atom in atoms(each) if re.fullmatch(r"[a-z][\w-]*", atom)) if condition.head != "motion-grounding" else ()


def _of_property(pair, language):
    key, value = (pair[0] if pair else ""), (pair[1] if len(pair) > 1 else "")
    if not isinstance(key, str) or not isinstance(value, str):
        return
    if language == "lisp" and (not key.startswith(":") or re.match(r"['\"a-z]", value, re.I)):
        yield COLONS
    if language == "hy" and (key.startswith(("'", '"')) or value.startswith(("'", '"'))):
        yield NAMES


def _of_command(head, language):
    """A motion stands for a list, the command and what it needs."""
    if head.head != "motion-grounding" or len(head) < 3:
        return
    command, example = head[2], _EXAMPLE[language]
    if isinstance(command, str) and not command.startswith("?"):
        yield f"A command is a list, as in {example}"
    elif isinstance(command, Listed) and command and isinstance(command[0], str):
        if language == "hy" and re.match(r"[a-z:]", command[0]):
            yield f"The name of the command is a text, as in {example}"


def _of_functions(head, conditions, checked):
    """What `lisp-fun` cannot do, and variables without a value."""
    known = {"?desig", *(head[1:2] if head.head.endswith(("grounding", "module")) and isinstance(head[1], str) else ())}
    computed = {bare_variable(each[-1]) for each in conditions if each.head == "lisp-fun"}
    for place, each in enumerate(conditions):
        if each.head == "lisp-fun" and len(each) > 1:
            yield from _of_call(each, known, conditions[place + 1 :])
        known.update(atom for atom in atoms(each) if atom.startswith("?"))
    parts = [part for each in (head, *conditions) for part in atoms(each)]
    for variable in sorted(filter(None, computed)) if checked else ():
        if parts.count(variable) == 1:
            yield f"{variable} is computed, and nothing uses it."
    if checked and head.head == "motion-grounding" and len(head) > 2:
        for variable in atoms(head[2]):
            if variable.startswith("?") and len(variable) > 1 and variable not in known | computed:
                yield f"{variable} gets no value: no condition of the rule gives it one."


def bare_variable(each: object) -> str:
    """The variable that ``each`` is, or an empty text."""
    return each if isinstance(each, str) and each.startswith("?") else ""


def _of_call(call, known, later):
    called, arguments, result = bare(call[1]) if isinstance(call[1], str) else "", call[2:-1], call[-1]
    inner = next((each for each in call[2:] if isinstance(each, Listed) and each.open == "(" and not each.quote), None)
    if inner is not None and inner.head and called not in _FUNCTIONS_OF_FUNCTIONS:
        yield (
            f"lisp-fun computes no call among its arguments, such as {shown(inner)}. "
            "Another lisp-fun before it computes the value, and gives it to a variable of its own."
        )
    elif len(call) > 2 and (not bare_variable(result) or arguments and str(arguments[-1]).startswith(":")):
        yield "The last argument of lisp-fun is the variable for the result."
    elif bare_variable(result) and result in known:
        yield f"{result} has a value already, and lisp-fun needs a new variable for its result."
    for variable in filter(bare_variable, arguments):
        if variable not in known and any(variable in atoms(each) for each in later):
            yield f"The conditions are tried in their order: {variable} has no value yet where {called} is called."


__all__ = ["COLONS", "NAMES", "of_form", "of_predicates"]
