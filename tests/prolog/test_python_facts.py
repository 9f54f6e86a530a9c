"""Facts that come and go, and traces, from Python: `facts_asserted`, `facts_watched`, `trace`."""

import pytest

from cramhy_runtime.prolog import P, V, fact_group, facts_asserted, facts_watched, holds, kw, solve, trace

ON = P.on
UPON = (ON(V.a, V.b), ON(V.b, V.c))


def test_facts_hold_while_the_block_runs_however_it_ends():
    with facts_asserted(ON(P.cup, P.box), ON(P.box, P.table)):
        assert {answer.what for answer in solve(P.rete_holds(ON(V.what, V._)))} == {P.cup, P.box}
    with pytest.raises(ValueError), facts_asserted(ON(P.cup, P.box)):
        raise ValueError
    assert not holds(P.rete_holds(ON(V.what, V._)))


def test_a_watcher_is_told_when_all_patterns_hold_together_and_when_they_do_no_more():
    told = []
    with facts_watched(lambda operation, **values: told.append((operation, values)), *UPON):
        with facts_asserted(ON(P.cup, P.box)):
            assert told == []
            with facts_asserted(ON(P.box, P.table)):
                assert told == [(kw.assert_, {"a": P.cup, "b": P.box, "c": P.table})]
        assert [operation for operation, _ in told] == [kw.assert_, kw.retract]


def test_a_watcher_is_told_of_what_holds_already_and_of_nothing_after_its_block():
    told = []
    with facts_asserted(ON(P.cup, P.box), ON(P.box, P.table)):
        with facts_watched(lambda operation, a, b, c: told.append(a), *UPON):
            assert told == [P.cup]
    assert told == [P.cup]


def test_what_a_watcher_raises_leaves_the_block_that_asserts_and_the_fact_is_retracted():
    def refuse(operation, **values):
        if operation is kw.assert_:
            raise ValueError("no such thing")

    with pytest.raises(ValueError, match="no such thing"), facts_watched(refuse, ON(V.a, V.b)), facts_asserted(ON(P.cup, P.box)):
        pass
    assert not holds(P.rete_holds(ON(V.what, V._)))


@pytest.mark.parametrize("wrong", [lambda: facts_asserted(P.cup), lambda: facts_watched(print), lambda: facts_watched(print, "on")])
def test_what_is_no_goal_is_refused_with_what_to_write(wrong):
    with pytest.raises(TypeError, match="no goal|needs a pattern"), wrong():
        pass


def test_a_trace_shows_goals_while_the_block_runs(capsys):
    with fact_group("family") as family:
        family.fact(P.parent(P.tom, P.bob))
    with trace(P.parent):
        assert holds(P.parent(P.tom, V.who))
    lines = filter(None, capsys.readouterr().out.splitlines())  # the first is empty where the output before ended within a line
    assert [line.split()[:2] for line in lines] == [["0:", "CALL"], ["0:", "EXIT"]]
    assert holds(P.parent(P.tom, V.who)) and capsys.readouterr().out == ""
