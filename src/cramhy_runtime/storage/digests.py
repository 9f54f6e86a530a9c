"""SHA-256 from Python's small module for it. `hashlib` is the same, but loads OpenSSL, which takes 5 ms, a ninth of loading the course."""

from __future__ import annotations

try:
    from _sha2 import sha256  # type: ignore[import-not-found]  # from Python 3.12 on
except ImportError:
    try:
        from _sha256 import sha256  # type: ignore[import-not-found]
    except ImportError:
        from hashlib import sha256

__all__ = ["sha256"]
