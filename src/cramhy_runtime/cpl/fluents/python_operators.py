"""Python's operators on fluents: ``distance < 0.5`` is a net, as ``(< distance 0.5)`` is in Lisp.

``< <= > >= + - * /`` and ``abs`` make nets computed by Python's operators; ``& | ~`` are ``fl-and``, ``fl-or`` and ``fl-not``.

Some operators are not overloaded, on purpose. ``==`` still means "the same fluent", so fluents can be elements of sets and keys
(`fl_eql` compares values). ``and``, ``or``, ``not`` and ``1 < f < 3`` cannot be overloaded: they ask for the truth of a fluent *now*.
That is an error, since in ``if distance < 0.5:`` the net would always count as true. Read ``.value``, or wait.
"""

from __future__ import annotations

from collections.abc import Callable
from cramhy_runtime.kernel.typing_names import Any, NoReturn

from . import formulas
from .operators import fl_and, fl_not, fl_or, net
from .fluents import Fluent


def _binary(symbol: str) -> tuple[Callable[..., Fluent[object]], Callable[..., Fluent[object]]]:
    def plain(self: Fluent[object], other: Any) -> Fluent[object]:
        return net(f"FL{symbol}", formulas.of_python(symbol, (self, other)), (self, other))

    def reflected(self: Fluent[object], other: Any) -> Fluent[object]:
        return plain(other, self) if isinstance(other, Fluent) else net(f"FL{symbol}", formulas.of_python(symbol, (other, self)), (self,))

    return plain, reflected


def _truth(self: Fluent[object]) -> NoReturn:
    raise TypeError(
        f"The fluent {self.name} was asked whether it is true, by if, while, and, or, not, or a comparison like 1 < f < 3. "
        "That would be the fluent itself, which is always there. Write f.value for its value now, cpl.wait_for(f) to wait, "
        "f & g, f | g, ~f to combine fluents."
    )


for _name, _symbol in [("add", "+"), ("sub", "-"), ("mul", "*"), ("truediv", "/")]:
    _plain, _reflected = _binary(_symbol)
    setattr(Fluent, f"__{_name}__", _plain)
    setattr(Fluent, f"__r{_name}__", _reflected)
for _name, _symbol in [("lt", "<"), ("le", "<="), ("gt", ">"), ("ge", ">=")]:
    setattr(Fluent, f"__{_name}__", _binary(_symbol)[0])  # Python turns 3 > f into f < 3
for _name, _function in [("and", fl_and), ("or", fl_or)]:
    setattr(Fluent, f"__{_name}__", _function)
    setattr(Fluent, f"__r{_name}__", lambda self, other, function=_function: function(other, self))
setattr(Fluent, "__invert__", fl_not)
setattr(Fluent, "__abs__", lambda self: net("FL-ABS", formulas.of_call(abs, (self,)), (self,)))
setattr(Fluent, "__bool__", _truth)
