"""Each test file of this room finds COMMON-LISP-USER and the variables of Common Lisp as they were before the others."""

import pytest

from cramhy_runtime.lisp.data import UNBOUND, Symbol
from cramhy_runtime.lisp.packages import COMMON_LISP, COMMON_LISP_USER

_KEPT = ("value", "function", "macro", "setf_function", "plist", "special", "constant", "compiler_data")


@pytest.fixture(autouse=True, scope="module")
def user_package_of_its_own():
    before = dict(COMMON_LISP_USER.internal)
    contents = {symbol: [getattr(symbol, name) for name in _KEPT] for symbol in before.values() if isinstance(symbol, Symbol)}
    variables = {symbol: symbol.value for name, symbol in COMMON_LISP.external.items()
                 if name.startswith("*") and name.endswith("*") and symbol.value is not UNBOUND}  # some get a value on a later import
    yield
    for symbol, value in variables.items():
        symbol.value = value
    COMMON_LISP_USER.internal.clear()
    COMMON_LISP_USER.internal.update(before)
    for symbol, values in contents.items():
        for name, value in zip(_KEPT, values):
            setattr(symbol, name, value)
