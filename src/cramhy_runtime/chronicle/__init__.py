"""What happens in a session, as messages, when somebody asks for it: for pages that show it, and for recordings.

    from cramhy_runtime import chronicle

    chronicle.start()                        # the topics /cramhy/world, tasks, fluents, process_modules, pace, and services
    with chronicle.record("run.mcap"):       # every message and every event of the plans, in a file that Foxglove opens
        ...
    chronicle.replay("run.mcap", speed=2)    # in a session of its own: the same topics, as it was

`start`, `stop`, `record`, `read` and `replay` are all there is. In CRAM a plan is watched through logs, and ROS has rosbag; here what the
plan did stands beside what the robot did, with the same times.

Where the parts are: `plans`, `fluents`, `modules` (with `goals`), `world`, `robots` (with `robot_forms`) see what happens, `chronicler`
looks at the end of each instant of the kernel, `merge` (with `robot_merge`) merges, `history` keeps, `service_node` publishes and serves.
`recorder` writes a file, in `chunks`, with `schemas` that tell Foxglove what messages look like, a `scene` and a `robot_scene` for its 3D
panel and a `chunk_index` of what is where; `writing` lays out the file. `recordings` reads one, `player` replays it. `texts` shows values
on one line.
"""

from __future__ import annotations

TYPE_CHECKING = False  # as type checkers know it by its name

if TYPE_CHECKING:
    from collections.abc import Iterable
    from os import PathLike

    from .player import Player
    from .recorder import Recorder
    from .recordings import Recording


def start() -> None:
    """Tell what happens in the active session, on topics and services of the hidden node ``/cramhy`` (docs/watching.md).

    Nothing is done when that happens already, or when a recording is replayed there. Errors: KernelError without a session.
    """
    from . import chronicler, player

    if player.there() is None:
        chronicler.active().open_board()


def stop() -> None:
    """Tell nothing any more; recordings go on. Without `start` nothing happens."""
    from . import chronicler

    found = chronicler.there()
    if found is not None:
        found.close_board()
        chronicler.dismiss()


def record(path: str | PathLike[str], program: Iterable[str] = ()) -> Recorder:
    """Record everything that happens in the active session from now on in the file ``path``, until the result is closed.

    path: a file, ``"run.mcap"``; one that is there is replaced. program: names of the program's files, to be noted in it. Returns a
    `recorder.Recorder`: it has ``close()``, works in ``with``, and is closed when the process ends. In virtual time the same run gives
    the same bytes. Errors: `recordings.RecordingError` when there is no session, the file cannot be written, or mcap is not installed.
    """
    from .recorder import Recorder

    return Recorder(path, program)


def read(path: str | PathLike[str]) -> Recording:
    """The `recordings.Recording` in the file ``path``: ``topics``, ``messages()``, ``about``, ``begin``, ``end``, ``cut``.

    Errors: `recordings.RecordingError` when the file is no recording. One that is cut off is read as far as it goes.
    """
    from . import recordings

    return recordings.read(path)


def replay(path: str | PathLike[str], speed: float | None = 1.0) -> Player:
    """Publish the messages of the recording ``path`` again, at their times, in the active session, which should have no plans.

    speed: recorded seconds per second of the kernel's clock; ``None``: as fast as the machine can. Returns a `player.Player`, with
    ``set_pace``, ``step``, ``seek``, ``position``, ``ended`` and ``close()``; pages do the same by ``/cramhy/set_pace``, ``/cramhy/step``
    and ``/cramhy/seek``. Of a file that is cut off, what is there is replayed, with a warning. Errors: `recordings.RecordingError`.
    """
    from . import player

    return player.replay(path, speed)
