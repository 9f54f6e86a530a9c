"""The Lisp packages of this room: CRAM-UTILITIES (nickname CUT) and CRAM-PROLOG (nickname PROLOG).

Source: prolog.md sections 1, 13 and 14. The macros (``def-fact-group``, ``lazy-list``, ...) are in ``hy_src``; here their names
are exported.
"""

from __future__ import annotations

from cramhy_runtime.lisp.faces import define_face
from cramhy_runtime.lisp.packages import sym
from cramhy_runtime.lisp.types.types import define_type

from . import (
    barriers,
    builtins,  # noqa: F401  the built-in predicates come along
    file_cache,
    lazy_lists,
    locks,
    patterns,
    quad_trees,
    query,
    queues,
    rete,
    semaphores,
    threads,
    utilities,
)
from .lisp_calls import BREAK_ON_LISP_ERRORS

CUT = define_face(
    "CRAM-UTILITIES", nicknames=("CUT",), use=("COMMON-LISP",),
    functions={
        file_cache: "cached-file-value execute-string",
        threads: """spawn-thread spawn-threads run-in-thread kill-thread join-thread thread-alive-p thread-name current-thread all-threads
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
        utilities: """deprecate style-warn copy-object current-timestamp set-timestamp-function set-default-timestamp-function
            microsecond-timestamp-function current-string-timestamp flip compare minimum maximum ensure-unused-string
            sanitize-filename equalize-two-list-lengths equalize-lists-of-lists-lengths make-data-pool new-pool-value pool-value
            delete-pool-value function-bound-feature""",
    },
    export="""?_ !?_ lazy-list cont finish next with-lazy-list-dynamic-environment lazy-dolist delay with-vars-bound
        with-vars-strictly-bound with-pat-vars-bound define-hook hooks pop-if! assert-no-returning assert-no-nlx string-case
        destructure-case flet* timestamp *timestamp-function* deprecation-warning pool-value-unbound choose with-file-cache
        with-lock-held with-hash-table-locked semaphore queue mailbox barrier cyclic-barrier with-synchronization-barrier
        with-synchronization-barriers""",
    internal="lazy-cons-elem on-prepare-prolog-prove on-finish-prolog-prove",
)
define_type(CUT.intern("TIMESTAMP"), lambda form, environment: sym("DOUBLE-FLOAT"), "Seconds: what CURRENT-TIMESTAMP gives.")
CUT.intern("POOL-VALUE").setf_function = utilities.set_pool_value
CUT.intern("CACHED-FILE-VALUE").setf_function = file_cache.set_cached_file_value

PROLOG = define_face(
    "CRAM-PROLOG", nicknames=("PROLOG",), use=("COMMON-LISP", "CRAM-UTILITIES"),
    functions={
        query: "prolog query-var filter-bindings",
        patterns: "unify unify-p",
        rete: """rete-assert rete-retract rete-holds rete-prove clear-alpha-network alpha-network-size object-id
            register-production clear-productions remove-production register-production-handler remove-production-handler""",
    },
    variables={BREAK_ON_LISP_ERRORS.name: None},
    export="""?_ and or not -> *-> cut lisp-fun lisp-pred assert-type bound ground true fail once call findall bagof setof every
        forall member take generate-values == equal length append sort reduce max string-concat format warn error
        slot-value get-slot-value instance-of lisp-type symbol-value set-symbol-value < > <= >=
        def-fact-group <- def-prolog-handler with-facts-asserted def-production with-productions with-production-handlers""",
)

