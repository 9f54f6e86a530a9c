"""Examples run in images of their own; see `harness`."""

from cramhy_runtime.session import boot

boot()
