"""CL-TF2's transformer: it keeps nothing and asks a tf2 buffer server, by an action, for each transform.

The server waits for the transform, up to the timeout of the goal, and answers with it or with one of tf2's error codes, which are the
conditions of ``errors.py`` here. It knows two options that CL-TF does not: a target at another time, through a frame that does not
move meanwhile. Source: cl-transforms.md 8.
"""

from __future__ import annotations

from .. import kernel
from ..actionlib.client import ActionClient
from ..ros.messages import message_class_exact
from . import errors
from .frames import unslash_frame
from .stamped_messages import from_msg

ACTION = "tf2_msgs/LookupTransformAction"
NO_ERROR, SUCCEEDED = 0, "SUCCEEDED"
_KINDS = (
    None,
    errors.FrameLookupError,
    errors.ConnectivityError,
    errors.ExtrapolationError,
    errors.InvalidArgumentError,
    errors.TimeoutError_,
    errors.TransformStampedError,
)
"""The conditions by the codes of ``tf2_msgs/TF2Error``."""


class BufferClient:
    """A client of the server ``tf2_buffer_server``, which must be there within ``timeout`` seconds. Several tasks may ask at once."""

    lisp_name = "CL-TF2::BUFFER-CLIENT"
    initargs = {"TIMEOUT": "timeout"}

    def __init__(self, timeout=10.0, server="tf2_buffer_server"):
        self.timeout, self.server = timeout, server
        self.idle = [ActionClient(server, ACTION)]
        if not self.idle[0].wait_for_server(timeout):
            errors.transform_error(
                errors.TimeoutError_,
                "Waiting for action server timed out.",
                f"Nobody serves the action {server} ({ACTION}). A CL-TF:TRANSFORM-LISTENER needs no server.",
            )

    def lookup(self, target, source, *, time=None, timeout=0.0, target_time=None, fixed_frame=None):
        """The transform as the server knows it after waiting up to ``timeout`` seconds. The names of frames reach it without slashes."""
        goal = message_class_exact("tf2_msgs/LookupTransformGoal")(
            target_frame=unslash_frame(target),
            source_frame=unslash_frame(source),
            source_time=time or 0,
            timeout=timeout or 0,
            target_time=target_time or 0,
            fixed_frame=unslash_frame(fixed_frame) or "",
            advanced=True if fixed_frame is not None else None,
        )
        client = self.idle.pop() if self.idle else ActionClient(self.server, ACTION)  # each follows one goal at a time
        sent = client.send(goal)
        try:
            client.waiting.wait(lambda: sent.done, f"the transform from {source} to {target} of {self.server}")
        except BaseException:
            with kernel.cleanup():
                client.cancel(sent)
            raise
        finally:
            self.idle.append(client)
        return self._answer(sent)

    def _answer(self, sent):
        problem = sent.result.error if sent.result is not None else None
        if problem is not None and problem.error != NO_ERROR:
            kind = _KINDS[problem.error] if problem.error < len(_KINDS) else errors.TransformStampedError
            return errors.transform_error(kind, problem.error_string)
        if sent.state != SUCCEEDED:
            return errors.transform_error(errors.TransformStampedError, f"Action call did not succeed. Status: {sent.state}")
        return from_msg(sent.result.transform)
