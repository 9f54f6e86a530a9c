"""The levels of logging, and the loggers of a roscpp node with the two services that read and set their levels.

Every node in C++ offers ``~get_loggers`` and ``~set_logger_level``. Names of loggers have parts with dots between; ``ros`` is
the root. Setting the level of one logger changes no other. Source: wiki.ros.org/rosconsole, roscpp's services of these names.
"""

from __future__ import annotations

from .messages import message_class_exact, service_type_exact
from .services import Refusal
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from .graph import Node
    from .messages import RosMessage


DEBUG, INFO, WARN, ERROR, FATAL = 1, 2, 4, 8, 16
LEVEL_NAMES = {DEBUG: "DEBUG", INFO: "INFO", WARN: "WARN", ERROR: "ERROR", FATAL: "FATAL"}
LEVEL_CODES = {name: code for code, name in LEVEL_NAMES.items()}


class Loggers:
    """The loggers of ``node``, an executable of the ROS package ``package``. Making the object offers the two services.

    ``talkative``: whether the node prints debug messages; the node reads it in every tick.
    """

    def __init__(self, node: Node, package: str):
        self.own = f"ros.{package}"
        self.levels = {"ros": INFO, "ros.roscpp": INFO, "ros.roscpp.roscpp_internal": INFO, "ros.roscpp.superdebug": WARN, self.own: INFO}
        self.talkative = False
        get, change = service_type_exact("roscpp/GetLoggers"), service_type_exact("roscpp/SetLoggerLevel")
        entry = message_class_exact("roscpp/Logger")

        def tell(_: RosMessage) -> RosMessage:
            return get.response(loggers=[entry(name=name, level=LEVEL_NAMES[self.levels[name]].lower()) for name in sorted(self.levels)])

        def set_level(request: RosMessage) -> RosMessage:
            code = LEVEL_CODES.get(request.level.upper())
            if code is None:
                raise Refusal("")
            self.levels[request.logger] = code
            self.talkative = self.levels[self.own] == DEBUG
            return change.response()

        node.serve("~get_loggers", get, tell)
        node.serve("~set_logger_level", change, set_level)

    def enabled(self, level: int) -> bool:
        """Whether the node prints log messages of ``level``, a code of ``rosgraph_msgs/Log``."""
        return level >= self.levels[self.own]
