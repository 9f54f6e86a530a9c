"""Values of Python's own classes in terms: equal ones are the same; objects that can change are the same only as one object."""

import dataclasses
import datetime
import decimal
import fractions
import pathlib
import typing
import uuid

import pytest

from cramhy_runtime.prolog import P, V, fact_group, facts_asserted, findall, holds


@dataclasses.dataclass(frozen=True)
class Cell:
    row: int
    column: int


@dataclasses.dataclass
class Mutable:
    row: int


class Point(typing.NamedTuple):
    x: float
    y: float


class Plain:
    pass


MAKERS = {
    "date": lambda n: datetime.date(2026, 1, 1 + n),
    "time with zone": lambda n: datetime.datetime(2026, 1, 1 + n, tzinfo=datetime.UTC),
    "duration": lambda n: datetime.timedelta(seconds=60 * n),
    "decimal": lambda n: decimal.Decimal(f"{n}.50"),
    "path": lambda n: pathlib.Path("/a") / str(n),
    "bytes": lambda n: bytes([97, n]),
    "fraction": lambda n: fractions.Fraction(2 * n + 1, 2),
    "uuid": lambda n: uuid.UUID(int=n),
    "complex": lambda n: complex(n, 1),
    "frozen dataclass": lambda n: Cell(n, 2),
    "named tuple": lambda n: Point(n, 2.0),
}


@pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS)
def test_equal_values_are_the_same_term_wherever_terms_are_compared(make):
    assert holds(P["=="](make(1), make(1))) and not holds(P["=="](make(1), make(2)))
    assert holds(P["=="]([make(1), V.x], [make(1), 3])) and not holds(P["=="]([make(1), 3], [make(2), 3]))
    assert holds(P.member(make(3), [make(1), make(3)])) and not holds(P.member(make(9), [make(1), make(3)]))
    with fact_group("things") as things:
        things.fact(*(P.thing(n, make(n)) for n in range(12)), *(P.listed([P.at, make(n)], n) for n in range(12)))
        things.rule(P.both(V.n, V.m), P.thing(V.n, V.it), P.listed([P.at, V.it], V.m))
        things.rule(P.seventh(make(7)))
    with facts_asserted(*(P.thing(n, make(n)) for n in range(3))):
        assert findall(V.n, P.rete_holds(P.thing(V.n, make(1)))) == [1] and not holds(P.rete_holds(P.thing(0, make(1))))
    assert findall(V.n, P.thing(V.n, make(5))) == [5] and findall(V.n, P.listed([P.at, make(5)], V.n)) == [5]
    assert findall((V.n, V.m), P.both(V.n, V.m)) == [(n, n) for n in range(12)]
    assert holds(P.seventh(make(7))) and not holds(P.seventh(make(8)))
    assert findall(V.what, P.thing(4, V.what)) == [make(4)]


@pytest.mark.parametrize("make", [lambda: Mutable(1), Plain, lambda: bytearray(b"a")], ids=["dataclass", "object", "bytearray"])
def test_objects_that_can_change_are_the_same_only_as_one_object(make):
    one = make()
    assert holds(P["=="](one, one)) and not holds(P["=="](one, make()))


def test_numbers_stay_apart_as_lisp_keeps_them_apart():
    for one, other in ((0.0, -0.0), (1, True), (1, 1.0), (b"a", "a"), (decimal.Decimal(1), 1), (Point(1, 2), Cell(1, 2))):
        assert not holds(P["=="](one, other)), (one, other)
