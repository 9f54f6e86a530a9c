"""The operators of designators, process modules, projection, and episodes.

Source: designators.md, process-modules.md, projection-and-events.md.
"""

from __future__ import annotations

from .declaration import IN_PLACE, Table

DESIGNATORS = Table(
    "CRAM-DESIGNATORS",
    ("(a type (key value)...)", None, "A designator; ?variables in it are evaluated, everything else is as it stands."),
    ("(an type (key value)...)", None, "A designator; as A."),
    ("(all types (key value)...)", None, "A designator of all things of that kind."),
    (
        "(register-designator-class type class)",
        "(%register-designator-class 'type 'class)",
        "Let designators of a type be instances of the class.",
    ),
    (
        "(with-desig-props (property...) designator form...)",
        None,
        "The body with variables that are named after properties and have their values.",
    ),
    (
        "(with-equate-callback (designator callback) form...)",
        None,
        "The body while the function hears what the designator is equated with.",
    ),
    (
        '(register-location-generator priority function ["documentation"])',
        "(%register-location-generator priority 'function documentation)",
        "Let the function propose poses for location designators; low priorities first.",
    ),
    (
        '(register-location-validation-function priority function ["documentation"])',
        "(%register-location-validation-function priority 'function documentation)",
        "Let the function judge the poses of location designators.",
    ),
    (
        "(with-designator-solution-filter filter form...)",
        "(%with-designator-solution-filter filter (lambda () form...))",
        "The body, in which only solutions count for which the function is true.",
        IN_PLACE,
    ),
    (
        "(cram-designator-properties::def-desig-package name option...)",
        "(%define-designator-package 'name '(option...))",
        "Define a package with the words of designators.",
    ),
    (
        "(cram-language-designator-support::with-designators ((name type properties)...) form...)",
        None,
        "The body with new designators as variables.",
    ),
    (
        "(cram-language-designator-support::with-equate-fluent (designator fluent) form...)",
        "(%with-equate-fluent designator 'fluent (lambda (fluent) form...))",
        "The body with a fluent that pulses when the designator is equated.",
    ),
)

PROCESS_MODULES = Table(
    "CRAM-PROCESS-MODULES",
    (
        "(def-process-module name (input) form...)",
        None,
        "Define a process module: the body runs for each designator that it is given, and its value is the result.",
    ),
    (
        "(with-process-modules-running (module...) form...)",
        "(%with-process-modules-running '(module...) (lambda () form...))",
        "The body while the modules run. MODULE is a name, or a list of an alias and a name.",
        IN_PLACE,
    ),
    (
        "(with-process-module-aliases (alias...) form...)",
        "(%with-process-module-aliases '(alias...) (lambda () form...))",
        "The body, in which modules have other names, too. ALIAS is a list of the new name and the module's.",
        IN_PLACE,
    ),
    (
        "(with-process-module-registered-running (name instance) form...)",
        "(%with-process-module-registered-running name instance (lambda () form...))",
        "The body while the instance of a process module runs under the name.",
        IN_PLACE,
    ),
    (
        "(def-asynchronous-process-module name (slot...) option...)",
        None,
        "Define a class of process modules that work on many designators at once, by methods of ON-INPUT, ON-RUN and ON-CANCEL.",
    ),
)

PROJECTION = Table(
    "CRAM-PROJECTION",
    (
        "(define-projection-environment name [:special-variable-initializers ((variable form)...)] "
        "[:process-module-definitions (module...)] [:startup form] [:shutdown form])",
        None,
        "Define an environment in which plans are tried without the robot.",
    ),
    (
        "(define-special-projection-variable name form)",
        None,
        "A special variable that has a new value, that of the form, in each projection.",
    ),
    (
        "(with-projection-environment name form...)",
        "(%with-projection-environment 'name (lambda () form...))",
        "Try the body in a projection environment; the result is an object with its values and what happened.",
    ),
    (
        "(with-partially-ordered-clock-disabled clock form...)",
        "(%with-partially-ordered-clock-disabled clock (lambda () form...))",
        "The body, in which all tasks of a projection share one time.",
    ),
)

EPISODES = Table(
    "CRAM-EXECUTION-TRACE",
    (
        "(with-episode-knowledge episode form...)",
        "(%with-episode-knowledge episode (lambda () form...))",
        "The body, in which questions about tasks and fluents are about the episode.",
        IN_PLACE,
    ),
    (
        "(with-last-episode-knowledge form...)",
        "(%with-last-episode-knowledge (lambda () form...))",
        "As WITH-EPISODE-KNOWLEDGE, of the last plan.",
        IN_PLACE,
    ),
    (
        "(with-top-level-episode-knowledge plan-name form...)",
        "(%with-top-level-episode-knowledge 'plan-name (lambda () form...))",
        "As WITH-EPISODE-KNOWLEDGE, of the last run of a named plan.",
    ),
    (
        "(with-offline-episode-knowledge source form...)",
        "(%with-offline-episode-knowledge source (lambda () form...))",
        "As WITH-EPISODE-KNOWLEDGE, of a file.",
    ),
    (
        "(defstore-episode-knowledge-backend (object type stream) form...)",
        "(%define-episode-store 'type (lambda (object stream) form...))",
        "Say how an episode is written to a stream.",
    ),
    (
        "(defrestore-episode-knowledge-backend (type stream) form...)",
        "(%define-episode-restore 'type (lambda (stream) form...))",
        "Say how an episode is read from a stream.",
    ),
)
