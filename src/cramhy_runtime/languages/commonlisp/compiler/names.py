"""The names that compiled code uses, for ``.hy`` modules: ``(import cramhy_runtime.languages.commonlisp.compiler.names *)``."""

from .support import NAMESPACE

globals().update(NAMESPACE)
__all__ = list(NAMESPACE)  # noqa: PLE0605
