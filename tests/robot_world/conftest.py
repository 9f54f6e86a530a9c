"""The PR2 and the kitchen, read once."""

from pathlib import Path

import pytest

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

from cramhy_runtime import kernel  # noqa: E402  what follows needs MuJoCo
from cramhy_runtime.robot_world import urdf  # noqa: E402
from cramhy_runtime.robot_world.skeleton import Skeleton  # noqa: E402
from cramhy_runtime.robot_world.world import World  # noqa: E402

DATA = Path(urdf.__file__).parent / "data"


@pytest.fixture(scope="session")
def pr2():
    return Skeleton(urdf.read_file(DATA / "pr2.urdf"))


@pytest.fixture(scope="session")
def kitchen():
    return Skeleton(urdf.read_file(DATA / "kitchen.urdf"))


@pytest.fixture
def world(pr2, kitchen):
    kernel.start(clock="virtual")
    made = World()
    made.add_machine("kitchen", kitchen)
    made.add_machine("pr2", pr2)
    yield made
    kernel.stop()
