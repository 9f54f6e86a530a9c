"""The operators of roslisp, its helpers, actionlib and tf (roslisp.md, cl-transforms.md 6)."""

from __future__ import annotations

from .declaration import Table

ROSLISP = Table(
    "ROSLISP",
    # ------------------------------------------------------------------------------------------------------ 5: messages
    ('(make-message "package/Type" [field value]...)', None, "A message; a field is :x, or from the inside out (:x :position)."),
    ('(make-msg "package/Type" [field value]...)', None, "The short name of MAKE-MESSAGE."),
    ('(make-request "package/Service" [field value]...)', None, "The request of a service."),
    ("(make-publisher-msg publication [field value]...)", None, "A message of the publication's type."),
    ("(publish-msg publication [field value]...)", None, "Make a message and publish it."),
    ("(modify-message-copy message [field value]...)", None, "A copy of the message with other values."),
    ("(setf-msg place [field value]...)", None, "Let the place have a copy of its message with other values."),
    ("(with-fields (field...) message form...)", None, "The body with variables for fields; FIELD is a name, or (variable path)."),
    ("(store-message-in place)", None, "A function that stores its argument in the place: a callback for SUBSCRIBE."),
    # ------------------------------------------------------------------------------------------------------- 4: logging
    *(
        (f'(ros-{level} (topic...) [condition] "text" argument...)', None, f"Log a line of the level {level}, with a text of FORMAT.")
        for level in ("debug", "info", "warn", "error", "fatal")
    ),
    ("(set-debug-levels [topic level]...)", None, "Say from which level on lines of the topics are printed."),
    # --------------------------------------------------------------------------------------------------------- 2: nodes
    ('(with-ros-node ("name" [:option value...]) form...)', None, "The body while a node of that name runs."),
    (
        "(def-ros-node name (parameter...) ([:spin spin]) form...)",
        None,
        "A function that runs the body as a node, with private parameters as variables.",
    ),
    # ------------------------------------------------------------------------------------------------------ 7: services
    (
        "(def-service-callback (name service) (field...) form...) or (def-service-callback service (field...) form...)",
        None,
        "A function that answers requests, with their fields as variables; (make-response :field value ...) is its answer.",
    ),
    ('(register-service "service" type)', None, "Offer a service that the function of the type's name answers."),
    (
        '(def-service-call (name service) "service" [:return-field field])',
        None,
        "A function that calls the service with its arguments as fields.",
    ),
    # ---------------------------------------------------------------------------------------------------------- 9: time
    (
        "(roslisp-utils::loop-at-most-every seconds form...)",
        "(block nil (%loop-at-most-every seconds (lambda () form...)))",
        "The body again and again, at most once in so many seconds, until a return leaves it.",
    ),
    (
        "(roslisp-utils::spin-until test seconds form...) or (spin-until test (seconds timeout) form...)",
        None,
        "The body every so many seconds until the test is true.",
    ),
    ('(with-parallel-thread (function ["name"]) form...)', None, "The body while the function runs beside it."),
    # ------------------------------------------------------------------------------------------- 10: packages of messages
    ('(load-message-types "package/Type"...)', None, "Load the messages of the packages."),
    ('(load-service-types "package/Service"...)', None, "Load the services of the packages."),
    ('(load-msg "package/Type")', None, "Load a package's messages and use their names."),
    ('(load-srv "package/Service")', None, "Load a package's services and use their names."),
    ("(load-if-necessary argument...)", None, "Deprecated; an error."),
    # ------------------------------------------------------------------------------------------------ 11: roslisp-utilities
    ("(roslisp-utilities::register-ros-init-function function [rank])", None, "Let STARTUP-ROS call the function; low ranks first."),
    (
        "(roslisp-utilities::register-ros-cleanup-function function)",
        "(%register-ros-cleanup-function 'function)",
        "Let SHUTDOWN-ROS call the function.",
    ),
)

ACTIONLIB = Table(
    "ACTIONLIB",
    ("(actionlib-lisp::make-action-goal-msg client [field value]...)", None, "A goal for a simple action client."),
    ("(make-action-goal client [field value]...)", None, "A goal for an action client."),
    ("(def-exec-callback name (field...) form...)", None, "A function that reaches goals, with their fields as variables."),
    ("(succeed-current [field value]...)", None, "End the current goal as reached, with a result."),
    ("(abort-current [field value]...)", None, "End the current goal as not reached, with a result."),
    ("(preempt-current [field value]...)", None, "End the current goal as given up, with a result."),
    ("(publish-feedback [field value]...)", None, "Tell the client how far the current goal is."),
)

FRAMES = Table(
    "CL-TF",
    (
        "(with-tf-broadcasting (broadcaster transform...) form...)",
        "(cl-tf::while-broadcasting broadcaster (list transform...) (lambda () form...))",
        "The body while the transforms are sent again and again.",
    ),
)
