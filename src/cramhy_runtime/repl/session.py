"""The session under the name by which programs have imported it from the beginning. It is in the room ``session``."""

from cramhy_runtime.session.session import Interruption, Session, condition_of, leave, leaving, quiet_collector, signalled_here

__all__ = ["Interruption", "Session", "condition_of", "leave", "leaving", "quiet_collector", "signalled_here"]
