"""The mark ``soak``: which tests `make test` leaves out, and `make soak` runs.

    @pytest.mark.soak                          the whole test; ``pytestmark = pytest.mark.soak``: the file; in ``pytest.param``: that case
    @pytest.mark.soak(only=("threads", "hy"))  the cases whose id has one of these words between its dashes
    @pytest.mark.soak(all_but=3)               all cases but three, evenly spread over those that are left

The last two stand on the function itself. The rule is the same each time: who reads a test knows which of its cases run.
"""

import collections

import pytest

WRONG = pytest.StashKey[list[str]]()
"""What is wrong with the marks of this run; `test_soak_marks.py` looks at it."""
LEFT_OUT = pytest.StashKey[int]()
"""How many tests this run leaves out."""


def leave_on_cases(items):
    """Take each mark with arguments from the cases that it does not mean. Return what is wrong with marks, as texts."""
    tests, wrong = collections.defaultdict(list), []
    for item in items:
        tests[item.nodeid.partition("[")[0]].append(item)
    for name, cases in tests.items():
        mark = next((mark for mark in cases[0].own_markers if mark.name == "soak" and (mark.args or mark.kwargs)), None)
        if mark is None:
            continue
        only, all_but = mark.kwargs.get("only", ()), mark.kwargs.get("all_but")
        ids = {case: f"-{case.callspec.id}-" for case in cases if hasattr(case, "callspec")}
        wrong += [f"{name}: no case has the word {word!r}" for word in only if not any(f"-{word}-" in each for each in ids.values())]
        others = [case for case in cases if not any(f"-{word}-" in ids.get(case, "") for word in only)]
        free = [case for case in others if all(each is mark for each in case.iter_markers("soak"))]
        if all_but and all_but >= len(free):
            wrong.append(f"{name}: all_but={all_but} leaves out none of its {len(free)} cases")
        few = len(free) if all_but is None else min(all_but, len(free))
        stay = [free[(2 * number + 1) * len(free) // (2 * few)] for number in range(few)]
        for case in stay:
            case.own_markers = [each for each in case.own_markers if each is not mark]
    return wrong
