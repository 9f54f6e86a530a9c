"""The plan language, for Hy and for Python.

``(require cramhy *)`` in a ``.hy`` file gives its macros (see ``language.hy``); ``import cramhy`` in Python lets Lisp systems and
``.lisp`` files be imported as modules.
"""

import hy  # noqa: F401  teaches Python to import .hy files

from . import language

_hy_macros = language._hy_macros
