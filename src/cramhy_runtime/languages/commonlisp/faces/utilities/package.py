"""The Lisp face of this room: the package CRAM-UTILITIES, nickname CUT.

Source: prolog.md section 13, cpl.md section 13. The macros (``lazy-list``, ``with-lock-held``, ...) are in ``hy_src/cramhy/cut.hy``;
here their names are exported, and at the end stand the functions that they call.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import list_from, python_list, truth
from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from ...packages.face_definition import define_face, define_meanings
from ...syntax.operator_macros import export
from ....operators import UTILITIES
from cramhy_runtime.lisp_core.packages import sym
from ...types.types import define_type

from cramhy_runtime.utilities import barriers, lazy_lists, locks, patterns, quad_trees, queues, semaphores, small_functions, threads
from . import features, file_cache, newer_functions


def lazy_list_of(initial, body, restarts):
    """``initial``: list of the parameters' first values. ``body(cont, next, finish, parameter...)``; ``restarts``: it names some."""
    return lazy_lists.lazy_list(python_list(initial), body, truth(restarts))


def lazy_environment(symbols, thunks, body):
    return lazy_lists.with_lazy_list_dynamic_environment(list(zip(python_list(symbols), python_list(thunks))), body)


def values_of_variables(variables, bindings):
    """The values of pattern variables; an unbound one stands for itself."""
    return list_from([patterns.var_value(variable, bindings) for variable in python_list(variables)])


def strict_values_of_variables(variables, bindings):
    return patterns.with_vars_strictly_bound(python_list(variables), bindings, lambda *found: list_from(found))


def values_of_pattern(pattern, sequence, variables):
    """The values of ``variables`` when ``pattern`` is matched against ``sequence``; errors as with-pat-vars-bound's."""
    return patterns.with_pat_vars_bound(pattern, sequence, lambda value: list_from([value(each) for each in python_list(variables)]))


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    CUT = define_face(
        "CRAM-UTILITIES",
        nicknames=("CUT",),
        use=("COMMON-LISP",),
        functions={
            file_cache: "cached-file-value execute-string",
            threads: """spawn-thread spawn-threads run-in-thread kill-thread join-thread thread-alive-p thread-name current-thread
            all-threads
                thread-local-binding-p""",
            locks: """make-lock make-recursive-lock make-condition-variable condition-variable-wait condition-variable-wait-with-timeout
                condition-variable-signal condition-variable-broadcast make-synchronized-hash-table""",
            semaphores: "make-semaphore wait-on-semaphore try-semaphore signal-semaphore semaphore-count semaphore-name",
            queues: """make-queue enqueue dequeue list-queue-contents queue-count queue-empty-p queue-name queuep make-mailbox send-message
                receive-message receive-message-no-hang receive-pending-messages list-mailbox-messages mailbox-count mailbox-empty-p
                mailbox-name mailboxp""",
            barriers: """make-synchronization-barrier enter-barrier break-barrier reset-cyclic-barrier increment-barrier-threshold
                decrement-barrier-threshold""",
            quad_trees: """quad-tree quad-tree-insert quad-tree-closest-point-in-range make-quad-tree-point quad-tree-point-x
                quad-tree-point-y""",
            "quad-tree-poins-in-range": quad_trees.quad_tree_points_in_range,
            lazy_lists: """lazy-car lazy-cdr lazy-elt force-ll lazy-list-p lazy-mapcar lazy-mapcan lazy-filter lazy-fold lazy-append
                lazy-take lazy-skip lazy-flatten lazy-rests copy-lazy-list delay-p force""",
            patterns: """is-var is-unnamed-var is-segvar is-segform var-name gen-var is-genvar add-bdg var-value substitute-vars
                match-segvar pat-match pat-match-p vars-in is-bound is-ground rename-vars patterns-eq bindings-equal map-tree""",
            newer_functions: "random-with-minimum recursive-alist-hash-table replace-all",
            small_functions: """deprecate style-warn copy-object current-timestamp set-timestamp-function set-default-timestamp-function
                microsecond-timestamp-function current-string-timestamp flip compare minimum maximum ensure-unused-string
                sanitize-filename equalize-two-list-lengths equalize-lists-of-lists-lengths make-data-pool new-pool-value pool-value
                delete-pool-value""",
            features: "function-bound-feature",
        },
        generic="new-pool-value pool-value delete-pool-value",
        export="?_ !?_ cont finish next hooks timestamp *timestamp-function* deprecation-warning pool-value-unbound semaphore queue "
        "mailbox barrier cyclic-barrier ordered-hooks first-in-order-and-around",
        internal="lazy-cons-elem on-prepare-prolog-prove on-finish-prolog-prove",
    )
    export(UTILITIES)
    define_type(CUT.intern("TIMESTAMP"), lambda form, environment: sym("DOUBLE-FLOAT"), "Seconds: what CURRENT-TIMESTAMP gives.")
    open_to_methods(small_functions.set_pool_value, "(setf CUT::POOL-VALUE)")
    CUT.intern("CACHED-FILE-VALUE").setf_function = file_cache.set_cached_file_value
    define_meanings(UTILITIES, lazy_lists, locks, barriers)
    define_face(
        "CRAMHY",
        functions={
            "lazy-list-of": lazy_list_of,
            "lazy-environment": lazy_environment,
            "values-of-variables": values_of_variables,
            "strict-values-of-variables": strict_values_of_variables,
            "values-of-pattern": values_of_pattern,
            "file-value": file_cache.file_value,
        },
    )
