"""The Lisp packages of this room: ROSLISP, its helpers, and one package per ROS package of messages or services.

Macros (``make-message``, ``with-fields``, ``ros-info`` …) are in ``hy_src/cramhy/roslisp.hy``; their names are exported here.
"""

from __future__ import annotations

from cramhy_runtime.ros import messages
from cramhy_runtime.ros.roslisp import structs
from ...systems import systems
from . import reading, serializing

from operator import attrgetter

from cramhy_runtime.lisp_core import conditions
from ...packages.face_definition import define_face
from ...syntax.operator_macros import export
from ....operators import ROSLISP as OPERATORS
from cramhy_runtime.lisp_core.classes import register_class
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method_error
from cramhy_runtime.lisp_core.dispatch.open_functions import Opening
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.printing import define_printer
from cramhy_runtime.ros import message_building
from . import message_printing
from cramhy_runtime.ros.roslisp import clock, logging, master, node, parameters, services, time, topics, utilities


INHERITED = "ros-message-to-list list-to-ros-message ros-datatype message-definition md5sum " + " ".join(serializing.FUNCTIONS)
"""What roslisp has of ROSLISP-MSG-PROTOCOL besides, and does not export."""
INTERNAL_VARIABLES = {"*node-status*": keyword("SHUTDOWN"), "*namespace*": "/", "*remapped-names*": None, "*ros-log-location*": None}
"""Variables of roslisp that programs look at with two colons. The node sets them."""


class FieldReader:
    """The reader of one field for all messages of a package: ``turtlesim-msg:x``. A generic function for all that users see.

    It becomes one, whose first method it is, when somebody adds a method or has an accessor of that name.
    """

    __slots__ = ("symbol", "getters", "warning", "_opening")
    acts_as_generic = True

    def __init__(self, symbol, warning=None):
        self.symbol, self.getters, self.warning, self._opening = symbol, {}, warning, None

    @property
    def opening(self):
        """How it becomes a generic function."""
        if self._opening is None:
            self._opening = Opening(self.symbol, "(message)", (messages.RosMessage,), self, None)
        return self._opening

    def __call__(self, *arguments):
        getter = self.getters.get(arguments[0].__class__) if len(arguments) == 1 else None
        if getter is None:
            if len(arguments) != 1:
                return conditions.program_error("invalid number of arguments: ~S", len(arguments))
            return no_applicable_method_error(self, arguments)
        if self.warning:
            warning, self.warning = self.warning, None
            conditions.warn("~a", warning)
        return getter(arguments[0])

    def __repr__(self):
        return f"#<STANDARD-GENERIC-FUNCTION {self.symbol.package.name}:{self.symbol.name} ({len(self.getters)})>"


_readers: dict = {}
"""Symbol → its reader, also where it is the method of a generic function."""


def define_message_symbols(package, classes, service_types):
    """Export the class names and field readers of a ROS package from its Lisp packages."""
    kinds = [("MSG", cls) for cls in classes] + [("SRV", part) for service in service_types for part in (service.request, service.response)]
    for kind, cls in kinds:
        home = messages.lisp_package(package, kind)
        home.export(cls.lisp_symbol)
        old_name = home.intern(f"<{cls.lisp_symbol.name}>")
        home.export(old_name)
        register_class(cls.lisp_symbol, cls)
        register_class(old_name, cls)
        for field in cls.fields:
            name = field.name.upper()
            old = f"{package}-{kind.lower()}:{field.name}-val"
            for reader_name, warning in (
                (name, None),
                (name + "-VAL", f"Using old-style slot reader {old} is deprecated.  Use {package}-{kind.lower()}:{field.name} instead."),
            ):
                symbol = home.intern(reader_name)
                home.export(symbol)
                reader = _readers.get(symbol)
                if reader is None:
                    reader = symbol.function = _readers[symbol] = FieldReader(symbol, warning)
                reader.getters[cls] = attrgetter(field.attribute)
    for service in service_types:
        messages.lisp_package(package, "SRV").export(service.lisp_symbol)


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_printer(FieldReader, lambda reader, stream: stream.write(repr(reader)))
    messages.on_load(define_message_symbols)
    for _name in "std_msgs std_srvs geometry_msgs rosgraph_msgs turtlesim".split():
        for _kind in ("MSG", "SRV"):
            messages.find_lisp_package(f"{_name.upper()}-{_kind}")  # those of the course are there from the start, the others on demand
    define_face(
        "ROSLISP-MSG-PROTOCOL",
        functions={
            message_building: "ros-message-to-list list-to-ros-message symbol-codes symbol-code code-symbols code-symbol ros-datatype "
            "message-definition md5sum",
            **{name: function for name, (function, *_) in serializing.FUNCTIONS.items()},
        },
        export="ros-message",
    )
    serializing.open_functions()
    define_face("ROSLISP-UTILS", functions={"tokens": serializing.tokens}, export="until-timeout")
    export(OPERATORS)
    EXTENDED_REALS = define_face("ROSLISP-EXTENDED-REALS", export="infty -infty")
    EXTENDED_REALS.intern("INFTY").value = EXTENDED_REALS.intern("INFTY")
    define_face("ROSLISP-QUEUE", export="queue")
    ROSLISP = define_face(
        "ROSLISP",
        use=["COMMON-LISP"],
        imports={
            "ROSLISP-MSG-PROTOCOL": f"ros-message symbol-codes symbol-code code-symbols code-symbol {INHERITED}",
            "ROSLISP-UTILS": "loop-at-most-every spin-until tokens",
        },
        functions={
            master: "make-uri",
            node: "start-ros-node shutdown-ros-node node-status fully-qualified-name print-status standalone-exec-debug-hook",
            topics: "advertise unadvertise publish subscribe unsubscribe num-subscribers",
            services: "call-service wait-for-service make-service-client register-service-fn call-persistent-service "
            "close-persistent-service "
            "persistent-service-ok",
            parameters: "get-param set-param has-param delete-param list-params",
            logging: "set-debug-level debug-level print-debug-levels",
            clock: "ros-time",
            time: "spin-until-ros-time-valid wait-duration",
            message_building: "make-response msg-slot-value",
            reading: "read-ros-message",
            message_printing: "pprint-ros-message",
        },
        variables={
            **{"*ros-node-name*": None, "*master-uri*": None, "*default-master-uri*": None, "*running-from-command-line*": None},
            **INTERNAL_VARIABLES,
        },
        internal=f"{INHERITED} tokens {' '.join(INTERNAL_VARIABLES)}",
        export="defservice persistent-service reconnect roslisp ros-time-not-yet-received service-call-error service-error tcp top "
        "*current-ros-package*",
    )
    for _name in ("EMPTY", "SETBOOL", "TRIGGER"):  # the original uses the package of std_srvs, whose files need not be read for that
        ROSLISP.import_symbol(messages.early_symbol("std_srvs", "SRV", _name))
    define_face(
        "ROSLISP-UTILITIES",
        use=["COMMON-LISP"],
        functions={
            utilities: "startup-ros shutdown-ros lispify-ros-name rosify-lisp-name lispify-ros-underscore-name rosify-underscores-lisp-name"
        },
    )
    export(OPERATORS)
    define_face(
        "S-XML-RPC",
        functions={
            "xml-rpc-struct": structs.xml_rpc_struct,
            "xml-rpc-struct-alist": structs.xml_rpc_struct_alist,
            "get-xml-rpc-struct-member": structs.get_xml_rpc_struct_member,
            "xml-rpc-struct-p": structs.xml_rpc_struct_p,
        },
    )
    systems.provide_systems_on_demand(messages.find_message_system, messages.message_systems)
