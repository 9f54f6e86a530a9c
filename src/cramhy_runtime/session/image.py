"""Images: everything that is global, as often as one likes.

    with Image() as image:
        image.start(seed=1)
        ...                                  # nothing that is defined or started here is known outside

A notebook, a grader and each file of tests have their own, in one process. What an image holds, and how threads take turns, stands in
``kernel/images.py``.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.kernel import images

from .boot import boot, fresh_start
from cramhy_runtime.kernel.typing_names import Any, Self


class Image(images.Image):
    """All packages and registries as they come with cramhy, and nothing of the user's; no kernel runs yet.

    as_now: whether it begins with what is defined in the current image, as the course that a teacher has loaded.

    ``with Image() as image:`` the calling thread acts in it, and when the block is left, what runs in it is stopped and what was defined in
    it goes. Who keeps an image, as a notebook does from cell to cell, enters it ``with image.entered():`` and ends it by `close`.
    """

    def __init__(self, as_now: bool = False):
        with kernel.at_hand():  # else `boot` starts one outside, which would hear the signals between two images
            boot()
        super().__init__(as_now)

    def start(self, **options: Any) -> None:
        """Start a kernel in it; options: see `fresh_start`. To be called by the thread that has entered it."""
        if images.current() is not self:
            raise kernel.KernelError("This image is not the current one. Enter it first: with image.entered(): ...")
        fresh_start(**options)

    def close(self) -> None:
        """Stop what runs in it, and forget what was defined in it."""
        if images.current() is not self:
            with self.entered():
                kernel.stop()
            self.forget()
        else:
            kernel.stop()

    def __enter__(self) -> Self:
        self.enter()
        return self

    def __exit__(self, *problem: object) -> None:
        try:
            self.close()
        finally:
            self.leave()
            if images.current() is not self:
                self.forget()
