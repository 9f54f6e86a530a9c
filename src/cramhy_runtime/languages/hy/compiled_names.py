"""The names that compiled Lisp uses, for ``.hy`` modules: ``(import cramhy_runtime.languages.hy.compiled_names *)``."""

from ..commonlisp.compiler.support import NAMESPACE

globals().update(NAMESPACE)
__all__ = list(NAMESPACE)  # noqa: PLE0605
