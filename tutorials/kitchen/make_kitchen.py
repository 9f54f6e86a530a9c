"""A robot sets a table for two, in virtual time: the lines of the tutorial's page, typed into the REPL.

``make kitchen`` runs this file. It shows each line with its answer, writes a picture and a movie, and says where they are. On a terminal
the REPL stays open, so that one can go on typing.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
from lectures import Typist  # noqa: E402

del sys.path[0]


def lines(png: Path, gif: Path) -> list[str]:
    """What is typed."""
    return [
        '(ros-load:load-system "cram_my_pick_place_tutorial" :cram-my-pick-place-tutorial)',
        "(in-package :kitchen)",
        "(roslisp-utilities:startup-ros)",
        "(roslisp:set-debug-level '(pick-place) :error)",
        ";; The dishes are on the counter",
        "(lay-out-dishes)",
        "(things)",
        ";; The robot sets the table; writing the movie takes some seconds",
        f'(btr:with-movie ("{gif.as_posix()}" :width 320 :height 240 :frames 60) (set-table-for-two))',
        "(things)",
        f'(btr:save-picture "{png.as_posix()}" :camera *camera*)',
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--png", type=Path, default=Path("kitchen.png"), help="where the picture of the table is written")
    parser.add_argument("--gif", type=Path, default=Path("kitchen.gif"), help="where the movie is written")
    parser.add_argument("--seed", type=int, default=None, help="shuffle the order of tasks, reproducibly")
    options = parser.parse_args()
    from cramhy_runtime.cli import program
    from cramhy_runtime.repl.console import Console
    from cramhy_runtime.repl.line_input import standard_lines
    from cramhy_runtime.repl.session import Session

    texts = lines(options.png, options.gif)
    texts.append(f";; The picture is {options.png.resolve()}, the movie {options.gif.resolve()}")
    stays = sys.stdin.isatty() and sys.stdout.isatty()
    if stays:
        texts.append(";; Go on typing; Ctrl-D ends.")

    def stay() -> None:
        console.input = standard_lines()

    console = Console(lambda: Session(time="virtual", seed=options.seed, turtlesim=False), Typist(texts, stay) if stays else Typist(texts))
    with program():
        status = console.run()
    sys.exit(status)


if __name__ == "__main__":
    main()
