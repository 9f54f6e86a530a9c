"""Forms of Python that call functions refuse what a call has returned: ``par(drive())`` has driven before ``par`` began."""

from __future__ import annotations

import pytest

from cramhy_runtime import cpl
from cramhy_runtime.lisp_core.conditions import Error


def drive():
    cpl.sleep(1)


FORMS = {
    "par": ("a branch", "drive", lambda value: cpl.par(drive, value)),
    "pursue": ("a branch", "drive", lambda value: cpl.pursue(value, drive)),
    "try_all": ("a branch", "drive", lambda value: cpl.try_all(value)),
    "try_in_order": ("a branch", "drive", lambda value: cpl.try_in_order(drive, value)),
    "try_each_in_order": ("what to try", "elements, drive", lambda value: cpl.try_each_in_order([1], value)),
    "par_loop": ("its body", "elements, drive", lambda value: cpl.par_loop([1, 2], value)),
    "with_task": ("its body", "drive", lambda value: cpl.with_task(value)),
    "make_policy": ("the clause check", "name, check=drive", lambda value: cpl.make_policy("calm", check=value)),
}


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("form", FORMS)
def test_a_value_in_the_place_of_a_function_says_what_to_write(form):
    role, written, call = FORMS[form]
    value = drive if form == "make_policy" else None
    with pytest.raises(TypeError) as told:
        cpl.run(lambda: call(3 if value else drive()), clock="virtual")
    given = "3 (of the type int)" if value else "None (of the type NoneType)"
    assert str(told.value) == (
        f"cpl.{form} takes a function as {role}, and calls it, but was given {given}. If that is what a call such as drive() gave, the call "
        f"was over before cpl.{form} began. Write cpl.{form}({written}), without the parentheses behind drive, or with arguments "
        f"cpl.{form}({written.replace('drive', 'lambda: drive(2)')})."
    )


def test_a_block_and_a_run_take_functions():
    def starts():
        with cpl.par() as branches:
            branches.start(drive())

    with pytest.raises(TypeError, match=r"branches\.start takes a function as a branch, .* but was given None"):
        cpl.run(starts, clock="virtual")
    with pytest.raises(TypeError, match=r"cpl\.run takes a function as the plan, .* Write cpl\.run\(drive\), without the parentheses"):
        cpl.run(None, clock="virtual")


def test_a_clause_of_a_policy_is_a_plain_function():
    async def check(store):
        return True

    with pytest.raises(TypeError, match="check is an `async def`, and cannot be the clause check of a policy"):
        cpl.make_policy("calm", check=check)


@pytest.mark.parametrize("form", [cpl.par, cpl.pursue, cpl.try_all], ids=["par", "pursue", "try_all"])
def test_no_branches_are_nothing_until_a_block_begins(form):
    def main():
        nothing = form(*[])
        assert not nothing and cpl.now() == 0
        with form() as branches:
            branches.start(drive)
            return bool(branches)

    assert cpl.run(main, clock="virtual") is True


def test_a_plan_in_a_plan_says_what_its_time_is():
    with pytest.raises(Error) as told:
        cpl.run(lambda: cpl.run(drive, clock="virtual"), clock="virtual")
    assert str(told.value) == (
        "A plan was started inside of a plan. Call its function as it is: it then runs as a part of this plan, in the time of this one. A "
        "plan in another time (clock=) is run before this one or after it, or in a process of its own."
    )
