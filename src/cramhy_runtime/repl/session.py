"""The session under the name by which programs have imported it from the beginning, with the packages for tests of plans.

It is in the room ``session``, which knows no room above it.
"""

from cramhy_runtime.session.session import (
    Interruption,
    Session,
    condition_of,
    leave,
    leaving,
    packages_above,
    quiet_collector,
    signalled_here,
)


def _define_testing():
    from cramhy_runtime.testing import package  # a session that tests nothing starts without it

    package.define_faces()


packages_above.update(dict.fromkeys(("CRAMHY-TESTING", "TESTING-USER"), _define_testing))

__all__ = ["Interruption", "Session", "condition_of", "leave", "leaving", "quiet_collector", "signalled_here"]
